#include "safety/last_chance.hpp"

#include <cxxabi.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <typeinfo>

#include "system/realtime.hpp"
#include "system/service.hpp"
#include "tessera/printable.hpp"

namespace tessera {
namespace {

constexpr std::array deadly{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP};
constexpr std::int64_t recorder_settles_ns = 12'000'000;  // two rounds of the recorder's thread

std::atomic<LastChance*> active{nullptr};
// the process that owns the object, as opposed to a process that user code has forked
std::atomic<pid_t> owner{0};
std::atomic<pid_t> dying{0};  // the thread that uses the object
std::array<struct sigaction, deadly.size()> before{};
std::terminate_handler terminate_before = nullptr;
thread_local constinit std::array<char, 256> terminate_text{};
static_assert(std::atomic<LastChance*>::is_always_lock_free && std::atomic<pid_t>::is_always_lock_free);

[[nodiscard]] pid_t this_thread() { return static_cast<pid_t>(syscall(SYS_gettid)); }

/// Returns the object to the first thread that dies. Other threads wait until that thread ends the process.
[[nodiscard]] LastChance* claim() {
  LastChance* const chance = active.load();
  if (chance == nullptr || owner.load() != getpid()) return nullptr;
  pid_t nobody = 0;
  if (dying.compare_exchange_strong(nobody, this_thread())) return chance;
  while (nobody != this_thread()) pause();
  return nullptr;  // this thread crashed while it handled its death
}

/// Ends the process as if the signal had not been handled: restores the earlier handler, which makes the
/// core dump. An instruction that caused the signal causes it again, so that a debugger finds it there.
/// Other signals are sent again.
void deliver_again(int signal, const siginfo_t& info) {
  const auto place = std::find(deadly.begin(), deadly.end(), signal) - deadly.begin();
  struct sigaction action = before[static_cast<std::size_t>(place)];
  if ((action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_IGN) action.sa_handler = SIG_DFL;
  sigaction(signal, &action, nullptr);
  const bool by_instruction = info.si_code > 0 && signal != SIGTRAP && signal != SIGSYS;
  if (!by_instruction) syscall(SYS_tgkill, getpid(), this_thread(), signal);
}

extern "C" void on_deadly_signal(int signal, siginfo_t* info, void* /*context*/) {
  const int kept_errno = errno;
  Rescuer::leave_crashed_driver();
  if (LastChance* const chance = claim(); chance != nullptr) {
    Death death{.number = signal};
    death.has_address = info->si_code > 0 && (signal == SIGSEGV || signal == SIGBUS);
    death.address = info->si_addr;
    if (signal == SIGABRT) death.detail = terminate_text.data();
    chance->use(death);
  }
  deliver_again(signal, *info);
  errno = kept_errno;
}

extern "C" void on_exit_called(int code, void* /*unused*/) {
  LastChance* const chance = claim();
  if (chance == nullptr) return;
  chance->use({.kind = Death::Kind::exit, .number = code});
  _exit(1);
}

extern "C" void on_quick_exit_called() {
  LastChance* const chance = claim();
  if (chance == nullptr) return;
  chance->use({.kind = Death::Kind::quick_exit});
  _exit(1);
}

/// Keeps the reason for the message of the SIGABRT that follows.
[[noreturn]] void on_terminate() {
  const auto say = [](auto format, const auto&... values) {
    std::array<char, 256> text;
    const auto end = fmt::format_to_n(text.data(), text.size(), format, values...);
    const std::string_view shown = printable({text.data(), std::min(end.size, text.size())},
                                             std::span(terminate_text.data(), terminate_text.size() - 1));
    terminate_text[shown.size()] = '\0';
  };
  if (const std::type_info* const type = abi::__cxa_current_exception_type(); type == nullptr) {
    say(FMT_STRING("std::terminate"));
  } else {
    try {
      throw;
    } catch (const std::exception& exception) {
      say(FMT_STRING("std::terminate: {}"), exception.what());
    } catch (...) {
      say(FMT_STRING("std::terminate: an exception of type {}"), type->name());
    }
  }
  std::abort();
}

void handle_deadly_signals() {
  struct sigaction action {};
  action.sa_sigaction = on_deadly_signal;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigfillset(&action.sa_mask);  // signals that stop a run come later
  for (const int signal : deadly) sigdelset(&action.sa_mask, signal);
  for (std::size_t index = 0; index < deadly.size(); ++index)
    sigaction(deadly[index], &action, &before[index]);
}

/// atexit cannot be undone, so it is called once; without a run the handler does nothing.
void notice_exit() {
  static const bool noticed = [] {
    on_exit(on_exit_called, nullptr);
    std::at_quick_exit(on_quick_exit_called);
    return true;
  }();
  static_cast<void>(noticed);
}

/// Writes only if that does not have to wait for the reader.
void write_now(int descriptor, std::string_view text) {
  pollfd target{.fd = descriptor, .events = POLLOUT, .revents = 0};
  if (poll(&target, 1, 0) != 1 || (target.revents & POLLOUT) == 0) return;
  [[maybe_unused]] const ssize_t written = write(descriptor, text.data(), text.size());
}

void leave_note(const char* file, std::string_view text) {
  if (file[0] == '\0') return;
  const int descriptor = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0644);
  if (descriptor < 0) return;
  [[maybe_unused]] const ssize_t written = write(descriptor, text.data(), text.size());
  close(descriptor);
}

}  // namespace

LastChance::LastChance(Assembly& assembly, const Clock& clock, Guardian* guardian)
    : assembly_(assembly),
      clock_(clock),
      guardian_(guardian),
      line_begin_(writes_to_journal()          ? "<2>"
                  : isatty(STDERR_FILENO) != 0 ? "\r\x1b[K"  // removes the progress line
                                               : "") {
  const std::string& file = assembly.options.death_note;
  if (file.size() < note_file_.size()) std::copy(file.begin(), file.end(), note_file_.begin());
  const bool has_devices = std::ranges::any_of(
      assembly.executors, [](const auto& executor) { return !executor->effectors().none(); });
  if (has_devices && (!clock.simulated() || !assembly.options.hardware.empty()))
    rescuer_.emplace(assembly.executors, supervisor_priority(assembly.system.instances));
  notice_exit();
  handle_deadly_signals();
  terminate_before = std::set_terminate(on_terminate);
  dying = 0;
  owner = getpid();
  active = this;
}

LastChance::~LastChance() {
  // A dying thread ends the process, and needs this object until then.
  while (dying.load() != 0) pause();
  active = nullptr;
  std::set_terminate(terminate_before);
  for (std::size_t index = 0; index < deadly.size(); ++index)
    sigaction(deadly[index], &before[index], nullptr);
}

void LastChance::use(const Death& death) {
  std::array<char, 256> place_room;
  std::array<char, 384> what_room;
  std::array<char, 768> line_room;
  const std::string_view place = where_this_thread_is(place_room), what = describe(death, what_room);
  const auto put = [&](auto format, const auto&... values) {
    const auto end = fmt::format_to_n(line_room.data(), line_room.size(), format, values...);
    return std::string_view(line_room.data(), std::min(end.size, line_room.size()));
  };
  // From here on, only the safe command is given.
  assembly_.control.request_stop(put(FMT_STRING("{}: {}"), place, what), /*fault=*/true);
  if (guardian_ != nullptr) guardian_->announce_death();
  const bool safe = !rescuer_ || rescuer_->rescue(Effectors::device_in_call(), patience);

  leave_note(note_file_.data(), put(FMT_STRING("{}\n{}\n"), place, what));
  const std::string_view effect = !rescuer_ ? ""
                                  : safe    ? "; the devices have got the safe command"
                                            : "; not every device has taken the safe command";
  if (SubsystemExecutor* const executor = RunningSubsystem::current(); executor != nullptr)
    executor->record_death(put(FMT_STRING("{}: {}{}"), place, what, effect));
  const double time_s = seconds(clock_.now().time_since_epoch());
  tell(put(FMT_STRING("{}{:.3f} s  {}: {}{}\n"), line_begin_, time_s, place, what, effect));
}

void LastChance::tell(std::string_view text) const {
  write_now(STDERR_FILENO, text);
  if (assembly_.recorder == nullptr) return;
  if (clock_.simulated()) return assembly_.recorder->flush();
  const timespec pause{.tv_sec = 0, .tv_nsec = recorder_settles_ns};
  nanosleep(&pause, nullptr);
}

}  // namespace tessera
