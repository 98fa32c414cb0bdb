#include "parameters/parameter_changes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace tessera {

ParameterChanges::ParameterChanges(std::vector<ParameterOwner> owners)
    : owners_(std::move(owners)), waiting_(std::make_unique<Waiting[]>(owners_.size())) {
  const auto limit = [](double number) {
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
  };
  for (const ParameterOwner& owner : owners_) {
    first_offered_.push_back(offered_.size());
    for (const Bindings::Parameter& one : owner.parameters)
      offered_.push_back({.path = fmt::format("{}.{}", owner.path, one.name),
                          .value = text_of(one, one.value),
                          .unit = std::string(one.unit),
                          .minimum = limit(one.minimum),
                          .maximum = limit(one.maximum)});
  }
}

std::optional<Problem> ParameterChanges::ask(const std::string& path, const std::string& value) {
  std::vector<CheckedValue> checked;
  if (std::optional<Problem> wrong = check_parameter(owners_, path, value, checked)) return wrong;
  for (CheckedValue& one : checked) {
    Waiting& waiting = waiting_[one.owner];
    const ParameterOwner& owner = owners_[one.owner];
    std::string text = fmt::format("{}.{}={}", owner.path, one.parameter.name, value);
    const auto place = std::ranges::find(owner.parameters, one.parameter.name, &Bindings::Parameter::name);
    {
      const std::lock_guard lock(offered_mutex_);
      offered_[first_offered_[one.owner] + static_cast<std::size_t>(place - owner.parameters.begin())].value =
          text_of(one.parameter, one.bytes.data());
    }
    const std::lock_guard lock(waiting.mutex);
    waiting.changes.push_back({std::move(one), std::move(text)});
    waiting.any.store(true, std::memory_order_release);
  }
  return std::nullopt;
}

std::optional<Problem> ParameterChanges::try_out(const std::string& path, const std::string& value) const {
  std::vector<CheckedValue> checked;
  return check_parameter(owners_, path, value, checked);
}

std::vector<Offered::Value> ParameterChanges::offered() const {
  const std::lock_guard lock(offered_mutex_);
  return offered_;
}

}  // namespace tessera
