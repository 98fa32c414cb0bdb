#include "explore/watch.hpp"

#include <algorithm>
#include <cstdio>

namespace tessera::explore {
namespace {

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

Watch::Watch(const Limits& limits) : limits_(limits), start_(Clock::now()), last_report_(start_) {}

bool Watch::go_on(std::uint64_t markings, std::uint64_t bytes) {
  if (!why_.empty()) return false;
  const Clock::time_point now = Clock::now();
  effort_.markings = markings;
  if (limits_.stop != nullptr && limits_.stop->load(std::memory_order_relaxed)) {
    why_ = "it was interrupted";
  } else if (now - start_ > limits_.time) {
    why_ = "the time limit of " + shown(limits_.time.count()) + " s is reached";
  } else if (markings > limits_.markings) {
    why_ = "the limit of " + std::to_string(limits_.markings) + " markings is reached";
  } else if (bytes > limits_.bytes) {
    why_ =
        "the memory limit of " + shown(static_cast<double>(limits_.bytes) / (1U << 20U)) + " MB is reached";
  } else {
    effort_.bytes = std::max(effort_.bytes, bytes);
    report(now, markings, bytes);
  }
  return why_.empty();
}

void Watch::report(Clock::time_point now, std::uint64_t markings, std::uint64_t bytes) {
  constexpr auto interval = std::chrono::milliseconds(200);
  if (!limits_.progress || now - last_report_ < interval) return;
  const std::chrono::duration<double> since = now - last_report_;
  // The count starts again at 0 when an exploration is repeated with wider fields.
  const std::uint64_t more = markings - std::min(markings, last_markings_);
  limits_.progress({markings, static_cast<double>(more) / since.count(), bytes, now - start_});
  last_report_ = now;
  last_markings_ = markings;
}

Effort Watch::effort() const {
  Effort effort = effort_;
  effort.elapsed = Clock::now() - start_;
  return effort;
}

}  // namespace tessera::explore
