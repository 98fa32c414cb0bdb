#pragma once

#include <string>

/// A controller that runs on the steady clock can be looked at while it runs: it listens on a Unix socket
/// `<monitor_folder()>/<system>.<pid>.sock`, and sends to whoever connects a line of JSON at once and then
/// five times a second:
///
///     {"system", "pid", "net_hash", "time_s",
///      "subsystems": [{"path", "behaviour", "calling", "ended", "iterations", "firings", "overruns",
///      "errors",
///                      "period_s", "called_at_s", "call_s", "longest_call_s"}],
///      "channels": [{"name", "marked": ["full"]}]}
///
/// It reads nothing from its clients and never waits for one: who does not keep up is dropped.
namespace tessera {

/// $XDG_RUNTIME_DIR/tessera, or /tmp/tessera-UID. Only its owner may enter it.
[[nodiscard]] std::string monitor_folder();

}  // namespace tessera
