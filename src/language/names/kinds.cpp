#include "language/names/kinds.hpp"

#include "spec/document/families.hpp"

namespace tessera::language {

bool is_nothing(const Node& node) { return node.kind == Node::Kind::null; }

namespace {

/// "{ values: [nobody, a, b] }", "{ counts: 0..4 }", "{ goal: out.goal, progress: in.progress }"; empty: the cell has a
/// type.
std::string few_values(const Node& cell) {
  constexpr std::size_t most_shown = 10;
  const Entry* initial = cell.find("initial");
  const std::string end = initial == nullptr ? " }" : ", initial: " + initial->value->text + " }";
  if (const Entry* counts = cell.find("counts")) return "{ counts: " + counts->value->text + end;
  if (const Entry* goal = cell.find("goal"))
    return "{ goal: " + goal->value->text + ", progress: " + cell["progress"].text + " }";
  const Entry* values = cell.find("values");
  if (values == nullptr) return {};
  std::string text;
  const std::vector<Entry>& items = values->value->items;
  for (std::size_t at = 0; at < items.size() && at < most_shown; ++at)
    text += (at == 0 ? "" : ", ") + items[at].value->text;
  return "{ values: [" + text + (items.size() > most_shown ? ", ..." : "") + "]" + end;
}

}  // namespace

std::string type_of(Kind kind, const Node& value) {
  if (kind == Kind::parameter) {
    if (value.is_scalar()) return value.text;
    const std::string unit = value["unit"].text;
    return (value["type"].text.empty() ? "float64" : value["type"].text) + (unit.empty() ? "" : " " + unit);
  }
  if (kind == Kind::model || kind == Kind::process || kind == Kind::behaviour || kind == Kind::condition)
    return {};
  if (!value.is_map()) return value.text;
  if (kind == Kind::memory)
    if (const std::string few = few_values(value); !few.empty()) return few;
  return value["type"].text;
}

std::string_view fleet_in(std::string_view each) {
  constexpr std::string_view blanks = " \t";
  if (!spec::says_each(each)) return {};
  each.remove_prefix(each.find("each") + 4);
  const std::size_t begin = each.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return each.substr(begin, each.find_last_not_of(blanks) + 1 - begin);
}

std::string fleet_of(Kind kind, const Node& value, std::string_view type) {
  if (kind == Kind::behaviour) return std::string(fleet_in(value["for"].text));
  if (kind != Kind::input && kind != Kind::output) return {};
  const std::optional<spec::EachInType> each = spec::each_in(type);
  return each ? std::string(fleet_in(type.substr(each->begin + 1, each->end - each->begin - 2))) : "";
}

const NamesOf& members(const UnitNames& unit, Place place, std::string_view name) {
  if (place == Place::from) return unit.outputs;
  if (place == Place::to) return unit.inputs;
  if (place == Place::real) return unit.real;
  if (place == Place::chain) return unit.outputs.contains(name) ? unit.outputs : unit.inputs;
  if (unit.behaviours.contains(name)) return unit.behaviours;
  return unit.inputs.contains(name)    ? unit.inputs
         : unit.outputs.contains(name) ? unit.outputs
                                       : unit.behaviours;
}

}  // namespace tessera::language
