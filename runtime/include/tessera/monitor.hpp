#pragma once

#include <cstddef>
#include <string>

/// A controller can be looked at while it runs: on the steady clock it listens on a Unix socket
/// `<monitor_folder()>/<system>.<pid>.sock`, and sends to whoever connects a line of JSON at once and then
/// five times a second:
///
///     {"system", "pid", "net_hash", "time_s", "recording": file; absent: none,
///      "emergency": why an emergency stop stands; absent: none does,
///      "subsystems": [{"path", "behaviour", "calling", "ended", "iterations", "firings", "overruns",
///      "errors",
///                      "period_s", "called_at_s", "call_s", "longest_call_s"}],
///      "channels": [{"name", "marked": ["full"]}]}
///
/// It never waits for a client: who has not taken a line goes without the next ones, and who takes nothing
/// for five seconds is dropped. Of a large system the lines come less often, so that its thread takes at most
/// a fiftieth of a processor. The last line is {"ended": true}; without it the connection was lost.
///
/// Clients may send commands, one JSON object a line. One is taken from any:
///
///     {"command": "recording"}
///
/// It is answered by a line {"recording_bytes": N, "begins": bool, "more": bool} and the next N bytes of the
/// recording (tessera/recording.hpp), at most `longest_piece` at a time, as they are in the file by now. The
/// first answer begins at the beginning, or with the newest segment of a recording with a limit; where the
/// next segment begins, `begins` says so. more: there is more already. Whoever has asked gets what was
/// missing unasked after {"ended": true}, as far as there is room in the socket.
///
/// These are taken by every run, and answered as those below:
///
///     {"id": 1, "command": "set", "path": "v", "value": "0.3"}   a parameter; as `--set v=0.3`
///     {"command": "emergency_stop", "why": text}                 every device gets its safe command, and
///                                                                nothing else until
///     {"command": "reset"}                                       the operator's
///
/// Under the simulated clock only a run that was started with `--controlled` listens. It sends 25 lines a
/// second, with {"paused", "pauses", "speed", "broke_at"} besides, and takes more commands; each is answered
/// by a line {"answer": its id, "error": ""}:
///
///     {"id": 1, "command": "pause" | "resume" | "step_firing"}
///     {"command": "step_iteration", "subsystem": path}   until its transition function is called again;
///                                                        without a subsystem: that of any
///     {"command": "speed", "value": 0.1}                 simulated seconds a second; 0: as fast as possible
///     {"command": "breakpoints", "places": [name...], "transitions": [name...], "conditions": [name...]}
///         instead of those before: pause when one of these places gets a token, one of these transitions has
///         fired, the condition of one of these comes to hold and its tokens are in its subsystem.
///         Transitions are those of subsystems: `t_in` and `t_out` of system and agents fire only at the
///         begin and at the end.
///     {"command": "own"}                                 without an answer: the run ends with this
///     connection
///
/// share/tessera/control_socket.schema.json defines lines and commands; tests compare what is sent with it.
namespace tessera {

inline constexpr std::size_t longest_piece = std::size_t{256} << 10U;

/// $XDG_RUNTIME_DIR/tessera, or /tmp/tessera-UID. Only its owner may enter it.
[[nodiscard]] std::string monitor_folder();

}  // namespace tessera
