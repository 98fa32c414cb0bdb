#include "drivers/command_limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera {
namespace {

/// A change is counted from the last number: none can be reached from NaN or infinity.
void note(double& last, double sent) {
  if (std::isfinite(sent)) last = sent;
}

}  // namespace

CommandLimits::CommandLimits(const Bindings& bindings, Duration period)
    : bindings_(&bindings),
      most_(period > Duration::zero() ? period : Duration(std::chrono::milliseconds(100))) {
  for (const Bindings::RealLimit& limit : bindings.limits)
    limited_.push_back({&limit, std::vector<double>(limit.elements), false});
  note_safe(Time{});
}

void* CommandLimits::place(const Limited& one) const {
  return static_cast<std::byte*>(bindings_->real_outputs[one.limit->output].value) + one.limit->offset;
}

/// excess: filled if it is the first excess of this command.
void CommandLimits::limit(Limited& one, double allowed_s, Excess& excess) {
  const Bindings::Limits& limits = one.limit->limits;
  for (std::size_t element = 0; element < one.last.size(); ++element) {
    const double asked = one.limit->get(place(one), element);
    if (std::isnan(asked)) continue;  // which the specification allows here, and which is no command
    const double change = std::isinf(limits.per_second) ? limits.per_second : limits.per_second * allowed_s;
    const double last = one.last[element];
    // The safe command is within the range. So the range and the largest change
    // always have values in common.
    const double sent =
        std::clamp(std::clamp(asked, last - change, last + change), limits.minimum, limits.maximum);
    if (sent == asked) continue;
    // For an integer, the nearest whole number within the limits.
    one.limit->set(place(one), element,
                   one.limit->whole ? (sent > asked ? std::ceil(sent) : std::floor(sent)) : sent);
    if (excess.name.empty()) excess = {one.limit->name, asked, sent, limits.fault, true};
  }
}

const CommandLimits::Excess* CommandLimits::apply(Time now) {
  if (limited_.empty()) return nullptr;
  const double allowed_s = seconds(std::clamp(now - last_, Duration::zero(), most_));
  bool found = false;
  for (Limited& one : limited_) {
    Excess excess;
    limit(one, allowed_s, excess);
    const bool began = !std::exchange(one.exceeded, !excess.name.empty());
    if (excess.name.empty() || (found && (excess_.fault || !excess.fault))) continue;
    if (!began && !excess.fault) continue;
    excess_ = excess;
    found = true;
  }
  return found ? &excess_ : nullptr;
}

void CommandLimits::note_safe(Time now) {
  for (Limited& one : limited_) {
    const auto* const safe =
        static_cast<const std::byte*>(bindings_->real_outputs[one.limit->output].safe.get()) +
        one.limit->offset;
    for (std::size_t element = 0; element < one.last.size(); ++element)
      note(one.last[element], one.limit->get(safe, element));
  }
  last_ = now;
}

void CommandLimits::note_sent(Time now) {
  for (Limited& one : limited_)
    for (std::size_t element = 0; element < one.last.size(); ++element)
      note(one.last[element], one.limit->get(place(one), element));
  last_ = now;
}

}  // namespace tessera
