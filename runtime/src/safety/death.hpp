#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tessera {

/// How a process ended during a run.
struct Death {
  enum class Kind : std::uint8_t { signal, exit, quick_exit } kind = Kind::signal;
  int number = 0;                 ///< of the signal, or the exit code
  const void* address = nullptr;  ///< of the memory access, if there was one
  bool has_address = false;
  std::string_view detail{};  ///< the reason of std::terminate; empty: another kind of end
};

/// "killed by SIGSEGV at address 0x10", "called exit(0)". room: memory for the text. Async-signal-safe.
[[nodiscard]] std::string_view describe(const Death& death, std::span<char> room);

class RunControl;
class SubsystemExecutor;

/// The behaviour that the subsystem is in, or was in last: "robot.control.follow". Async-signal-safe.
[[nodiscard]] std::string_view where_a_subsystem_is(const SubsystemExecutor& executor, std::span<char> room);

/// The position of the calling thread: "robot.control.follow", "robot.control", or "the
/// controller". Async-signal-safe.
[[nodiscard]] std::string_view where_this_thread_is(std::span<char> room);

/// The thread of the subsystem has ended by pthread_exit: the run is to stop, as a fault. Threads: that thread.
void complain_of_ended_thread(SubsystemExecutor& executor, RunControl& control);

}  // namespace tessera
