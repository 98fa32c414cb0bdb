#include "subsystem/goals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "tessera/repetition.hpp"

namespace tessera {
Goals::Goals(const SubsystemParts& parts, const Reports& reports)
    : reports_(reports), goal_of_port_(parts.ports.size(), UINT32_MAX) {
  const auto& facts = parts.instance->net->facts;
  for (const BoundGoal& bound : parts.bindings.goals) {
    for (std::uint32_t fact = 0; fact < facts.size(); ++fact)
      if (facts[fact].kind == Fact::Kind::memory &&
          facts[fact].name.substr(facts[fact].name.find('.') + 1) == bound.cell)
        goals_.push_back({.bound = &bound, .fact = fact});
    if (goals_.empty() || goals_.back().bound != &bound) continue;
    for (std::uint32_t port = 0; port < parts.ports.size(); ++port)
      if (parts.ports[port].side == Side::receive &&
          parts.bindings.inputs[parts.ports[port].buffer].value == bound.progress)
        goal_of_port_[port] = static_cast<std::uint32_t>(goals_.size() - 1);
  }
}

void Goals::begin(std::uint16_t behaviour) {
  for (Goal& goal : goals_) {
    const bool leaves = std::exchange(goal.on_leave, false);
    const auto& orders = goal.bound->orders;
    const auto order = std::ranges::find(orders, behaviour, &BoundGoal::Order::behaviour);
    if (order == orders.end()) {
      goal.withdrawn = goal.withdrawn || (goal.call != 0 && !goal.sent);
      goal.cancel = goal.cancel || (leaves && !goal.withdrawn && !is_end(goal.state));
      continue;
    }
    goal.call = std::max<std::uint32_t>(goal.call + 1, 1);
    goal.cancel = goal.sent = goal.withdrawn = false;
    goal.on_leave = order->cancel_on_leave;
  }
}

void Goals::write() const {
  for (const Goal& goal : goals_)
    goal.bound->write(goal.bound->goal, goal.withdrawn ? 0 : goal.call, goal.cancel);
}

void Goals::note_sent(const void* output) {
  for (Goal& goal : goals_) goal.sent = goal.sent || goal.bound->goal == output;
}

void Goals::learn(std::uint16_t fact, std::uint16_t value) {
  for (Goal& goal : goals_)
    if (goal.fact == fact) goal.state = static_cast<GoalState>(value);
}

std::uint16_t Goals::told(std::uint32_t port, bool taken) {
  if (goal_of_port_[port] >= goals_.size()) return 0;
  Goal& goal = goals_[goal_of_port_[port]];
  if (goal.withdrawn && goal.state == GoalState::ordered) return static_cast<std::uint16_t>(GoalState::gone);
  const auto now = static_cast<std::uint16_t>(goal.state);
  if (!taken) return now;
  const BoundGoal::Progress progress = goal.bound->read(goal.bound->progress);
  if (progress.call < goal.call) return now;  // of an earlier goal, or of none yet
  if (progress.call > goal.call || progress.state >= goal_state_count ||
      !can_follow(goal.state, static_cast<GoalState>(progress.state))) {
    drop(goal, progress);
    return now;
  }
  return progress.state;
}

void Goals::drop(Goal& goal, const BoundGoal::Progress& progress) {
  ++dropped_;
  if (!is_told(++goal.dropped)) return;
  std::array<char, 256> text;
  const std::string_view state =
      progress.state < goal_state_count ? goal_state_names.at(progress.state) : std::string_view("unknown");
  const auto end =
      progress.call != goal.call
          ? fmt::format_to_n(text.data(), text.size(),
                             "memory.{}: dropped state {} ({}) of goal {}, which was not ordered",
                             goal.bound->cell, progress.state, state, progress.call)
          : fmt::format_to_n(text.data(), text.size(),
                             "memory.{}: dropped state {} ({}) of goal {}, which does not come after {}",
                             goal.bound->cell, progress.state, state, progress.call,
                             goal_state_names.at(static_cast<std::size_t>(goal.state)));
  std::size_t size = std::min(end.size, text.size());
  if (goal.dropped > 1)
    size = std::min(
        size + fmt::format_to_n(text.data() + size, text.size() - size, " ({} times)", goal.dropped).size,
        text.size());
  reports_.log(LogLevel::warning, {text.data(), size});
}

}  // namespace tessera
