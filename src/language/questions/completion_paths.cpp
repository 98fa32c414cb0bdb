// Paths of agents, subsystems and buffers: in channels, drivers, properties.

#include <algorithm>

#include "language/questions/completer.hpp"
#include "spec/behaviours/groups.hpp"

namespace tessera::language {

void Completer::words_of_formulas() {
  if (!chain().empty()) return;
  for (const char* word : {"and", "or", "not"}) add(Proposal::Kind::word, word);
}

const NamesOf& Completer::ends(const UnitNames& unit, PathEnd end) {
  switch (end) {
    case PathEnd::output:
      return unit.outputs;
    case PathEnd::input:
      return unit.inputs;
    case PathEnd::real:
      return unit.real;
    default:
      return unit.behaviours;
  }
}

void Completer::paths(PathEnd end, const std::string& fleet) {
  const std::vector<std::string> names = place_.key != nullptr ? chain_of_key() : chain();
  if (names.empty()) return whole_paths(end, fleet);
  const DefinitionNames* definition = index_.definition_of(names[0]);
  if (definition == nullptr || end == PathEnd::agent) return;
  for (const UnitNames& unit : definition->units) {
    const bool any = end == PathEnd::behaviour || end == PathEnd::subsystem;
    if (names.size() == 1 && (any || !ends(unit, end).empty()))
      add(Proposal::Kind::name, unit.name, "subsystem");
    if (names.size() == 2 && unit.name == names[1]) {
      if (end == PathEnd::real)
        add_names(ends(unit, end));
      else if (end != PathEnd::subsystem)
        members_of_fleets(ends(unit, end), fleet);
      if (any) {
        members_of_fleets(unit.outputs, fleet);
        members_of_fleets(unit.inputs, fleet);
      }
      if (end == PathEnd::behaviour && !kept_cells(unit).empty())
        add(Proposal::Kind::word, "memory", "memory cells that the net knows", "memory.");
    }
    if (names.size() == 3 && end == PathEnd::behaviour && unit.name == names[1] && names[2] == "memory")
      add_names(kept_cells(unit));
    if (names.size() > 2 && end == PathEnd::behaviour && unit.name == names[1])
      behaviours_in_path(unit, names);
    if (names.size() == 3 && end == PathEnd::behaviour && unit.name == names[1]) outcomes_of(unit, names[2]);
    if (names.size() > 2 && end == PathEnd::real && unit.name == names[1]) fields_of_path(unit, names);
  }
}

void Completer::members_of_fleets(const NamesOf& names, const std::string& index) {
  for (const auto& [name, id] : names)
    add(Proposal::Kind::name, index_[id].fleet.empty() ? name : name + index,
        index_[id].type.empty() ? std::string(words_of(index_[id])) : index_[id].type);
}

void Completer::behaviours_in_path(const UnitNames& unit, const std::vector<std::string>& names) {
  SymbolId group;
  for (std::size_t at = 2; at < names.size(); ++at) {
    const NamesOf& inside = unit.behaviours_in(group);
    const auto found = inside.find(names[at]);
    if (found == inside.end()) return;
    group = found->second;
  }
  add_names(unit.behaviours_in(group));
}

void Completer::outcomes_of(const UnitNames& unit, const std::string& buffer) {
  if (unit.inputs.contains(buffer)) add(Proposal::Kind::word, "fresh", "the last receive took a value");
  if (!unit.outputs.contains(buffer)) return;
  add(Proposal::Kind::word, "timed_out", "nobody acknowledged the last value in time");
  for (const char* state : {"full", "empty", "ack", "channel"})
    add(Proposal::Kind::word, state, "a place of the channel");
}

void Completer::fields_of_path(const UnitNames& unit, const std::vector<std::string>& names) {
  const auto buffer = unit.real.find(names[2]);
  if (buffer == unit.real.end()) return;
  const NamesOf* fields = index_.fields_of(index_[buffer->second].type);
  for (std::size_t at = 3; fields != nullptr && at < names.size(); ++at) {
    const auto field = fields->find(names[at]);
    fields = field == fields->end() ? nullptr : index_.fields_of(index_[field->second].type);
  }
  if (fields != nullptr) add_names(*fields);
}

std::vector<std::string> Completer::chain_of_key() const {
  std::vector<std::string> names;
  const std::size_t from = std::min(place_.key->extent.begin, begin_);
  for (const DottedPath& path : paths_in(std::string_view(marked_).substr(from, begin_ - from)))
    for (const PathWord& word : path.words) names.emplace_back(word.name);
  return names;
}

void Completer::whole_paths(PathEnd end, const std::string& fleet) {
  for (const auto& [agent, id] : index_.agents()) {
    const std::string name = agent + (index_.is_fleet(agent) ? fleet : "");
    if (end == PathEnd::agent) {
      add_path(name, "agent");
      continue;
    }
    const DefinitionNames* definition = index_.definition_of(agent);
    if (definition == nullptr) continue;
    if (end == PathEnd::subsystem)
      for (const UnitNames& unit : definition->units) add_path(name + "." + unit.name, "subsystem");
    else
      for (const UnitNames& unit : definition->units)
        for (const auto& [part, symbol] : ends(unit, end)) {
          if (proposals_.size() >= most_proposals) return;
          const std::string index = index_[symbol].fleet.empty() ? "" : fleet;
          add_path(name + "." + unit.name + "." + part + index, index_[symbol].type);
          if (end == PathEnd::behaviour && index_[symbol].is_group)
            paths_in_group(unit, symbol, name + "." + unit.name + "." + part, 0);
        }
  }
}

void Completer::paths_in_group(const UnitNames& unit, SymbolId group, const std::string& path,
                               std::size_t depth) {
  if (depth == spec::most_nested_groups) return;
  std::vector<SymbolId> all;
  for (const auto& [name, id] : unit.behaviours_in(group)) all.push_back(id);
  std::sort(all.begin(), all.end());  // as in the file
  for (const SymbolId id : all) {
    if (proposals_.size() >= most_proposals) return;
    add_path(path + "." + index_[id].name, "");
    if (index_[id].is_group) paths_in_group(unit, id, path + "." + index_[id].name, depth + 1);
  }
}

std::string Completer::quoted_if_needed(const std::string& text) const {
  const bool starts = place_.key != nullptr || place_.scalar->extent.begin >= begin_;
  const bool quoted = place_.scalar != nullptr && place_.scalar->quoted;
  const bool flow = place_.parent != nullptr && place_.parent->flow;
  return text.find('[') != std::string::npos && starts && !quoted && flow ? '"' + text + '"' : text;
}

void Completer::add_path(const std::string& path, const std::string& detail) {
  std::string insert = quoted_if_needed(path);
  if (place_.key != nullptr && !colon_follows()) insert += ": ";
  add(Proposal::Kind::name, path, detail, std::move(insert));
}

}  // namespace tessera::language
