#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "tessera/kept.hpp"
#include "tessera/time.hpp"

namespace tessera {

enum class LogLevel : std::uint8_t { info, warning, error };

/// Receives the requests that a transition function makes through its Context. The executor implements it; a
/// test can do so, too.
class ContextServices {
 public:
  virtual ~ContextServices() = default;
  virtual void log(LogLevel level, std::string_view text) = 0;
  virtual void stop(std::string_view reason) = 0;
  virtual void emergency_stop(std::string_view reason) {
    log(LogLevel::error, reason);
    stop(reason);
  }
  /// Called when an assertion of the user does not hold.
  virtual void broken(std::string_view assertion) {
    log(LogLevel::error, assertion);
    stop(assertion);
  }
};

/// Thrown by Context::assert_that outside a run, as in a plain unit test.
class BrokenAssertion : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Everything that a transition function may use besides its buffers. Generated contexts add `parameters`.
///
/// Threads: only inside the transition function it was passed to.
class Context {
 public:
  Time now{};                   ///< one value for the whole iteration
  Duration period{};            ///< of the subsystem's rate; zero if it has none
  std::uint64_t iteration = 0;  ///< i of the paper: counts over all behaviours of the subsystem
  /// Time since the first call of the behaviour's transition function; zero in that call. A behaviour that
  /// follows itself by `next` begins again. Measured by the clock of the run, as `now`.
  Duration in_behaviour{};
  std::uint32_t index = 0;   ///< of the agent in its fleet, from 0; 0 if it is in none
  std::uint32_t member = 0;  ///< for which the behaviour is (`for: each robot`), from 0; 0 if it is for none

  /// Writes to the terminal and the recording, with time and path. Allocates nothing; cuts text at 512 bytes.
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

  /// Emergency stop: every device of this process gets its safe command at once, and nothing else until an
  /// operator ends it (`tessera reset`). Otherwise the process goes on: it reads sensors and computes. Without
  /// `deploy:`, the process is the whole system; with it, devices of other processes go on.
  void emergency_stop(std::string_view reason) {
    if (services_ != nullptr) services_->emergency_stop(reason);
  }

  /// States a condition that must hold here; `tessera schedules` looks for a run that violates it.
  /// If it does not hold, the run has failed: the text goes to the recording, and the system stops safely
  /// after this transition function. In a plain unit test, the function throws BrokenAssertion.
  template <class... Args>
  void assert_that(bool holds, fmt::format_string<Args...> format, Args&&... args) {
    if (!holds) report_broken(format, fmt::make_format_args(args...));
  }

  /// services: nullptr, as in a plain unit test, makes `log` print to standard error and `stop` do nothing.
  void attach(ContextServices* services) { services_ = services; }

 private:
  void print(LogLevel level, fmt::string_view format, fmt::format_args args);
  void report_broken(fmt::string_view format, fmt::format_args args);
  ContextServices* services_ = nullptr;
};

}  // namespace tessera

/// A value of memory that the net keeps, in a line of the log: its name, or its count. It takes no format.
namespace tessera::detail {
struct KeptFormatter {
  constexpr auto parse(fmt::format_parse_context& context) { return context.begin(); }
  template <class FormatContext>
  static auto put(std::string_view text, FormatContext& context) {
    auto out = context.out();
    for (const char letter : text) *out++ = letter;
    return out;
  }
};
}  // namespace tessera::detail
template <class Value>
struct fmt::formatter<tessera::Kept<Value>> : tessera::detail::KeptFormatter {
  template <class FormatContext>
  auto format(const tessera::Kept<Value>& kept, FormatContext& context) const {
    return put(kept.view(), context);
  }
};
template <int Least, int Most>
struct fmt::formatter<tessera::Counter<Least, Most>> : tessera::detail::KeptFormatter {
  template <class FormatContext>
  auto format(const tessera::Counter<Least, Most>& counter, FormatContext& context) const {
    return put(std::to_string(int{counter}), context);
  }
};
