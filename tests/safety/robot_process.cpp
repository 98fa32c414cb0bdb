#include "robot_process.hpp"

#include <poll.h>
#include <sched.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "project/process/process.hpp"

namespace tessera::safety_test {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Copies only files that differ, so that no file is compiled twice.
void update(const fs::path& from, const fs::path& to) {
  const auto content = [](const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    const fs::path copy = to / fs::relative(entry.path(), from);
    if (entry.is_directory()) fs::create_directories(copy);
    if (entry.is_regular_file() && (!fs::exists(copy) || content(copy) != content(entry.path())))
      fs::copy_file(entry.path(), copy, fs::copy_options::overwrite_existing);
  }
}

/// One process at a time makes the project.
class Lock {
 public:
  explicit Lock(const fs::path& file) : descriptor_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~Lock() { close(descriptor_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int descriptor_;
};

Project make_project() {
  const fs::path folder = fs::path(TESSERA_BINARY_DIR) / "safety_test_robot";
  fs::create_directories(folder);
  const Lock lock(folder / "lock");
  update(fs::path(TESSERA_SOURCE_DIR) / "tests/safety/robot", folder);
  // A run of no time at all builds it; its devices refuse commands without a log.
  const std::string command = std::string(TESSERA_BINARY_DIR) + "/tessera";
  const tessera::project::Exit made =
      tessera::project::capture({command, "run", folder.string(), "--for", "1ms"});
  const fs::path controller = folder / ".tessera/build/release/controller";
  if (!fs::exists(controller)) throw std::runtime_error(made.text);
  return {folder, controller};
}

fs::path new_log_file() {
  static std::atomic<unsigned> number{0};
  const fs::path file = fs::temp_directory_path() /
                        ("tessera_commands_" + std::to_string(getpid()) + "_" + std::to_string(++number));
  const int descriptor = open(file.c_str(), O_CREAT | O_TRUNC | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor < 0 || ftruncate(descriptor, sizeof(command_log::Log)) != 0)
    throw std::runtime_error("cannot make " + file.string());
  close(descriptor);
  return file;
}

/// Both ends: ours, and the name of the terminal or the descriptor that the child writes to.
struct Ends {
  int ours = -1, theirs = -1;
  std::string terminal;
};

Ends open_terminal() {
  Ends ends;
  ends.ours = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::array<char, 128> name{};
  if (ends.ours < 0 || grantpt(ends.ours) != 0 || unlockpt(ends.ours) != 0 ||
      ptsname_r(ends.ours, name.data(), name.size()) != 0)
    throw std::runtime_error("cannot open a terminal");
  ends.terminal = name.data();
  return ends;
}

Ends open_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot open a pipe");
  return {ends[0], ends[1], {}};
}

/// In a session of its own, whose terminal is that of `ends`.
pid_t start(const std::vector<std::string>& command, const std::vector<std::string>& environment,
            const Ends& ends) {
  std::vector<char*> words, variables;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  for (char** variable = environ; *variable != nullptr; ++variable) variables.push_back(*variable);
  for (const std::string& one : environment) variables.push_back(const_cast<char*>(one.c_str()));
  words.push_back(nullptr);
  variables.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (ends.terminal.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends.theirs, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends.theirs, STDERR_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, ends.terminal.c_str(), O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&actions, STDIN_FILENO, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, STDIN_FILENO, STDERR_FILENO);
  }
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(
      &attributes, static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSID));
  pid_t child = 0;
  const int problem = posix_spawn(&child, words[0], &actions, &attributes, words.data(), variables.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (ends.theirs >= 0) close(ends.theirs);
  if (problem != 0) throw std::runtime_error("cannot start " + command[0]);
  return child;
}

}  // namespace

/// The commands of a device, in the order in which they were given.
struct RobotProcess::Last {
  std::int64_t safe_since_ns = 0;
  bool safe = false, drove = false;
};

std::array<RobotProcess::Last, command_log::devices> RobotProcess::last_commands() const {
  std::array<Last, command_log::devices> last;
  const std::uint64_t count = std::min<std::uint64_t>(log_->count, log_->commands.size());
  for (std::uint64_t index = 0; index < count; ++index) {
    const command_log::Command& command = log_->commands[index];
    const std::int64_t at_ns = command.at_ns.load(std::memory_order_acquire);
    if (at_ns == 0) continue;
    Last& device = last[command.device];
    const bool safe = command.value == 0;
    if (safe && !device.safe) device.safe_since_ns = at_ns;
    device.safe = safe;
    device.drove = device.drove || !safe;
  }
  if (ignored_) last[*ignored_] = {.safe = true};
  return last;
}

const Project& project() {
  static const Project made = make_project();
  return made;
}

RobotProcess::RobotProcess(const std::vector<std::string>& command, Output output,
                           const std::vector<std::string>& environment)
    : log_file_(new_log_file()), log_(command_log::map(log_file_.c_str())) {
  if (log_ == nullptr) throw std::runtime_error("cannot map " + log_file_.string());
  const Ends ends = output == Output::terminal ? open_terminal() : open_pipe();
  descriptor_ = ends.ours;
  std::vector<std::string> variables = environment;
  variables.push_back("COMMAND_LOG=" + log_file_.string());
  child_ = start(command, variables, ends);
}

RobotProcess::~RobotProcess() {
  for (const pid_t process : commanders())
    if (is_ours(process)) kill_process(process, SIGKILL);
  kill_process(child_, SIGKILL);
  if (!status_) waitpid(child_, nullptr, 0);
  if (descriptor_ >= 0) close(descriptor_);
  munmap(log_, sizeof(command_log::Log));
  fs::remove(log_file_);
}

/// Its environment names our log: the number of a process that has ended may be another's by now.
bool RobotProcess::is_ours(pid_t process) const {
  std::ifstream stream("/proc/" + std::to_string(process) + "/environ", std::ios::binary);
  const std::string variables(std::istreambuf_iterator<char>(stream), {});
  return variables.find(log_file_.string()) != std::string::npos;
}

void RobotProcess::kill_process(pid_t process, int signal) {
  if (process > 1) kill(process, signal);
}

bool RobotProcess::await_driving(unsigned commands) {
  const Clock::time_point end = Clock::now() + std::chrono::seconds(60);
  std::array<unsigned, command_log::devices> drove{};
  std::uint64_t seen = std::min<std::uint64_t>(log_->count, log_->commands.size());
  const auto enough = [&] {
    return std::all_of(drove.begin(), drove.end(), [&](unsigned count) { return count >= commands; });
  };
  while (!enough() && Clock::now() < end && !await_end(milliseconds(0))) {
    for (const std::uint64_t count = std::min<std::uint64_t>(log_->count, log_->commands.size());
         seen < count; ++seen) {
      const command_log::Command& command = log_->commands[seen];
      if (command.at_ns.load(std::memory_order_acquire) == 0) break;
      if (command.value != 0) ++drove[command.device];
    }
    read_some(2);
  }
  return enough();
}

void RobotProcess::do_harm(Harm harm, Place place) {
  log_->place = place;
  log_->harm = harm;
}

void RobotProcess::send_guardian(int signal) const {
  const std::string line = "PPid:\t" + std::to_string(child_) + "\n";
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream stream(entry.path() / "status");
    const std::string status(std::istreambuf_iterator<char>(stream), {});
    if (status.starts_with("Name:\ttessera-guard\n") && status.find(line) != std::string::npos)
      return kill_process(std::stoi(entry.path().filename()), signal);
  }
  throw std::runtime_error("the controller has no guardian");
}

void RobotProcess::delay_supervisor(bool delayed) const {
  const sched_param none{};
  sched_setscheduler(child_, delayed ? SCHED_IDLE : SCHED_OTHER, &none);
  cpu_set_t all, one;
  sched_getaffinity(0, sizeof all, &all);
  CPU_ZERO(&one);
  for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
  std::error_code has_ended;
  for (const auto& thread : fs::directory_iterator("/proc/" + std::to_string(child_) + "/task", has_ended))
    sched_setaffinity(std::stoi(thread.path().filename()), sizeof one, delayed ? &one : &all);
}

void RobotProcess::type(char key) const {
  if (write(descriptor_, &key, 1) != 1) throw std::runtime_error("cannot type");
}

void RobotProcess::hang_up() {
  close(descriptor_);
  descriptor_ = -1;
  ended_of_text_ = true;
}

/// Sleeps if there is no output to read from.
void RobotProcess::read_some(int timeout_ms) {
  pollfd source{.fd = reading_ && !ended_of_text_ ? descriptor_ : -1, .events = POLLIN, .revents = 0};
  if (poll(&source, 1, timeout_ms) <= 0) return;
  std::array<char, 4096> bytes{};
  const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
  if (count > 0)
    text_.append(bytes.data(), static_cast<std::size_t>(count));
  else
    ended_of_text_ = true;  // for a terminal: EIO, when no process has it open
}

std::optional<int> RobotProcess::await_end(milliseconds limit) {
  const Clock::time_point end = Clock::now() + limit;
  for (;;) {
    int status = 0;
    if (!status_ && waitpid(child_, &status, WNOHANG) == child_) status_ = status;
    if (status_ || Clock::now() >= end) return status_;
    read_some(2);
  }
}

bool RobotProcess::await_nobody_left(milliseconds limit) {
  const Clock::time_point end = Clock::now() + limit;
  const auto left = [&] {
    const std::vector<pid_t> all = commanders();
    return (descriptor_ >= 0 && reading_ && !ended_of_text_) ||
           std::any_of(all.begin(), all.end(), [this](pid_t process) { return is_ours(process); });
  };
  while (left() && Clock::now() < end) read_some(5);
  return !left();
}

bool RobotProcess::await_safe(milliseconds still, milliseconds limit) {
  const Clock::time_point end = Clock::now() + limit;
  while (Clock::now() < end) {
    const auto last = last_commands();
    std::int64_t since_ns = 0;
    for (const Last& device : last) since_ns = std::max(since_ns, device.safe_since_ns);
    if (is_safe() && command_log::now_ns() - since_ns > std::chrono::nanoseconds(still).count()) return true;
    read_some(5);
  }
  return false;
}

bool RobotProcess::await_text(std::string_view wanted, milliseconds limit) {
  const Clock::time_point end = Clock::now() + limit;
  while (text_.find(wanted) == std::string::npos && Clock::now() < end) read_some(5);
  return text_.find(wanted) != std::string::npos;
}

bool RobotProcess::is_safe() const {
  const auto last = last_commands();
  return std::all_of(last.begin(), last.end(), [](const Last& device) { return device.safe; });
}

std::int64_t RobotProcess::safe_since_ns() const {
  std::int64_t since_ns = 0;
  for (const Last& device : last_commands())
    if (device.drove) since_ns = std::max(since_ns, device.safe_since_ns);
  return since_ns;
}

bool RobotProcess::drove_after_guardian() const {
  std::array<bool, command_log::devices> guarded{};
  const std::uint64_t count = std::min<std::uint64_t>(log_->count, log_->commands.size());
  for (std::uint64_t index = 0; index < count; ++index) {
    const command_log::Command& command = log_->commands[index];
    if (command.at_ns.load(std::memory_order_acquire) == 0) continue;
    if (command.process != child_) guarded[command.device] = true;
    if (guarded[command.device] && command.value != 0) return true;
  }
  return false;
}

std::vector<pid_t> RobotProcess::commanders() const {
  std::set<pid_t> all;
  const std::uint64_t count = std::min<std::uint64_t>(log_->count, log_->commands.size());
  for (std::uint64_t index = 0; index < count; ++index)
    if (log_->commands[index].at_ns.load(std::memory_order_acquire) != 0)
      all.insert(log_->commands[index].process);
  return {all.begin(), all.end()};
}

}  // namespace tessera::safety_test
