#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "tessera/result.hpp"

/// A controller can be watched while it runs. On the steady clock it listens on a Unix socket
/// `<monitor_folder()>/<system>.<pid>.sock` (monitor_file). To every client it sends a line of JSON at once
/// and then five times a second:
///
///     {"system", "pid", "net_hash", "time_s", "recording": file; absent: none,
///      "emergency": why an emergency stop stands; absent: none does,
///      "subsystems": [{"path", "behaviour", "calling", "ended", "iterations", "firings", "overruns",
///                      "errors", "period_s", "called_at_s", "call_s", "longest_call_s",
///                      "memory": [{"name", "value": text}]; absent: it has none}],
///      "channels": [{"name", "marked": ["full"], "sending_since_s"}],
///      "waits": [{"subsystem", "waits_for": path, "channel", "what": "answer" | "value", "process", "since_s"}],
///      "process", "host", "incarnation": only of a process of a deployed system, as is
///      "links": [{"process", "host", "reachable", "since_s", "heard_s", "sent", "repeated", "received",
///                 "duplicates", "signs", "signs_lost", "clock_ahead_s", "clock_uncertainty_s"}]}
///
/// It never waits for a client: a client that has not taken a line does not get the next ones, and
/// a client that takes nothing for five seconds is dropped. If 64 clients only watch, another must send a
/// command within three seconds. For a large system the lines come less often, so that the thread takes at
/// most a fiftieth of a processor. The last line is {"ended": true}; without it the connection was lost.
///
/// Clients may send commands, one JSON object per line. Every controller that listens accepts this one:
///
///     {"command": "recording"}
///
/// It is answered by a line {"recording_bytes": N, "begins": bool, "more": bool} and the next N bytes of the
/// recording (tessera/recording.hpp), at most `longest_piece` at a time, as far as they are in the file. The
/// first answer starts at the beginning of the recording, or of the newest segment if it has a limit.
/// `begins` is true where a segment begins. `more` is true if more bytes are there already. A client that has
/// asked once gets the rest without asking after {"ended": true}, as far as the socket has space.
///
///     {"command": "scene", "from": N}
///
/// is answered by {"scene_bytes": N, "from": N, "total": N} and the next N bytes of the scene of the simulated
/// world (tessera/poses.hpp), a glTF file; total 0: there is none.
///
/// Every run accepts these commands, and answers them like those below:
///
///     {"id": 1, "command": "set", "path": "v", "value": "0.3"}   sets a parameter, as `--set v=0.3`;
///                                                                with "try": true, only says whether it can
///     {"command": "emergency_stop", "why": text}                 gives every device its safe command, and
///                                                                nothing else until the reset; in real time
///                                                                the answer comes once all have taken it, or
///                                                                names those that have not after a second
///     {"command": "reset"}                                       ends the emergency stop (by an operator);
///                                                                refused until all devices have obeyed it
///     {"command": "panel", "path": "robot.operator.drive", "operator": text, "values": {"turn": 0.2}}
///                                                                an input of a panel (docs/use/drivers.md);
///                                                                without "values": the operator lets go
///
///     {"command": "offers"}                                      the answer has "offered": all parameters and
///                                                                panels, with values, units and ranges
///
/// An answer with {"elsewhere": true} says that no subsystem of this process has such a parameter or panel;
/// another process of the system may have it.
///
/// Under the simulated clock, only a run that was started with `--controlled` listens. It sends 25 lines a
/// second, which also have {"paused", "pauses", "speed", "broke_at"}. It accepts more commands and answers
/// each by a line {"answer": its id, "error": ""}:
///
///     {"id": 1, "command": "pause" | "resume" | "step_firing"}
///     {"command": "step_iteration", "subsystem": path}   goes on until the transition function of the
///                                                        subsystem is called again; without "subsystem":
///                                                        that of any subsystem
///     {"command": "speed", "value": 0.1}                 simulated seconds a second; 0: as fast as possible
///     {"command": "breakpoints", "places": [name...], "transitions": [name...], "conditions": [name...]}
///         replaces the breakpoints before: the run pauses when one of these places gets a token, one of
///         these transitions has fired, or the condition of one of these holds and its tokens are in its
///         subsystem. Transitions are those of subsystems: `t_in` and `t_out` of system and agents fire only
///         at the begin and at the end.
///     {"command": "own"}                                 no answer; the run ends when this connection ends
///
/// share/tessera/control_socket.schema.json defines lines and commands; tests compare what is sent with it.
namespace tessera {

inline constexpr std::size_t longest_piece = std::size_t{256} << 10U;

/// $XDG_RUNTIME_DIR/tessera, or /tmp/tessera-UID if the variable is unset or its path is too long for a
/// socket. Only its owner may enter the folder.
[[nodiscard]] std::string monitor_folder();

/// Why no controller of this user can have its socket in that folder, and nothing in it may be believed:
/// "'/tmp/tessera-1000' belongs to another user (number 1001)", "... is a link". nullopt: it is this user's
/// alone, or does not exist and can be made.
[[nodiscard]] std::optional<Problem> wrong_with_monitor_folder();

/// The socket of a process, NAME.PID.sock in that folder; name: SYSTEM or SYSTEM.PROCESS. The path of a
/// socket has at most 107 bytes. So the end of a longer name is replaced by a hash:
/// "warehouse_of_the_n~1a2b3c4d.4711.sock".
[[nodiscard]] std::string monitor_file(std::string_view name, std::int64_t process);

inline constexpr char cut_off_name = '~';  ///< before the hash; no name has it

/// Whether the name in such a file name was cut off: then only the lines of the process contain it.
[[nodiscard]] constexpr bool has_shortened_name(std::string_view file) {
  return file.substr(file.rfind('/') + 1).find(cut_off_name) != std::string_view::npos;
}

}  // namespace tessera
