#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace tessera::cli {

/// The connection to the control socket of a controller that runs (tessera/monitor.hpp).
///
/// Threads: one.
class RunningController {
 public:
  /// nullopt: nobody listens there.
  [[nodiscard]] static std::optional<RunningController> attach(const std::filesystem::path& socket_file);
  RunningController(RunningController&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), pending_(std::move(other.pending_)) {}
  RunningController(const RunningController&) = delete;
  RunningController& operator=(const RunningController&) = delete;
  RunningController& operator=(RunningController&&) = delete;
  ~RunningController();

  /// The next line that it sends; nullopt: it has ended.
  [[nodiscard]] std::optional<std::string> line();
  /// false: it has ended.
  [[nodiscard]] bool send(std::string_view text) const;

 private:
  explicit RunningController(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
  std::string pending_;
};

/// The one that `which` (a system, a process, or empty for any) means. nullopt after the reason, such as that
/// there are several, has been printed.
[[nodiscard]] std::optional<RunningController> find_controller(const std::string& which);

}  // namespace tessera::cli
