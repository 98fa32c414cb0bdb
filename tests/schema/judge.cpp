#include "judge.hpp"

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

extern char** environ;

namespace tessera::schema_test {

namespace {

using nlohmann::json;

/// judge.js in a process of its own, which ends with the connection to it.
class Judge {
 public:
  Judge() {
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::string node = TESSERA_NODE, script = TESSERA_SOURCE_DIR "/tests/schema/judge.js";
    std::array<char*, 3> words{node.data(), script.data(), nullptr};
    if (posix_spawn(&process_, node.c_str(), &actions, nullptr, words.data(), environ) != 0) process_ = -1;
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    connection_ = ends[0];
  }
  ~Judge() {
    close(connection_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
  }
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  /// The mistake in the message; nullopt: there is none.
  [[nodiscard]] std::optional<std::string> ask(const json& message) {
    const std::lock_guard lock(mutex_);
    const std::string line = message.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t count = send(connection_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return gone;
      sent += static_cast<std::size_t>(count);
    }
    std::string wrong = next_line();
    if (wrong.empty()) return std::nullopt;
    return wrong;
  }

 private:
  static constexpr const char* gone =
      "tests/schema/judge.js does not run: is there `npm ci` in tests/schema?";

  [[nodiscard]] std::string next_line() {
    std::size_t end = 0;
    while ((end = heard_.find('\n')) == std::string::npos) {
      std::array<char, 4096> bytes{};
      const ssize_t count = recv(connection_, bytes.data(), bytes.size(), 0);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return gone;
      heard_.append(bytes.data(), static_cast<std::size_t>(count));
    }
    std::string line = heard_.substr(0, end);
    heard_.erase(0, end + 1);
    return line;
  }

  std::mutex mutex_;
  pid_t process_ = -1;
  int connection_ = -1;
  std::string heard_;
};

void judge(const json& message, const std::string& what) {
  if (std::string_view(TESSERA_NODE).empty()) return;
  static Judge the_judge;
  constexpr std::size_t most_shown = 2000;
  if (const std::optional<std::string> wrong = the_judge.ask(message))
    ADD_FAILURE() << what << " does not fit its schema: " << *wrong << '\n'
                  << message.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, most_shown);
}

}  // namespace

void judge_exchange(const std::string& method, const std::string& target, const std::string& body, int status,
                    const std::string& answer) {
  judge({{"kind", "exchange"},
         {"method", method},
         {"target", target},
         {"body", body},
         {"status", status},
         {"answer", answer}},
        method + " " + target.substr(0, 100));
}

void judge_event(const std::string& name, const json& data) {
  judge({{"kind", "event"}, {"name", name}, {"data", data}}, "the event " + name);
}

void judge_line(const json& data) {
  judge({{"kind", "line"}, {"data", data}}, "a line of the control socket");
}

void judge_command(const json& data) {
  judge({{"kind", "command"}, {"data", data}}, "a command of the control socket");
}

void judge_summary(const json& data) { judge({{"kind", "summary"}, {"data", data}}, "a summary"); }

}  // namespace tessera::schema_test
