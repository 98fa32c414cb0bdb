#include "spec/model/few_values.hpp"

#include <algorithm>
#include <cctype>

#include "tessera/goal_life.hpp"

namespace tessera::spec {
namespace {

/// "LentTo" of "lent_to".
std::string upper_camel(std::string_view name) {
  std::string out;
  bool upper = true;
  for (const char letter : name) {
    if (letter != '_')
      out += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(letter))) : letter;
    upper = letter == '_';
  }
  return out;
}

}  // namespace

std::string enumeration_name(std::string_view cell, const std::set<std::string>& taken) {
  std::string name = upper_camel(cell);
  while (taken.contains(name) || name == "Memory") name += "Value";
  return name;
}

std::optional<std::uint32_t> FewValues::find(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - names.begin());
}

std::string FewValues::in_words() const {
  if (counts) return "a count from " + names.front() + " to " + names.back();
  std::string text = "one of ";
  std::size_t said = 0;
  for (std::uint32_t value = 0; value < names.size() && said < 10; ++value, ++said) {
    text += (value == 0 ? "" : ", ") + names[value];
    if (member_count < 3 || value != first_member) continue;
    value += member_count - 1;
    text += " to " + names[value];
  }
  return text + (said == 10 && names.size() > 10 + member_count ? " ..." : "");
}

std::optional<std::uint32_t> Change::after(std::uint32_t before, const FewValues& values) const {
  if (step == 0) return value;
  const std::int64_t moved = std::int64_t{before} + step;
  if (moved < 0 || moved >= static_cast<std::int64_t>(values.names.size())) return std::nullopt;
  return static_cast<std::uint32_t>(moved);
}

Change Order::change() const {
  return {.cell = cell, .value = static_cast<std::uint32_t>(GoalState::ordered), .span = span};
}

std::optional<Allowed> allowed(const FewValues& values, std::uint32_t cell,
                               const std::vector<Change>& changes) {
  std::optional<Allowed> found;
  for (std::uint32_t before = 0; before < values.names.size(); ++before) {
    std::optional<std::uint32_t> now = before;
    for (const Change& change : changes)
      if (now && change.cell == cell) now = change.after(*now, values);
    if (!now) continue;
    if (!found) found = Allowed{before, before};
    found->last = before;
  }
  return found;
}

}  // namespace tessera::spec
