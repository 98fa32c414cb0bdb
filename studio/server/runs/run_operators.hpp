#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace tessera::server {

/// The operators of the panels of one run, as far as their inputs pass through this server.
///
/// A network may hold an input back while the operator has long released the stick. Each answer therefore has a
/// stamp, and each input names the newest stamp that its page has seen: an input that arrives too long after
/// that stamp is not used. No clock of another machine is read.
///
/// Times are of the steady clock, in seconds. Threads: any.
class RunOperators {
 public:
  struct Input {
    std::string path, who;
    std::optional<double> after_s;   ///< the newest stamp that the page has seen; nullopt: none yet
    std::optional<double> within_s;  ///< how much older than its arrival the stamp may be
  };
  /// Whether the network has held the input back for so long that it must not be used.
  [[nodiscard]] static bool is_late(const Input& input, double now_s);

  /// The controller has taken the input.
  void gave(const Input& input, double now_s);
  void let_go(const std::string& path, const std::string& who);
  /// {"stamp", "operators": [{"path", "operator"}]}: docs/reference/studio.md.
  [[nodiscard]] nlohmann::json shown(double now_s) const;

 private:
  struct Given {
    std::string who;
    double until_s = 0;
  };
  mutable std::mutex mutex_;  ///< guards the member below
  std::map<std::string, Given> given_;
};

/// The stamp of an answer: seconds of the steady clock.
[[nodiscard]] double stamp_now();

}  // namespace tessera::server
