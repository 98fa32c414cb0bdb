#include "project/process/process_set.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>

#include "project/process/spawn.hpp"
#include "tessera/signals.hpp"

namespace tessera::project {
namespace {

constexpr std::chrono::seconds first_reminder{2}, second_signal{10}, end_of_patience{12};
constexpr std::chrono::milliseconds pause_before_next_question{100};
constexpr int usual_wait_ms = 200;
constexpr std::size_t longest_line = 8192;

void close_on_exec_pipe(std::array<int, 2>& ends) {
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
}

/// The program, with its output in the pipe and without input.
pid_t spawn_into(const Command& command, int writing_end) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, writing_end, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, writing_end, STDERR_FILENO);
  try {
    const pid_t child = spawn(command, &actions, /*own_group=*/true);
    posix_spawn_file_actions_destroy(&actions);
    return child;
  } catch (...) {
    posix_spawn_file_actions_destroy(&actions);
    throw;
  }
}

int exit_code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

}  // namespace

ProcessSet::ProcessSet(std::size_t count, CommandOf command, FailurePolicy policy,
                       ProcessSetListener& listener)
    : command_(std::move(command)), policy_(policy), listener_(listener), children_(count), ends_(count) {
  for (std::size_t process = 0; process < count; ++process) ends_[process].process = process;
  take_over_signals();
}

/// They are blocked, and read from a descriptor: nothing happens in a handler.
void ProcessSet::take_over_signals() {
  sigset_t mine;
  sigemptyset(&mine);
  sigaddset(&mine, SIGCHLD);
  for_handled_signals([&](int signal, SignalUse use) {
    struct sigaction now {};
    const bool always = signal == SIGINT || signal == SIGTERM;
    const bool usual = sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_DFL;
    if (usual || always) sigaddset(&mine, signal);
    static_cast<void>(use);
  });
  pthread_sigmask(SIG_BLOCK, &mine, &before_);
  signals_ = signalfd(-1, &mine, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signals_ < 0) throw std::runtime_error(std::strerror(errno));
}

ProcessSet::~ProcessSet() {
  for (const Child& child : children_) {
    if (child.pid > 0) kill(child.pid, SIGKILL);  // only after an exception; a controller has its guardian
    if (child.output >= 0) close(child.output);
  }
  close(signals_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

int ProcessSet::run() {
  try {
    for (std::size_t process = 0; process < children_.size() && !stopping_; ++process) {
      start(process);
      take_signals();
    }
    while (any_left()) wait_for_something();
  } catch (...) {
    stop_in_spite_of_exceptions();
    throw;
  }
  return stopped_by_;
}

/// To leave would kill processes that may move something.
void ProcessSet::stop_in_spite_of_exceptions() {
  const auto try_to = [](auto what) {
    try {
      what();
    } catch (const std::exception&) {  // only the first one is reported
    }
  };
  try_to([&] { stop_all(0, SIGTERM); });
  try_to([&] { stop_all(0, SIGTERM); });  // if only the report of it had failed
  while (any_left()) try_to([&] { wait_for_something(); });
}

void ProcessSet::wait_for_something() {
  std::vector<pollfd> sources{{.fd = signals_, .events = POLLIN, .revents = 0}};
  for (const Child& child : children_)
    sources.push_back({.fd = child.output, .events = POLLIN, .revents = 0});  // -1 is passed over
  if (poll(sources.data(), sources.size(), longest_wait_ms()) > 0)
    for (std::size_t process = 0; process < children_.size(); ++process)
      if (sources[process + 1].revents != 0) read_output(children_[process], process);
  take_signals();
  collect();
  start_what_is_due();
  if (stopping_) press_on();
  if (suspending_) suspend_together();
}

void ProcessSet::start(std::size_t process) {
  Child& child = children_[process];
  std::array<int, 2> ends{};
  close_on_exec_pipe(ends);
  const unsigned number = child.start + 1;
  try {
    child.pid = spawn_into(command_(process, number), ends[1]);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  if (child.output >= 0) close(child.output);
  child.output = ends[0];
  child.start = number;
  child.began = Clock::now();
  child.again.reset();
  child.asked = child.suspended = false;
  listener_.started(process, number, child.pid);
}

void ProcessSet::start_what_is_due() {
  for (std::size_t process = 0; process < children_.size(); ++process)
    if (children_[process].again && Clock::now() >= *children_[process].again) start_again(process);
}

void ProcessSet::start_again(std::size_t process) {
  using Again = ProcessSetListener::Again;
  Child& child = children_[process];
  const Again answer = listener_.may_start_again(process);
  if (answer == Again::now) return start(process);
  child.again = Clock::now() + pause_before_next_question;
  if (answer == Again::later) return;
  child.again.reset();
  if (policy_.stops_all && !stopping_) stop_all(0, SIGTERM);
}

// ------------------------------------------------------------------------------------------------- output

void ProcessSet::read_output(Child& child, std::size_t process) {
  std::array<char, 4096> buffer{};
  const ssize_t count = ::read(child.output, buffer.data(), buffer.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (count <= 0) {
    flush_output(child, process);
    close(std::exchange(child.output, -1));
    return;
  }
  for (const char one : std::string_view(buffer.data(), static_cast<std::size_t>(count))) {
    if (one != '\n') child.line += one;
    if (one == '\n' || child.line.size() >= longest_line)
      listener_.said(process, std::exchange(child.line, {}));
  }
}

void ProcessSet::flush_output(Child& child, std::size_t process) {
  if (!child.line.empty()) listener_.said(process, std::exchange(child.line, {}));
}

// ------------------------------------------------------------------------------------------------ signals

void ProcessSet::take_signals() {
  signalfd_siginfo info{};
  while (read(signals_, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) {
    const int signal = static_cast<int>(info.ssi_signo);
    if (signal != SIGCHLD) obey(signal);
  }
}

void ProcessSet::obey(int signal) {
  for_handled_signals([&](int number, SignalUse use) {
    if (number != signal) return;
    if (use == SignalUse::stop) stop_all(signal, signal);
    if (use != SignalUse::suspend) return;
    suspending_ = true;
    send_all(SIGTSTP);
  });
}

/// A second signal is impatience: a controller that hangs ends then.
void ProcessSet::stop_all(int signal, int sent) {
  if (!std::exchange(stopping_, true)) {
    stopped_by_ = signal;
    asked_at_ = Clock::now();
    listener_.stopping(signal);
  }
  for (Child& child : children_) {
    child.again.reset();
    child.asked = child.asked || child.pid > 0;
  }
  send_all(sent);
  if (!suspending_) send_all(SIGCONT);
}

void ProcessSet::send_all(int signal) const {
  for (const Child& child : children_)
    if (child.pid > 0) kill(child.pid, signal);
}

/// Processes that were asked to stop and do not.
void ProcessSet::press_on() {
  const Clock::duration waited = Clock::now() - asked_at_;
  std::vector<std::size_t> left;
  for (std::size_t process = 0; process < children_.size(); ++process)
    if (children_[process].pid > 0) left.push_back(process);
  if (left.empty()) return;
  if (pressed_ == 0 && waited > first_reminder) {
    pressed_ = 1;
    listener_.waits_for(left);
  } else if (pressed_ == 1 && waited > second_signal) {
    pressed_ = 2;
    send_all(SIGINT);
  } else if (pressed_ == 2 && waited > end_of_patience) {
    pressed_ = 3;
    send_all(SIGKILL);
  }
}

/// This process stops when all others have: then every device has its safe command.
void ProcessSet::suspend_together() {
  if (!std::ranges::all_of(children_, [](const Child& child) { return child.pid == 0 || child.suspended; }))
    return;
  suspending_ = false;
  raise(SIGSTOP);
  send_all(SIGCONT);
}

// --------------------------------------------------------------------------------------------------- ends

void ProcessSet::collect() {
  for (std::size_t process = 0; process < children_.size(); ++process) {
    Child& child = children_[process];
    if (child.pid == 0) continue;
    int status = 0;
    if (waitpid(child.pid, &status, WNOHANG | WUNTRACED | WCONTINUED) != child.pid) continue;
    if (WIFSTOPPED(status) || WIFCONTINUED(status))
      child.suspended = WIFSTOPPED(status);
    else
      note_end(process, status);
  }
}

void ProcessSet::note_end(std::size_t process, int status) {
  Child& child = children_[process];
  while (child.output >= 0) {  // what it has left in the pipe
    pollfd source{.fd = child.output, .events = POLLIN, .revents = 0};
    if (poll(&source, 1, 0) <= 0) break;
    read_output(child, process);
  }
  flush_output(child, process);
  ProcessEnd& end = ends_[process];
  end = {.process = process,
         .start = child.start,
         .exit = {exit_code_of(status), {}},
         .ran = Clock::now() - child.began,
         .asked = child.asked};
  child.pid = 0;
  const auto pause = pause_before(child, end);
  if (pause) {
    child.in_a_row = end.ran >= policy_.settled ? 1 : child.in_a_row + 1;
    child.again = Clock::now() + *pause;
  }
  listener_.ended(end, pause);
  const bool failed = !end.asked && end.exit.code != 0;
  if (failed && !pause && policy_.stops_all && !stopping_) stop_all(0, SIGTERM);
}

std::optional<std::chrono::milliseconds> ProcessSet::pause_before(const Child& child,
                                                                  const ProcessEnd& end) const {
  if (!policy_.restarts || stopping_ || end.asked || end.exit.code == 0) return std::nullopt;
  const unsigned before = end.ran >= policy_.settled ? 0 : child.in_a_row;
  if (before >= policy_.most_restarts) return std::nullopt;
  const auto pause = policy_.first_pause * (1U << std::min(before, 16U));
  return std::min<std::chrono::milliseconds>(pause, policy_.longest_pause);
}

bool ProcessSet::any_left() const {
  return std::ranges::any_of(children_, [](const Child& child) { return child.pid > 0 || child.again; });
}

int ProcessSet::longest_wait_ms() const {
  int longest = usual_wait_ms;
  for (const Child& child : children_)
    if (child.again) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(*child.again - Clock::now()).count();
      longest = std::clamp(static_cast<int>(std::min<std::int64_t>(left, usual_wait_ms)), 0, longest);
    }
  return longest;
}

}  // namespace tessera::project
