#include "project/process/process.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <vector>

#include "project/process/spawn.hpp"
#include "tessera/signals.hpp"

namespace tessera::project {

namespace {

/// receiver: as of kill(): the child, or minus its process group.
volatile std::sig_atomic_t receiver = 0, asked_to_suspend = 0, asked_to_stop = 0;

/// A child that is stopped obeys only once it goes on.
extern "C" void pass_on(int signal) {
  const pid_t child = static_cast<pid_t>(receiver);
  (signal == SIGTSTP ? asked_to_suspend : asked_to_stop) = signal;
  if (child == 0) return;
  kill(child, signal);
  if (signal != SIGTSTP) kill(child, SIGCONT);
}

/// A terminal or pipe that takes no text now: what follows is dropped. Without this, it would hold a process that was
/// asked to stop, as long as nobody reads.
void drop_output_that_is_blocked() {
  constexpr int patience_ms = 1000;
  bool dropped = false;
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    pollfd room{.fd = stream, .events = POLLOUT, .revents = 0};
    int ready = 0;
    while ((ready = poll(&room, 1, patience_ms)) < 0 && errno == EINTR) continue;
    if (ready != 0) continue;
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) continue;
    dup2(nowhere, stream);
    close(nowhere);
    dropped = dropped || stream == STDOUT_FILENO;
  }
  constexpr std::string_view note =
      "tessera: standard output took no text after the interrupt: the rest is dropped\n";
  if (dropped) static_cast<void>(!write(STDERR_FILENO, note.data(), note.size()));
}

/// While this object exists, the signals that would end or stop this process go to the child, which decides
/// what to do about them. They are held back until its id is known: a signal just after its start would end
/// this process, and the child, which drives a robot, would run on alone. A signal that is handled or
/// ignored already (nohup) is left as it is.
class SignalsToChild {
 public:
  SignalsToChild() {
    sigset_t all;
    sigemptyset(&all);
    for_handled_signals([&](int signal, SignalUse use) {
      if (use != SignalUse::ignore) sigaddset(&all, signal);
    });
    pthread_sigmask(SIG_BLOCK, &all, &mask_);
  }
  ~SignalsToChild() {
    if (receiver == 0) {
      pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
      return;
    }
    for (const Before& before : before_) sigaction(before.signal, &before.action, nullptr);
    receiver = 0;
  }
  SignalsToChild(const SignalsToChild&) = delete;
  SignalsToChild& operator=(const SignalsToChild&) = delete;

  /// child: as of kill().
  void are_for(pid_t child) {
    asked_to_suspend = 0;
    asked_to_stop = 0;
    receiver = static_cast<std::sig_atomic_t>(child);
    for_handled_signals([&](int signal, SignalUse use) {
      Before before{signal, {}};
      const bool always = signal == SIGINT || signal == SIGTERM;
      if (sigaction(signal, nullptr, &before.action) != 0) return;
      const bool usual = (before.action.sa_flags & SA_SIGINFO) == 0 && before.action.sa_handler == SIG_DFL;
      if (!usual && !always) return;
      struct sigaction action {};
      action.sa_handler = use == SignalUse::ignore ? SIG_IGN : pass_on;
      sigaction(signal, &action, nullptr);
      before_.push_back(before);
    });
    pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
  }

 private:
  struct Before {
    int signal;
    struct sigaction action;
  };
  sigset_t mask_{};
  std::vector<Before> before_;
};

/// The reading end of the child's output.
class Output {
 public:
  Output(const Command& command, bool own_group) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
    descriptor_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (own_group) posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    try {
      child_ = spawn(command, &actions, own_group);
    } catch (...) {
      posix_spawn_file_actions_destroy(&actions);
      close(ends[0]);
      close(ends[1]);
      throw;
    }
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
  }
  ~Output() { close(descriptor_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  [[nodiscard]] pid_t child() const { return child_; }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] std::string& text() { return text_; }

  /// false: there is no more.
  [[nodiscard]] bool read_on(const std::function<void(std::string_view)>& each_line) {
    std::array<char, 4096> buffer{};
    const ssize_t count = ::read(descriptor_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) return true;
    if (count <= 0) return false;
    text_.append(buffer.data(), static_cast<std::size_t>(count));
    for (std::size_t end = 0; each_line && (end = text_.find('\n', line_start_)) != std::string::npos;
         line_start_ = end + 1)
      each_line(std::string_view(text_).substr(line_start_, end - line_start_));
    return true;
  }
  void forget_all_but(std::size_t kept) {
    if (text_.size() < 2 * kept) return;
    const std::size_t gone = text_.size() - kept;
    text_.erase(0, gone);
    line_start_ -= std::min(line_start_, gone);
  }

 private:
  pid_t child_ = 0;
  int descriptor_ = -1;
  std::string text_;
  std::size_t line_start_ = 0;
};

/// The end of a child, and its stops on the way there.
///
/// After Ctrl-Z, this process stops when the child has stopped, and the child continues together with it.
/// If only the child is stopped (kill -STOP, a debugger), this process waits, because the one that
/// continues the child does not know this process.
class ChildEnd {
 public:
  explicit ChildEnd(pid_t child) : child_(child) {}

  /// options: WNOHANG, or 0 to wait for a change. Returns whether the child has ended.
  bool look(int options) {
    const pid_t changed = waitpid(child_, &status_, WUNTRACED | WCONTINUED | options);
    if (changed < 0 && errno != EINTR) return true;
    if (changed > 0 && !WIFSTOPPED(status_) && !WIFCONTINUED(status_)) return true;
    if (changed > 0) stopped_ = WIFSTOPPED(status_);
    if (stopped_ && asked_to_suspend != 0) suspend();
    return false;
  }
  /// This process stops, and the child continues together with it.
  void suspend() {
    asked_to_suspend = 0;
    raise(SIGSTOP);
    kill(receiver == -child_ ? -child_ : child_, SIGCONT);
  }
  [[nodiscard]] int code() const {
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }

 private:
  pid_t child_;
  int status_ = 0;
  bool stopped_ = false;
};

int wait_for(pid_t child) {
  ChildEnd end(child);
  while (!end.look(0)) continue;
  return end.code();
}

/// A child that is stopped writes nothing and does not close its output. So both are looked at in turn.
///
/// A shell that is just starting a program can miss what its group was told: it does not see the end of a program
/// that had not started, and it cannot stop while a program that it starts (vfork) has stopped already. So this process
/// repeats the signal, and does not wait for long until the child has stopped.
int read_to_end(Output& output, const std::function<void(std::string_view)>& each_line) {
  using Clock = std::chrono::steady_clock;
  constexpr int look_period_ms = 100;
  constexpr auto patience = std::chrono::seconds(1);
  ChildEnd end(output.child());
  auto quiet_since = Clock::now();
  bool ended = false;
  for (bool open = true; open;) {
    if (!ended && end.look(WNOHANG)) {
      ended = true;
      if (asked_to_stop != 0) kill(receiver, asked_to_stop);
    }
    if (asked_to_suspend == 0 && asked_to_stop == 0) {
      quiet_since = Clock::now();
    } else if (Clock::now() - quiet_since > patience) {
      quiet_since = Clock::now();
      if (asked_to_suspend != 0) end.suspend();
      if (asked_to_stop != 0) kill(receiver, asked_to_stop);
    }
    pollfd source{.fd = output.descriptor(), .events = POLLIN, .revents = 0};
    if (poll(&source, 1, look_period_ms) > 0) open = output.read_on(each_line);
  }
  while (!ended) ended = end.look(0);
  return end.code();
}

}  // namespace

Exit run(const Command& command) {
  SignalsToChild signals;
  const pid_t child = spawn(command, nullptr, /*own_group=*/false);
  signals.are_for(child);
  const int code = wait_for(child);
  if (asked_to_stop != 0) drop_output_that_is_blocked();
  return {code, {}};
}

Exit capture(const Command& command, const std::function<void(std::string_view)>& each_line) {
  SignalsToChild signals;
  // Programs that start others (cmake) do not pass signals on: the group receives them.
  Output output(command, /*own_group=*/true);
  signals.are_for(-output.child());
  const auto show = [&](std::string_view line) {
    if (asked_to_stop != 0) drop_output_that_is_blocked();
    each_line(line);
  };
  const int code = read_to_end(output, each_line ? show : std::function<void(std::string_view)>());
  if (asked_to_stop != 0) drop_output_that_is_blocked();
  return {code, std::move(output.text()), asked_to_stop};
}

Exit capture_apart(const Command& command, const std::atomic<bool>& stop,
                   const std::function<void(std::string_view)>& each_line,
                   const std::function<void(pid_t)>& started) {
  constexpr std::size_t kept = std::size_t{64} << 10U;
  constexpr auto patience = std::chrono::seconds(5);
  using Clock = std::chrono::steady_clock;
  Output output(command, /*own_group=*/true);
  if (started) started(output.child());
  std::optional<Clock::time_point> asked;
  bool killed = false;
  for (;;) {
    pollfd source{.fd = output.descriptor(), .events = POLLIN, .revents = 0};
    if (poll(&source, 1, 100) > 0 && !output.read_on(each_line)) break;
    output.forget_all_but(kept);
    if (!asked && stop.load(std::memory_order_relaxed)) {
      asked = Clock::now();
      kill(-output.child(), SIGINT);
    }
    if (asked && !killed && Clock::now() - *asked > patience) {
      killed = true;
      kill(-output.child(), SIGKILL);
    }
  }
  return {wait_for(output.child()), std::move(output.text())};
}

std::string shell_line(const Command& command) {
  std::string line;
  for (const std::string& word : command) {
    if (!line.empty()) line += ' ';
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n'\"\\$`*?[](){}<>|&;#~!") == std::string::npos;
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char character : word)
      line += character == '\'' ? std::string("'\\''") : std::string(1, character);
    line += '\'';
  }
  return line;
}

}  // namespace tessera::project
