#include "subsystem/parameter_changes.hpp"

#include <fmt/core.h>

namespace tessera {

std::optional<Problem> ParameterChanges::ask(const std::string& path, const std::string& value) {
  std::vector<CheckedValue> checked;
  if (std::optional<Problem> wrong = check_parameter(owners_, path, value, checked)) return wrong;
  for (CheckedValue& one : checked) {
    Waiting& waiting = waiting_[one.owner];
    std::string text = fmt::format("{}.{}={}", owners_[one.owner].path, one.parameter.name, value);
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

}  // namespace tessera
