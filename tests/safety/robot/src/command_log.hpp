#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <ctime>

/// A mapped file that the robot's drivers write and the test reads. It outlives the controller, and a command
/// is in it as soon as the driver has written it.
namespace command_log {

/// The faults that the robot causes in itself on request.
enum class Harm : std::uint32_t {
  none,
  abort,
  exit,
  quick_exit,
  underscore_exit,
  segv,
  bus,
  fpe,
  ill,
  sys,
  trap,
  terminate,
  throw_number,
  pthread_exit,
  stack_overflow,
  loop,
  fifo_loop,
  out_of_memory,
  kill,
  stop,
  exec,
  close_all,
  chatter,
  mute  ///< goes on and sends no value any more
};
/// In which code.
enum class Place : std::uint32_t { control, motor, driver };

inline constexpr unsigned devices = 3;  ///< left, right, joint

struct Command {
  std::atomic<std::int64_t> at_ns{0};  ///< CLOCK_MONOTONIC; 0: not written yet
  double value = 0;
  std::uint32_t device = 0;
  std::int32_t process = 0;
};

struct Log {
  std::atomic<Harm> harm{Harm::none};
  std::atomic<Place> place{Place::control};
  std::atomic<std::int64_t> struck_ns{0};  ///< when the harm was done
  std::atomic<bool> hangs_when_safe{
      false};  ///< the driver of device 0 does not return from its next safe command
  std::atomic<std::uint64_t> count{0};
  std::array<Command, 1U << 16U> commands;
};

inline std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

/// nullptr when it cannot be mapped. The file is as long as a Log, and zeros when it is new.
inline Log* map(const char* path) {
  const int file = open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) return nullptr;
  void* const memory = mmap(nullptr, sizeof(Log), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  return memory == MAP_FAILED ? nullptr : static_cast<Log*>(memory);
}

/// The one of this process; the environment names it.
inline Log* own() {
  static Log* const log = [] {
    const char* const path = std::getenv("COMMAND_LOG");
    return path == nullptr ? nullptr : map(path);
  }();
  return log;
}

inline void note(Log& log, std::uint32_t device, double value) {
  const std::uint64_t index = log.count.fetch_add(1);
  if (index >= log.commands.size()) return;
  Command& command = log.commands[index];
  command.value = value;
  command.device = device;
  command.process = getpid();
  command.at_ns.store(now_ns(), std::memory_order_release);
}

}  // namespace command_log
