#pragma once

#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/src/command_log.hpp"

namespace tessera::safety_test {

namespace fs = std::filesystem;
using command_log::Harm;
using command_log::Place;

/// The project of `robot`, generated and compiled once for all tests of a build folder.
struct Project {
  fs::path folder, controller;
};
/// The same in every test. Throws std::runtime_error with the messages of the compiler.
[[nodiscard]] const Project& project();

/// A controller that drives the test robot, on a terminal or a pipe of its own.
///
/// Threads: one.
class RobotProcess {
 public:
  enum class Output : std::uint8_t { terminal, pipe };
  /// Starts the command. environment: "NAME=value" on top of the test's own.
  RobotProcess(const std::vector<std::string>& command, Output output,
               const std::vector<std::string>& environment = {});
  RobotProcess(const RobotProcess&) = delete;
  RobotProcess& operator=(const RobotProcess&) = delete;
  /// Kills the remaining processes.
  ~RobotProcess();

  /// Until every device has had so many more commands that drive. false: that did not happen in time.
  [[nodiscard]] bool await_driving(unsigned commands = 3);
  void do_harm(Harm harm, Place place);
  /// From now on, the driver of device 0 does not return from a safe command.
  void hang_in_safe_commands() { log_->hangs_when_safe = true; }
  void send(int signal) const { kill_process(child_, signal); }
  /// Throws std::runtime_error: it has no guardian.
  void send_guardian(int signal) const;
  /// Nothing counts that happens to that device from now on: no program can make it safe.
  void ignore(std::uint32_t device) { ignored_ = device; }
  /// Its first thread, which supervises the run, gets a processor only when no other thread wants it. All
  /// threads share one. false: as before, for every thread that it has then.
  void delay_supervisor(bool delayed) const;
  void type(char key) const;
  /// Closes the terminal, or the reading end of the pipe.
  void hang_up();
  /// From now on, its output is not read.
  void stop_reading() { reading_ = false; }
  void read_again() { reading_ = true; }

  /// Waits until the process that was started has ended; reads its output meanwhile. nullopt: it runs on.
  [[nodiscard]] std::optional<int> await_end(std::chrono::milliseconds limit);
  /// Until every process that holds the terminal or the pipe has ended. false: some are left.
  [[nodiscard]] bool await_nobody_left(std::chrono::milliseconds limit);
  /// Until it has printed that.
  [[nodiscard]] bool await_text(std::string_view wanted, std::chrono::milliseconds limit);
  /// Until the last command of every device is the safe one and has been so for `still`.
  [[nodiscard]] bool await_safe(std::chrono::milliseconds still, std::chrono::milliseconds limit);

  /// When the harm was done; 0: not yet.
  [[nodiscard]] std::int64_t struck_ns() const { return log_->struck_ns; }
  /// The last command of every device is the safe one.
  [[nodiscard]] bool is_safe() const;
  /// When the last device got the safe command for good; 0: none got another command.
  /// Precondition: is_safe().
  [[nodiscard]] std::int64_t safe_since_ns() const;
  /// A device got another command after the safe one that another process than the child gave it.
  [[nodiscard]] bool drove_after_guardian() const;
  /// Processes that have commanded a device.
  [[nodiscard]] std::vector<pid_t> commanders() const;
  [[nodiscard]] pid_t child() const { return child_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  [[nodiscard]] bool is_ours(pid_t process) const;
  struct Last;
  [[nodiscard]] std::array<Last, command_log::devices> last_commands() const;
  static void kill_process(pid_t process, int signal);
  void read_some(int timeout_ms);

  fs::path log_file_;
  command_log::Log* log_ = nullptr;
  pid_t child_ = 0;
  int descriptor_ = -1;  // the terminal's other end, or that of the pipe
  bool reading_ = true, ended_of_text_ = false;
  std::optional<int> status_;
  std::optional<std::uint32_t> ignored_;
  std::string text_;
};

}  // namespace tessera::safety_test
