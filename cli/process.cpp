#include "cli/process.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

extern char** environ;

namespace tessera::cli {

namespace {

volatile std::sig_atomic_t child_pid = 0;

extern "C" void pass_on(int signal) {
  if (child_pid > 0) kill(static_cast<pid_t>(child_pid), signal);
}

/// While it lives, SIGINT and SIGTERM go to the child.
class SignalsToChild {
 public:
  explicit SignalsToChild(pid_t child) {
    child_pid = static_cast<std::sig_atomic_t>(child);
    struct sigaction action {};
    action.sa_handler = pass_on;
    sigaction(SIGINT, &action, &interrupt_);
    sigaction(SIGTERM, &action, &terminate_);
  }
  ~SignalsToChild() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
    child_pid = 0;
  }
  SignalsToChild(const SignalsToChild&) = delete;
  SignalsToChild& operator=(const SignalsToChild&) = delete;

 private:
  struct sigaction interrupt_ {
  }, terminate_{};
};

pid_t start(const Command& command, posix_spawn_file_actions_t* actions) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int problem = posix_spawnp(&child, arguments[0], actions, nullptr, arguments.data(), environ);
  if (problem != 0)
    throw std::runtime_error(fmt::format("cannot start {}: {}", command[0], std::strerror(problem)));
  return child;
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Exit run(const Command& command) {
  const pid_t child = start(command, nullptr);
  const SignalsToChild passing(child);
  return {wait_for(child), {}};
}

Exit capture(const Command& command, const std::function<void(std::string_view)>& each_line) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  try {
    child = start(command, &actions);
  } catch (...) {
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  const SignalsToChild passing(child);

  Exit result;
  std::array<char, 4096> buffer{};
  std::size_t line_start = 0;
  while (true) {
    const ssize_t count = read(ends[0], buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    result.text.append(buffer.data(), static_cast<std::size_t>(count));
    for (std::size_t end; each_line && (end = result.text.find('\n', line_start)) != std::string::npos;
         line_start = end + 1)
      each_line(std::string_view(result.text).substr(line_start, end - line_start));
  }
  close(ends[0]);
  result.code = wait_for(child);
  return result;
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

}  // namespace tessera::cli
