// The guardian's side: everything here runs in its own process, which has one thread.

#include <fcntl.h>
#include <fmt/core.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <exception>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/devices.hpp"
#include "drivers/whole_driver.hpp"
#include "safety/guardian_shared.hpp"
#include "safety/protection.hpp"
#include "system/service.hpp"
#include "system/waker.hpp"

namespace tessera {
namespace {

using Stage = Guardian::Shared::Stage;

constexpr int guardian_looks_every_ms = 50;
// A process that has announced its death dies within this time; a core dump takes longer.
constexpr int dies_within_ms = 50;
constexpr std::int64_t between_guardian_attempts_ns = 5'000'000;

/// A driver that the guardian has made, and the safe values of the buffers that it serves.
struct GuardedDriver {
  std::string path;
  Bindings* bindings = nullptr;
  Device* device = nullptr;
  std::vector<std::unique_ptr<RealEffector>> buffers{};
  std::size_t first = 0;  // of Bindings::real_outputs
};

/// The subsystem whose buffers the drivers serve.
struct GuardedSubsystem {
  std::unique_ptr<Subsystem> subsystem;
  Bindings bindings;
};

void say_as_guardian(const std::string& text) {
  const std::string line = fmt::format("{}tessera guardian: {}\n", writes_to_journal() ? "<3>" : "", text);
  pollfd target{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  if (poll(&target, 1, 0) != 1 || (target.revents & POLLOUT) == 0) return;
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
}

/// Opens the device, gives the safe command, and closes it. false, or an exception:
/// it did not work this time.
[[nodiscard]] bool secure(const GuardedDriver& guarded) {
  if (!guarded.device->open()) return false;
  bool taken = true;
  for (std::size_t index = 0; index < guarded.buffers.size(); ++index) {
    const Bindings::RealOutgoing& output = guarded.bindings->real_outputs[guarded.first + index];
    taken = guarded.buffers[index]->write({static_cast<const std::byte*>(output.safe.get()), output.size}) &&
            taken;
  }
  guarded.device->close();
  return taken;
}

/// The state of the devices; those that may still move come first.
[[nodiscard]] std::string fate_of_devices(const std::vector<std::string>& refused,
                                          const std::vector<std::string>& unguarded,
                                          const std::vector<std::string>& safe, double took_ms) {
  std::vector<std::string> parts;
  if (!refused.empty())
    parts.push_back(fmt::format("NOT SAFE, since {} not take the safe command: {}",
                                refused.size() == 1 ? "it does" : "they do", listed_devices(refused)));
  if (!unguarded.empty())
    parts.push_back(fmt::format("not guarded, so {} state is unknown: {}",
                                unguarded.size() == 1 ? "its" : "their", listed_devices(unguarded)));
  if (!safe.empty())
    parts.push_back(
        fmt::format("{} {}, after {:.1f} ms", listed_devices(safe),
                    safe.size() == 1 ? "has got its safe command" : "have got their safe commands", took_ms));
  return fmt::format("{}", fmt::join(parts, "; "));
}

[[noreturn]] void secure_until_taken(const GuardedDriver& guarded) {
  const std::int64_t until_ns = monotonic_ns() + Guardian::patience.count();
  while (monotonic_ns() < until_ns) {
    try {
      if (secure(guarded)) _exit(0);
    } catch (...) {  // the caller tries again
    }
    const timespec pause{.tv_sec = 0, .tv_nsec = between_guardian_attempts_ns};
    nanosleep(&pause, nullptr);
  }
  _exit(1);
}

class GuardianProcess {
 public:
  GuardianProcess(Guardian::Shared& shared, int news, pid_t controller)
      : shared_(shared), news_(news), pid_(controller), controller_(controller) {}

  void make_drivers(const System& system, const RunOptions& options) {
    for (const CppDriver* driver : guarded_drivers(system, options)) make_driver(system, *driver);
    unguarded_ = effectors_without_guardian(system, options);
  }

  /// Watches until the controller has ended, or no longer needs the guardian.
  void watch() {
    for (;;) {
      const bool ended = controller_.await_end(news_, guardian_looks_every_ms);
      shared_.signs_of_life.fetch_add(1, std::memory_order_relaxed);
      std::uint64_t count = 0;
      [[maybe_unused]] const ssize_t taken = read(news_, &count, sizeof count);
      if (shared_.stage.load() == Stage::dismissed) return;
      if (ended) return make_safe("the controller has died");
      if (shared_.dying.load()) return outlive();
      if (!stands_still()) continue;
      if (!is_stopped()) return kill_controller();
      make_safe("the controller stands still, since it is stopped");
    }
  }

 private:
  void make_driver(const System& system, const CppDriver& driver) {
    for (const Instance& instance : system.instances) {
      const std::string path = fmt::format("{}.{}", instance.agent, instance.name);
      const bool whole = driver.path == path;
      if (!whole && !(driver.path.starts_with(path) && driver.path.substr(path.size()).starts_with('.')))
        continue;
      GuardedSubsystem& owner = subsystem_of(path, instance);
      GuardedDriver guarded{.path = std::string(driver.path), .bindings = &owner.bindings};
      auto made = driver.effector(
          DriverSetup(std::string(driver.path), {driver.options.begin(), driver.options.end()}));
      guarded.device = made.get();
      if (whole)
        guarded.buffers = parts_of(std::move(made), owner.bindings);
      else if (find_buffer(driver.path.substr(path.size() + 1), guarded))
        guarded.buffers.push_back(std::move(made));
      if (!guarded.buffers.empty()) drivers_.push_back(std::move(guarded));
      return;
    }
  }

  GuardedSubsystem& subsystem_of(const std::string& path, const Instance& instance) {
    std::unique_ptr<GuardedSubsystem>& owner = subsystems_[path];
    if (owner == nullptr) {
      owner = std::make_unique<GuardedSubsystem>();
      owner->subsystem = instance.make();
      owner->subsystem->bind(owner->bindings);
    }
    return *owner;
  }

  [[nodiscard]] static bool find_buffer(std::string_view name, GuardedDriver& guarded) {
    const auto& outputs = guarded.bindings->real_outputs;
    while (guarded.first < outputs.size() && outputs[guarded.first].name != name) ++guarded.first;
    return guarded.first < outputs.size();
  }

  /// Counts the checks of this process and not the time: a machine that sleeps or is overloaded delays both.
  [[nodiscard]] bool stands_still() {
    constexpr auto enough = static_cast<unsigned>(
        std::chrono::duration_cast<std::chrono::milliseconds>(Guardian::stands_still_after).count() /
        guardian_looks_every_ms);
    const std::uint64_t beats = shared_.beats.load(std::memory_order_relaxed);
    if (shared_.stage.load() != Stage::beating || beats != beats_) {
      beats_ = beats;
      looks_ = 0;
      has_secured_ = false;
      return false;
    }
    return ++looks_ >= enough && !has_secured_;
  }

  /// Whether the controller was stopped by SIGSTOP, or by a debugger.
  [[nodiscard]] bool is_stopped() const {
    std::array<char, 512> text{};
    const int file = open(fmt::format("/proc/{}/stat", pid_).c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    const ssize_t count = read(file, text.data(), text.size());
    close(file);
    const std::string_view stat(text.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    const std::size_t name_end = stat.rfind(')');  // the name may contain any character
    if (name_end == std::string_view::npos || name_end + 2 >= stat.size()) return false;
    return stat[name_end + 2] == 'T' || stat[name_end + 2] == 't';
  }

  void kill_controller() {
    say_as_guardian("the controller stands still, and is killed");
    kill(pid_, SIGKILL);
    outlive();
  }

  /// Waits until the controller is gone, because it may hold a device or write to it.
  /// A core dump may take long.
  void outlive() {
    if (!controller_.await_end(-1, dies_within_ms)) {
      make_safe("the controller is dying");
      static_cast<void>(controller_.await_end(-1, -1));
    }
    make_safe("the controller has died");
  }

  /// Uses one process per driver, so that a driver that hangs or crashes delays no other.
  void make_safe(const std::string& why) {
    // In this order: either the controller, which dismisses and then asks, learns of it, or nothing is done.
    shared_.has_acted = true;
    if (shared_.stage.load() == Stage::dismissed) return;
    has_secured_ = true;
    const std::int64_t start_ns = monotonic_ns();
    std::map<pid_t, const GuardedDriver*> working;
    std::vector<std::string> refused, safe;
    for (const GuardedDriver& guarded : drivers_) {
      const pid_t process = fork();
      if (process == 0) secure_until_taken(guarded);
      if (process > 0) working.emplace(process, &guarded);
      if (process < 0) refused.push_back(guarded.path);
    }
    const std::int64_t until_ns = start_ns + Guardian::patience.count() + 1'000'000'000;
    while (!working.empty() && monotonic_ns() < until_ns) {
      int status = 0;
      const pid_t ended = waitpid(-1, &status, WNOHANG);
      if (const auto found = working.find(ended); found != working.end()) {
        const bool taken = WIFEXITED(status) && WEXITSTATUS(status) == 0;
        (taken ? safe : refused).push_back(found->second->path);
        working.erase(found);
      } else {
        const timespec pause{.tv_sec = 0, .tv_nsec = 500'000};
        nanosleep(&pause, nullptr);
      }
    }
    for (const auto& [process, guarded] : working) {
      kill(process, SIGKILL);
      waitpid(process, nullptr, 0);
      refused.push_back(guarded->path);
    }
    const double took_ms = static_cast<double>(monotonic_ns() - start_ns) * 1e-6;
    // The processes end in any order.
    for (std::vector<std::string>* names : {&refused, &safe}) std::ranges::sort(*names);
    say_as_guardian(fmt::format("{}; {}", why, fate_of_devices(refused, unguarded_, safe, took_ms)));
  }

  Guardian::Shared& shared_;
  int news_;
  pid_t pid_;
  OtherProcess controller_;
  std::map<std::string, std::unique_ptr<GuardedSubsystem>> subsystems_;  // by the path of the subsystem
  std::vector<GuardedDriver> drivers_;
  std::vector<std::string> unguarded_;
  std::uint64_t beats_ = 0;
  unsigned looks_ = 0;        // without a beat
  bool has_secured_ = false;  // since the last beat
};

/// Makes sure that this process lives as long as the controller, whatever signals end both.
void become_independent(const System& system) {
  setsid();
  prctl(PR_SET_NAME, "tessera-guard");
  for (int signal = 1; signal <= SIGRTMAX; ++signal) {
    const bool needed = signal == SIGCHLD || signal == SIGSEGV || signal == SIGBUS || signal == SIGFPE ||
                        signal == SIGILL || signal == SIGABRT || signal == SIGSYS || signal == SIGTRAP;
    std::signal(signal, needed ? SIG_DFL : SIG_IGN);
  }
  // The priority is above that of every thread of the controller, if one asks for real
  // time and that is permitted.
  int highest = 0;
  for (const Instance& instance : system.instances)
    highest = std::max(highest, instance.policies.realtime.priority);
  if (highest == 0) return;
  sched_param priority{};
  priority.sched_priority = std::min(highest + 2, 99);
  static_cast<void>(sched_setscheduler(0, SCHED_FIFO, &priority));
}

}  // namespace

std::vector<const CppDriver*> guarded_drivers(const System& system, const RunOptions& options) {
  std::vector<const CppDriver*> drivers;
  for (const CppDriver& driver : system.real_drivers)
    if (driver.guarded && driver.effector != nullptr && opens_real_driver(options, driver.path))
      drivers.push_back(&driver);
  return drivers;
}

std::vector<std::string> effectors_without_guardian(const System& system, const RunOptions& options) {
  std::vector<std::string> paths;
  for (const CppDriver& driver : system.real_drivers)
    if (!(driver.guarded && options.guardian) && driver.effector != nullptr &&
        opens_real_driver(options, driver.path) && is_of(system, driver))
      paths.emplace_back(driver.path);
  return paths;
}

void live_as_guardian(const System& system, const RunOptions& options, Guardian::Shared& shared, int news,
                      pid_t controller) {
  try {
    become_independent(system);
    GuardianProcess guardian(shared, news, controller);
    guardian.make_drivers(system, options);
    Stage starts = Stage::starts;
    shared.stage.compare_exchange_strong(starts, Stage::ready);
    guardian.watch();
    _exit(0);
  } catch (const std::exception& exception) {
    std::strncpy(shared.error, exception.what(), sizeof shared.error - 1);
  } catch (...) {
    std::strncpy(shared.error, "an exception that is no std::exception", sizeof shared.error - 1);
  }
  shared.stage = Stage::failed;
  _exit(1);
}

}  // namespace tessera
