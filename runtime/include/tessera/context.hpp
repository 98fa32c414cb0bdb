#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "tessera/time.hpp"

namespace tessera {

enum class LogLevel : std::uint8_t { info, warning, error };

/// Where a Context passes what a transition function asks for. The executor implements it; a test may.
class ContextServices {
 public:
  virtual ~ContextServices() = default;
  virtual void log(LogLevel level, std::string_view text) = 0;
  virtual void stop(std::string_view reason) = 0;
  virtual void emergency_stop(std::string_view reason) {
    log(LogLevel::error, reason);
    stop(reason);
  }
  /// What the user asserts does not hold.
  virtual void broken(std::string_view assertion) {
    log(LogLevel::error, assertion);
    stop(assertion);
  }
};

/// What Context::assert_that throws where there is no run that could fail, as in a plain unit test.
class BrokenAssertion : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// What a transition function may ask besides its buffers. Generated contexts add `parameters`.
///
/// Threads: only inside the transition function it was passed to.
class Context {
 public:
  Time now{};                   ///< one value for the whole iteration
  Duration period{};            ///< of the subsystem's rate; zero without one
  std::uint64_t iteration = 0;  ///< i of the paper: counts over all behaviours of the subsystem

  /// To the terminal and the record, with time and path. No allocation; text beyond 512 bytes is cut.
  template <class... Args>
  void log(fmt::format_string<Args...> format, Args&&... args) {
    print(LogLevel::info, format, fmt::make_format_args(args...));
  }
  template <class... Args>
  void warn(fmt::format_string<Args...> format, Args&&... args) {
    print(LogLevel::warning, format, fmt::make_format_args(args...));
  }

  /// Ends the whole system safely (paper: a behaviour commands the scheduler to terminate).
  void stop(std::string_view reason = "requested by a behaviour") {
    if (services_ != nullptr) services_->stop(reason);
  }

  /// Emergency stop: every device of the system gets its safe command at once, and nothing else until an
  /// operator ends it (`tessera reset`). Otherwise the system goes on: it reads sensors and computes.
  void emergency_stop(std::string_view reason) {
    if (services_ != nullptr) services_->emergency_stop(reason);
  }

  /// States what must hold here, for `tessera simulate --schedules` to look for a run that breaks it. If it
  /// does not hold, the run has failed: the text goes to the record, and the system stops safely, after this
  /// transition function. In a plain unit test it throws BrokenAssertion.
  template <class... Args>
  void assert_that(bool holds, fmt::format_string<Args...> format, Args&&... args) {
    if (!holds) report_broken(format, fmt::make_format_args(args...));
  }

  /// nullptr (as in a plain unit test): log prints to standard error, stop does nothing.
  void attach(ContextServices* services) { services_ = services; }

 private:
  void print(LogLevel level, fmt::string_view format, fmt::format_args args);
  void report_broken(fmt::string_view format, fmt::format_args args);
  ContextServices* services_ = nullptr;
};

}  // namespace tessera
