#include "safety/companions.hpp"

#include <unistd.h>

#include <csignal>

#include "system/console.hpp"

namespace tessera {

bool Companions::start_guardian(std::string& error) {
  if (!Guardian::is_needed(system_, options_)) return true;
  guardian_ = Guardian::start(system_, options_, error);
  return guardian_ != nullptr;
}

void Companions::watch() {
  const auto say = [](std::string_view text) { console::print(LogLevel::error, Time{}, "tessera", text); };
  if (guardian_ != nullptr)
    guardian_watch_.emplace(guardian_->process(), [say, this] {
      if (!guardian_->is_dismissed())
        say("the guardian has ended: if this process dies, nobody gives the devices the safe command");
    });
  if (options_.parent == 0) return;
  // The parent had already ended: this process has another parent now.
  constexpr pid_t none = -1;
  parent_watch_.emplace(getppid() == options_.parent ? options_.parent : none, [say] {
    say("the process that started the controller has ended; the run stops");
    kill(getpid(), SIGTERM);
  });
}

}  // namespace tessera
