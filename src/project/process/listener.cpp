#include "project/process/listener.hpp"

#include <fmt/core.h>

namespace tessera::project {

void Listener::say(const diagnostics::Diagnostics& diagnostics) { say(diagnostics::render(diagnostics)); }

void Listener::complain(std::string_view text) { say(fmt::format("tessera: error: {}\n", text)); }

void Listener::warn(std::string_view text) { say(fmt::format("tessera: warning: {}\n", text)); }

Step::Step(Listener& listener, std::string what)
    : listener_(listener), what_(std::move(what)), start_(std::chrono::steady_clock::now()) {}

Step::~Step() {
  if (shown_) listener_.progress({});
}

void Step::progress(std::string_view detail) {
  if (seconds() < 1) return;
  shown_ = true;
  listener_.progress(fmt::format("{} {} ({:.0f} s)", what_, detail, seconds()));
}

double Step::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace tessera::project
