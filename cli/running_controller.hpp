#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::cli {

/// The connection to the control socket of a controller that runs (tessera/monitor.hpp).
///
/// Threads: one.
class RunningController {
 public:
  /// nullopt: nobody listens there.
  [[nodiscard]] static std::optional<RunningController> attach(const std::filesystem::path& socket_file);
  RunningController(RunningController&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)),
        name_(std::move(other.name_)),
        pending_(std::move(other.pending_)) {}
  RunningController(const RunningController&) = delete;
  RunningController& operator=(const RunningController&) = delete;
  RunningController& operator=(RunningController&&) = delete;
  ~RunningController();

  /// SYSTEM.PROCESS
  [[nodiscard]] const std::string& name() const { return name_; }

  /// The next line that it sends; nullopt: it has ended, or sent nothing for the time of `be_patient_for`.
  [[nodiscard]] std::optional<std::string> line();
  /// From now on nothing waits for longer than that: a process may be stopped, or hang.
  void be_patient_for(std::chrono::milliseconds time);
  /// false: it has ended, or takes nothing.
  [[nodiscard]] bool send(std::string_view text) const;

 private:
  RunningController(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}
  int descriptor_;
  std::string name_, pending_;
};

/// All that `which` (a system, a process, or empty for all) means. Empty after it was printed that there is
/// none.
[[nodiscard]] std::vector<RunningController> find_controllers(const std::string& which);

/// The one that `which` (a system, a process, or empty for any) means. nullopt after the reason, such as that
/// there are several, has been printed.
[[nodiscard]] std::optional<RunningController> find_controller(const std::string& which);

}  // namespace tessera::cli
