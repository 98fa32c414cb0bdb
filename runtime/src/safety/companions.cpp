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

void Companions::watch_parent() {
  if (options_.parent == 0) return;
  // The parent had already ended: this process has another parent now.
  constexpr pid_t none = -1;
  parent_watch_.emplace(getppid() == options_.parent ? options_.parent : none, [] {
    console::print(LogLevel::error, Time{}, "tessera",
                   "the process that started the controller has ended; the run stops");
    kill(getpid(), SIGTERM);
  });
}

std::unique_ptr<ProcessWatch> Companions::watch_guardian(RunControl& control) const {
  if (guardian_ == nullptr) return nullptr;
  const auto stop_if_in_trouble = [this, &control] {
    const Guardian::Trouble trouble = guardian_->trouble();
    if (trouble == Guardian::Trouble::none) return;
    control.request_stop(Guardian::describe(trouble), /*fault=*/true);
    control.tell_supervisor();
  };
  const auto has_ended = [this, stop_if_in_trouble] {
    guardian_->note_end();
    stop_if_in_trouble();
  };
  const auto goes_on = [this, stop_if_in_trouble] {
    guardian_->look_at_it();
    stop_if_in_trouble();
  };
  return std::make_unique<ProcessWatch>(guardian_->process(), has_ended,
                                        ProcessWatch::Look{Guardian::beat_period, goes_on});
}

}  // namespace tessera
