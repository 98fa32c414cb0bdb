// Memory cells with few values: in `sets`, in conditions and in properties.

#include <algorithm>
#include <charconv>
#include <string_view>

#include "language/questions/completer.hpp"
#include "tessera/goal_life.hpp"

namespace tessera::language {
namespace {

constexpr std::string_view goal_type = "{ goal: ";

constexpr std::uint32_t most_counts = 16;  // that are proposed

/// "0", "1" ... of "0..4"; empty: there are too many, or it is no range.
std::vector<std::string> counts_of(std::string_view range) {
  std::uint32_t first = 0, last = 0;
  const std::size_t dots = range.find("..");
  const auto read = [](std::string_view text, std::uint32_t& number) {
    return std::from_chars(text.data(), text.data() + text.size(), number).ec == std::errc();
  };
  std::vector<std::string> all;
  if (dots == std::string_view::npos || !read(range.substr(0, dots), first) ||
      !read(range.substr(dots + 2), last) || last < first || last - first >= most_counts)
    return all;
  for (std::uint32_t count = first; count <= last; ++count) all.push_back(std::to_string(count));
  return all;
}

}  // namespace

NamesOf Completer::kept_cells(const UnitNames& unit) const {
  NamesOf cells = unit.memory;
  std::erase_if(cells, [&](const auto& cell) {
    const std::string& type = index_[cell.second].type;
    return !type.starts_with('{') || type.starts_with(goal_type);
  });
  return cells;
}

NamesOf Completer::goals(const UnitNames& unit) const {
  NamesOf cells = unit.memory;
  std::erase_if(cells, [&](const auto& cell) { return !index_[cell.second].type.starts_with(goal_type); });
  return cells;
}

bool Completer::value_of_goal() {
  if (inside_.size() == 3 && step(0) == "memory" && (step(2) == "goal" || step(2) == "progress")) {
    const bool orders = step(2) == "goal";
    const bool has_base = !chain().empty();
    for (const auto& [name, id] : orders ? unit_->outputs : unit_->inputs)
      if (index_[id].fleet.empty())
        add(Proposal::Kind::name, name, index_[id].type, has_base ? name : (orders ? "out." : "in.") + name);
    return true;
  }
  if (step(0) != "behaviours" || inside_.back() != "orders") return false;
  return add_names(goals(*unit_)), true;
}

void Completer::values_of_cell(const UnitNames& unit, const std::string& cell) {
  if (const auto values = unit.values.find(cell); values != unit.values.end())
    return add_names(values->second);
  const auto counter = unit.memory.find(cell);
  if (counter == unit.memory.end()) return;
  if (index_[counter->second].type.starts_with(goal_type)) {
    for (const std::string_view state : goal_state_names)
      add(Proposal::Kind::word, std::string(state), "state of a goal");
    return;
  }
  const Node& counts = node_at(document_.outline(), index_[counter->second].way)["counts"];
  for (const std::string& count : counts_of(counts.text)) add(Proposal::Kind::word, count, "count");
}

bool Completer::value_of_change() {
  if (inside_.size() < 2 || inside_[inside_.size() - 2] != "sets") return false;
  const std::string& text = document_.text();
  const bool signed_already = begin_ > 0 && (text[begin_ - 1] == '+' || text[begin_ - 1] == '-');
  if (!unit_->values.contains(inside_.back()) && kept_cells(*unit_).contains(inside_.back())) {
    if (signed_already) return add(Proposal::Kind::word, "1"), true;
    add(Proposal::Kind::word, "+1", "one more; not taken if there is none");
    add(Proposal::Kind::word, "-1", "one less; not taken if there is none");
  }
  values_of_cell(*unit_, inside_.back());
  return true;
}

bool Completer::value_after_comparison() {
  const std::size_t from = std::min(place_.scalar->extent.begin, begin_);
  const std::vector<Token> tokens = tokens_of(std::string_view(marked_).substr(from, begin_ - from));
  std::size_t at = tokens.size();
  const auto ends_with = [&](std::string_view text) { return at > 0 && tokens[at - 1].text == text; };
  if (ends_with("not_eq")) {
    --at;
  } else {
    if (!ends_with("=") && !ends_with("<") && !ends_with(">")) return false;
    while (ends_with("=") || ends_with("!") || ends_with("<") || ends_with(">")) --at;
  }
  std::vector<std::string> names;
  while (at > 0 && tokens[at - 1].kind == Token::Kind::name) {
    names.emplace_back(tokens[--at].text);
    if (!ends_with(".")) break;
    --at;
    if (ends_with("]")) {
      while (at > 0 && !ends_with("[")) --at;
      if (at > 0) --at;
    }
  }
  if (names.size() == 2 && names[1] == "memory" && unit_ != nullptr)
    return values_of_cell(*unit_, names[0]), true;
  if (names.size() != 4 || names[1] != "memory") return false;
  const DefinitionNames* definition = index_.definition_of(names[3]);
  if (definition == nullptr) return false;
  for (const UnitNames& unit : definition->units)
    if (unit.name == names[2]) values_of_cell(unit, names[0]);
  return true;
}

}  // namespace tessera::language
