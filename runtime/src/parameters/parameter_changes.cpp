#include "parameters/parameter_changes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

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
  const std::pair one(path, value);
  return ask_all({&one, 1});
}

std::optional<Problem> ParameterChanges::ask_all(
    std::span<const std::pair<std::string, std::string>> values) {
  std::vector<CheckedValue> checked;
  std::vector<std::vector<Change>> changes(owners_.size());
  std::vector<std::pair<std::size_t, const std::string*>> texts;  // the end of the checked ones of a value
  for (const auto& [path, value] : values) {
    if (std::optional<Problem> wrong = check_parameter(owners_, path, value, checked)) return wrong;
    texts.emplace_back(checked.size(), &value);
  }
  std::size_t next = 0;
  for (const auto& [end, value] : texts)
    for (; next < end; ++next) {
      CheckedValue& one = checked[next];
      std::string text = note(one, *value);
      std::vector<Change>& of_owner = changes[one.owner];
      of_owner.push_back({std::move(one), std::move(text)});
    }
  for (std::size_t owner = 0; owner < changes.size(); ++owner) {
    if (changes[owner].empty()) continue;
    Waiting& waiting = waiting_[owner];
    const std::lock_guard lock(waiting.mutex);
    std::ranges::move(changes[owner], std::back_inserter(waiting.changes));
    waiting.any.store(true, std::memory_order_release);
  }
  return std::nullopt;
}

/// Offers the new value. Returns the text about the change.
std::string ParameterChanges::note(const CheckedValue& one, const std::string& value) {
  const ParameterOwner& owner = owners_[one.owner];
  const auto place = std::ranges::find(owner.parameters, one.parameter.name, &Bindings::Parameter::name);
  const std::lock_guard lock(offered_mutex_);
  offered_[first_offered_[one.owner] + static_cast<std::size_t>(place - owner.parameters.begin())].value =
      text_of(one.parameter, one.bytes.data());
  return fmt::format("{}.{}={}", owner.path, one.parameter.name, value);
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
