#include "ros2/lifecycle/lifecycle.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace tessera::ros2 {
namespace {

using NodeState = LifecycleState;
using LifeStep = LifecycleTransition;

struct NamedState {
  NodeState state;
  const char* label;
};
constexpr std::array<NamedState, 11> named_states{{{NodeState::unknown, "unknown"},
                                                   {NodeState::unconfigured, "unconfigured"},
                                                   {NodeState::inactive, "inactive"},
                                                   {NodeState::active, "active"},
                                                   {NodeState::finalized, "finalized"},
                                                   {NodeState::configuring, "configuring"},
                                                   {NodeState::cleaning_up, "cleaningup"},
                                                   {NodeState::shutting_down, "shuttingdown"},
                                                   {NodeState::activating, "activating"},
                                                   {NodeState::deactivating, "deactivating"},
                                                   {NodeState::error_processing, "errorprocessing"}}};

constexpr const char *on_success = "transition_success", *on_failure = "transition_failure",
                     *on_error = "transition_error", *by_shutdown = "shutdown";

constexpr std::array<LifeStep, 25> life_steps{{
    {1, "configure", NodeState::unconfigured, NodeState::configuring},
    {10, on_success, NodeState::configuring, NodeState::inactive},
    {11, on_failure, NodeState::configuring, NodeState::unconfigured},
    {12, on_error, NodeState::configuring, NodeState::error_processing},
    {2, "cleanup", NodeState::inactive, NodeState::cleaning_up},
    {20, on_success, NodeState::cleaning_up, NodeState::unconfigured},
    {21, on_failure, NodeState::cleaning_up, NodeState::inactive},
    {22, on_error, NodeState::cleaning_up, NodeState::error_processing},
    {3, "activate", NodeState::inactive, NodeState::activating},
    {30, on_success, NodeState::activating, NodeState::active},
    {31, on_failure, NodeState::activating, NodeState::inactive},
    {32, on_error, NodeState::activating, NodeState::error_processing},
    {4, "deactivate", NodeState::active, NodeState::deactivating},
    {40, on_success, NodeState::deactivating, NodeState::inactive},
    {41, on_failure, NodeState::deactivating, NodeState::active},
    {42, on_error, NodeState::deactivating, NodeState::error_processing},
    {5, by_shutdown, NodeState::unconfigured, NodeState::shutting_down},
    {6, by_shutdown, NodeState::inactive, NodeState::shutting_down},
    {7, by_shutdown, NodeState::active, NodeState::shutting_down},
    {50, on_success, NodeState::shutting_down, NodeState::finalized},
    {51, on_failure, NodeState::shutting_down, NodeState::finalized},
    {52, on_error, NodeState::shutting_down, NodeState::error_processing},
    {60, on_success, NodeState::error_processing, NodeState::unconfigured},
    {61, on_failure, NodeState::error_processing, NodeState::finalized},
    {62, on_error, NodeState::error_processing, NodeState::finalized},
}};

constexpr std::uint8_t error_processed = 60, callback_error = 99;

struct OrderNumbers {
  LifecycleOrder order;
  const char* label;
  std::uint8_t done;  ///< the number of the transition on on_success; on_failure and on_error follow
};
constexpr std::array<OrderNumbers, 5> life_orders{{{LifecycleOrder::configure, "configure", 10},
                                                   {LifecycleOrder::cleanup, "cleanup", 20},
                                                   {LifecycleOrder::activate, "activate", 30},
                                                   {LifecycleOrder::deactivate, "deactivate", 40},
                                                   {LifecycleOrder::shutdown, "shutdown", 50}}};

}  // namespace

const char* label_of(LifecycleState state) {
  const auto* const found = std::ranges::find(named_states, state, &NamedState::state);
  return found == named_states.end() ? "unknown" : found->label;
}

std::span<const LifecycleState> lifecycle_states() {
  static const std::array<NodeState, named_states.size()> states = [] {
    std::array<NodeState, named_states.size()> all{};
    std::ranges::transform(named_states, all.begin(), &NamedState::state);
    return all;
  }();
  return states;
}

std::span<const LifecycleTransition> lifecycle_transitions() { return life_steps; }

std::vector<LifecycleTransition> Lifecycle::available() const {
  std::vector<LifeStep> all;
  std::ranges::copy_if(life_steps, std::back_inserter(all),
                       [&](const LifeStep& step) { return step.from == state_; });
  return all;
}

std::optional<LifecycleOrder> Lifecycle::request(std::uint8_t id, std::string_view label) {
  for (const LifeStep& step : life_steps) {
    if (step.from != state_ || (label.empty() ? step.id != id : step.label != label)) continue;
    const auto* const order =
        std::ranges::find(life_orders, std::string_view(step.label),
                          [](const OrderNumbers& one) { return std::string_view(one.label); });
    if (order != life_orders.end() && begin(order->order)) return order->order;
  }
  return std::nullopt;
}

bool Lifecycle::begin(LifecycleOrder order) {
  const auto* const numbers = std::ranges::find(life_orders, order, &OrderNumbers::order);
  const auto* const step = std::ranges::find_if(life_steps, [&](const LifeStep& one) {
    return one.from == state_ && std::string_view(one.label) == numbers->label;
  });
  if (step == life_steps.end()) return false;
  go(*step);
  under_way_ = numbers->done;
  return true;
}

void Lifecycle::finish(LifecycleOutcome outcome) {
  const std::uint8_t done = std::exchange(under_way_, std::uint8_t{0});
  if (done == 0) return;
  go(static_cast<std::uint8_t>(done + static_cast<std::uint8_t>(outcome)));
  if (state_ == NodeState::error_processing) go(error_processed);
}

void Lifecycle::fail() {
  if (state_ != NodeState::inactive && state_ != NodeState::active) return finish(LifecycleOutcome::error);
  go({callback_error, on_error, state_, NodeState::error_processing});
  go(error_processed);
}

std::vector<LifecycleTransition> Lifecycle::take_steps() { return std::exchange(steps_, {}); }

void Lifecycle::go(const LifecycleTransition& step) {
  state_ = step.to;
  steps_.push_back(step);
}

bool Lifecycle::go(std::uint8_t id) {
  const auto* const step = std::ranges::find_if(
      life_steps, [&](const LifeStep& one) { return one.from == state_ && one.id == id; });
  if (step == life_steps.end()) return false;
  go(*step);
  return true;
}

}  // namespace tessera::ros2
