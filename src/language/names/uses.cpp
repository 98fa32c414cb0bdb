// The second walk of an index: uses inside of subsystems.

#include <algorithm>
#include <utility>

#include "language/names/index_builder.hpp"
#include "spec/behaviours/groups.hpp"
#include "spec/document/families.hpp"

namespace tessera::language {

void IndexBuilder::use(Extent extent, const NamesOf& names, std::string_view name) {
  // "lend[i]": the index is no part of the name.
  const std::string_view without = name.substr(0, name.find('['));
  if (givens_ != nullptr)
    if (const auto given = givens_->find(without); given != givens_->end()) {
      const Givens* const all = std::exchange(givens_, nullptr);
      if (const auto& [text, at, is_written] = given->second; is_written)
        use({at, at + text.size()}, names, text);
      givens_ = all;
      return;
    }
  if (const auto found = names.find(without); found != names.end())
    index_.uses_.push_back(
        {{extent.begin, extent.end - (name.size() - without.size())}, found->second, false});
}

void IndexBuilder::use(const Node& scalar, const NamesOf& names) {
  if (scalar.is_scalar() && scalar.verbatim) use(scalar.extent, names, scalar.text);
}

void IndexBuilder::use_list(const Node& list, const NamesOf& names) {
  for (const Entry& order : list.entries) use_list(*order.value, names);
  for (const Entry& item : list.items)
    if (item.value->is_scalar() && item.value->verbatim)
      use_signed(item.value->extent, item.value->text, names);
}

void IndexBuilder::use_signed(Extent at, std::string_view text, const NamesOf& names) {
  const std::size_t sign = text.starts_with('+') || text.starts_with('-') ? 1 : 0;
  use({at.begin + sign, at.end}, names, text.substr(sign));
}

void IndexBuilder::use_condition(const UnitNames& unit, const Node& condition) {
  use_expression(unit, condition);
  use(condition, unit.shared);
  for (const Entry& named : condition.entries) {
    use_expression(unit, *named.value);
    if (is_nothing(*named.value)) use(named.extent, unit.shared, named.key);
  }
}

void IndexBuilder::use_type(const Node& value) {
  const Node& text = value.is_map() ? value["type"] : value;
  if (!text.is_scalar() || !text.verbatim) return;
  const std::size_t end = std::min(text.text.find_first_of(" \t[<"), text.text.size());
  use({text.extent.begin, text.extent.begin + end}, index_.types_,
      std::string_view(text.text).substr(0, end));
  if (const std::optional<spec::EachInType> each = spec::each_in(text.text))
    use_each(text.extent.begin + each->begin + 1,
             std::string_view(text.text).substr(each->begin + 1, each->end - each->begin - 2));
}

void IndexBuilder::use_each(std::size_t at, std::string_view whole) {
  const std::string_view fleet = fleet_in(whole);
  if (fleet.empty()) return;
  at += static_cast<std::size_t>(fleet.data() - whole.data());
  use({at, at + fleet.size()}, index_.agents_, fleet);
}

void IndexBuilder::use_types() {
  for (const Entry& type : root_["types"].entries)
    for (const Entry& field : type.value->entries) use_type(*field.value);
  for (const char* section : {"templates", "agents"})
    for (const Entry& agent : root_[section].entries) use((*agent.value)["use"], index_.templates_);
}

void IndexBuilder::use_in_unit(UnitNames& unit) {
  const Node& body = *nodes_[next_node_++];
  for (const char* key : {"inputs", "outputs", "memory", "real"})
    for (const Entry& field : body[key].entries) use_type(*field.value);
  for (const Entry& cell : body["memory"].entries)
    for (const char* key : {"goal", "progress"}) use_expression(unit, (*cell.value)[key]);
  for (const Entry& cell : body["memory"].entries)
    for (const Entry& value : (*cell.value)["values"].items)
      if (value.value->verbatim) use_each(value.value->extent.begin, value.value->text);
  for (const Entry& cell : body["memory"].entries)
    if (const auto symbol = unit.memory.find(cell.key); symbol != unit.memory.end() && cell.value->is_map())
      use_fields((*cell.value)["initial"], index_.symbols_[symbol->second].type);
  for (const Entry& command : body["safe"].entries) {
    use(command.extent, unit.real, command.key);
    if (const auto symbol = unit.real.find(command.key); symbol != unit.real.end())
      use_fields(*command.value, index_.symbols_[symbol->second].type);
  }
  for (const Entry& limit : body["limits"].entries) use_limit(unit, limit);
  use(body["start"], unit.behaviours);
  use(body["on_error"], unit.behaviours);
  use_list(body["send"], unit.outputs);
  use_list(body["receive"], unit.inputs);
  for (const Entry& shared : body["conditions"].entries) use_expression(unit, *shared.value);
  use_in_behaviours(unit, body["behaviours"], {}, 0);
}

void IndexBuilder::use_on_errors() {
  std::size_t at = 0;
  for (const DefinitionNames& definition : index_.definitions_) {
    const Way& way = index_.symbols_[definition.symbol].way;
    const Node& agent = root_[way[0]][way[1]];
    for (const UnitNames& unit : definition.units)
      if (nodes_[at++]->find("on_error") == nullptr)
        use(agent.find("on_error") != nullptr ? agent["on_error"] : root_["on_error"], unit.behaviours);
  }
}

void IndexBuilder::use_fields(const Node& value, const std::string& type) {
  const NamesOf* fields = index_.fields_of(type);
  for (const Entry& item : value.items) use_fields(*item.value, type);
  if (fields == nullptr) return;
  for (const Entry& field : value.entries) {
    use(field.extent, *fields, field.key);
    if (const auto symbol = fields->find(field.key); symbol != fields->end())
      use_fields(*field.value, index_.symbols_[symbol->second].type);
  }
}

void IndexBuilder::use_limit(const UnitNames& unit, const Entry& limit) {
  const NamesOf* names = &unit.real;
  for (const DottedPath& path : paths_in(written(limit.extent)))
    for (const PathWord& word : path.words) {
      if (names == nullptr) return;
      const auto symbol = names->find(word.name);
      if (symbol == names->end()) return;
      use(moved(word.extent, limit.extent.begin), *names, word.name);
      names = index_.fields_of(index_.symbols_[symbol->second].type);
    }
}

std::string_view IndexBuilder::written(Extent extent) const {
  return text_.substr(extent.begin, extent.end - std::min(extent.begin, extent.end));
}

Extent IndexBuilder::moved(Extent extent, std::size_t by) { return {extent.begin + by, extent.end + by}; }

void IndexBuilder::use_in_behaviours(const UnitNames& unit, const Node& map, SymbolId group,
                                     std::size_t depth) {
  const NamesOf& names = unit.behaviours_in(group);
  for (const Entry& behaviour : map.entries) {
    use_in_behaviour(unit, behaviour, group);
    const auto found = names.find(behaviour.key);
    if (found == names.end() || !index_.symbols_[found->second].is_group || depth == spec::most_nested_groups)
      continue;
    const Entry* inside = behaviour.value->find("behaviours");
    // An alias repeats what its anchor says.
    if (inside == nullptr || !walked_.insert(inside->value).second) continue;
    use_in_behaviours(unit, (*behaviour.value)["behaviours"], found->second, depth + 1);
  }
}

void IndexBuilder::use_in_behaviour(const UnitNames& unit, const Entry& behaviour, SymbolId group) {
  const Node& body = *behaviour.value;
  static const NamesOf nothing;
  const NamesOf& behaviours = unit.behaviours_in(group);
  const auto own = behaviours.find(behaviour.key);
  const auto found = own == behaviours.end() ? unit.conditions.end() : unit.conditions.find(own->second);
  const NamesOf& conditions = found == unit.conditions.end() ? nothing : found->second;
  if (own != behaviours.end() && index_.symbols_[own->second].is_group) {
    use(body["start"], unit.behaviours_in(own->second));
    use(body["on_error"], unit.behaviours_in(own->second));
    use_expression(unit, body["until"]);
    if (body.find("use") != nullptr) use_template(unit, behaviour, own->second);
  }
  if (body["for"].verbatim) use_each(body["for"].extent.begin, body["for"].text);
  for (const char* key : {"terminal", "error"}) use_condition(unit, body[key]);
  use(body["send"], unit.outputs);
  use(body["receive"], unit.inputs);
  use_list(body["send"], unit.outputs);
  for (const Entry& output : body["send"].entries) {
    use_signed(output.extent, output.key, unit.outputs);
    use_condition(unit, (*output.value)["when"]);
  }
  use_list(body["receive"], unit.inputs);
  use_sets(unit, body["sets"]);
  use(body["orders"], unit.memory);
  const auto step = [&](const Node& next) {
    use(next, behaviours);
    use(next["to"], behaviours);
    const Node& when = next["when"];
    // A template names the shared conditions of the subsystem that uses it.
    use(when, givens_ == nullptr || conditions.contains(when.text) ? conditions : unit.shared);
    use_expression(unit, when);
    use_sets(unit, next["sets"]);
  };
  const Node& next = body["next"];
  step(next);
  for (const Entry& item : next.items) step(*item.value);
}

void IndexBuilder::use_sets(const UnitNames& unit, const Node& sets) {
  for (const Entry& change : sets.entries) {
    use(change.extent, unit.memory, change.key);
    if (const auto values = unit.values.find(change.key); values != unit.values.end())
      use(*change.value, values->second);
  }
}

void IndexBuilder::use_expression(const UnitNames& unit, const Node& text) {
  if (!text.is_scalar()) return;
  const std::vector<Token> tokens = words_of_expression(text);
  const auto found = [&](Extent extent, SymbolId symbol) {
    if (!extent.empty()) index_.uses_.push_back({extent, symbol, false});
  };
  resolve_members(index_, unit, tokens, found);
  resolve_values(unit, tokens, found);
}

}  // namespace tessera::language
