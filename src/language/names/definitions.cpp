// The first walk of an index: what has a name.

#include <algorithm>
#include <set>

#include "language/names/index_builder.hpp"
#include "spec/behaviours/groups.hpp"
#include "spec/document/families.hpp"
#include "spec/model/few_values.hpp"

namespace tessera::language {

void IndexBuilder::build() {
  index_.system_ = root_["system"].text;
  define_types();
  define_all(root_["parameters"], Kind::parameter, {}, {"parameters"}, "", index_.parameters_);
  define_agents("templates", Kind::agent_template, index_.templates_);
  define_agents("agents", Kind::agent, index_.agents_);
  define_member_values();
  define_all(root_["models"], Kind::model, {}, {"models"}, "", index_.models_);
  NamesOf processes;
  define_all(root_["deploy"]["processes"], Kind::process, {}, {"deploy", "processes"}, "", processes);
  link_all();
  use_types();
  use_in_templates();
  for (DefinitionNames& definition : index_.definitions_)
    for (UnitNames& unit : definition.units) use_in_unit(unit);
  use_on_errors();
  use_in_channels();
  use_in_drivers(root_["drivers"]);
  use_in_drivers(root_["simulation"]["drivers"]);
  for (const Entry& input : root_["simulation"]["script"].items) paths((*input.value)["set"], Place::real);
  for (const Entry& placed : root_["simulation"]["models"].entries) paths(placed.extent, Place::agent);
  use_in_deployment();
  use_in_formulas();
  use_in_chains();
  use_in_world(root_["simulation"]);
  share_names();
  sort_uses();
}

SymbolId IndexBuilder::define(Kind kind, const Entry& entry, SymbolId owner, Way way,
                              const std::string& above) {
  Symbol symbol;
  symbol.kind = kind;
  symbol.name = entry.key.substr(0, entry.key.find_first_of(" ["));  // the index of a process is no name
  symbol.path = above.empty() ? symbol.name : above + "." + symbol.name;
  symbol.definition = {entry.extent.begin,
                       std::min(entry.extent.end, entry.extent.begin + symbol.name.size())};
  symbol.whole = {entry.extent.begin, std::max(entry.extent.end, entry.value->extent.end)};
  symbol.owner = owner;
  symbol.way = std::move(way);
  symbol.way.push_back(entry.key);
  const SymbolId id = index_.symbols_.next_id();
  if (const auto [same, added] = defined_at_.emplace(entry.extent.begin, id); !added) return same->second;
  index_.symbols_.push_back(std::move(symbol));
  index_.uses_.push_back({index_.symbols_[id].definition, id, true});
  return id;
}

void IndexBuilder::define_all(const Node& map, Kind kind, SymbolId owner, const Way& way,
                              const std::string& above, NamesOf& names) {
  for (const Entry& entry : map.entries) {
    if (entry.key.empty() || names.contains(entry.key)) continue;
    const SymbolId id = define(kind, entry, owner, way, above);
    Symbol& symbol = index_.symbols_[id];
    symbol.type = type_of(kind, *entry.value);
    symbol.fleet = fleet_of(kind, *entry.value, symbol.type);
    const Entry* use = kind == Kind::behaviour ? entry.value->find("use") : nullptr;
    symbol.is_group =
        use != nullptr || (kind == Kind::behaviour && entry.value->find("behaviours") != nullptr);
    if (use != nullptr) used_templates_.emplace(id, use->value->text);
    names.emplace(entry.key, id);
  }
}

void IndexBuilder::define_types() {
  for (const Entry& type : root_["types"].entries) {
    if (type.key.empty() || index_.types_.contains(type.key)) continue;
    const SymbolId id = define(Kind::type, type, {}, {"types"}, "");
    index_.types_.emplace(type.key, id);
    define_all(*type.value, Kind::field, id, {"types", type.key}, type.key, index_.fields_[id]);
  }
}

void IndexBuilder::define_agents(const char* section, Kind kind, NamesOf& names) {
  for (const Entry& agent : root_[section].entries) {
    if (agent.key.empty() || names.contains(agent.key)) continue;
    const Node& body = *agent.value;
    const SymbolId id = define(kind, agent, {}, {section}, "");
    names.emplace(agent.key, id);
    if (kind == Kind::agent_template && body.find("behaviours") != nullptr &&
        body.find("control") == nullptr) {
      define_group_template(agent, id);
      continue;
    }
    if (body.find("count") != nullptr) index_.fleets_.emplace(agent.key, id);
    if (const Entry* use = body.find("use")) {
      index_.use_of_[std::string(section) + "." + agent.key] = use->value->text;
      continue;
    }
    DefinitionNames definition;
    definition.symbol = id;
    definition.name = agent.key;
    const Way way{section, agent.key};
    if (const Entry* control = body.find("control"))
      define_unit(definition, *control, SubsystemRole::control, way);
    for (const auto& [key, role] :
         {std::pair{"receptors", SubsystemRole::receptor}, {"effectors", SubsystemRole::effector}}) {
      Way inside = way;
      inside.emplace_back(key);
      for (const Entry& entry : body[key].entries) define_unit(definition, entry, role, inside);
    }
    index_.definitions_.push_back(std::move(definition));
  }
}

void IndexBuilder::define_unit(DefinitionNames& definition, const Entry& entry, SubsystemRole role,
                               const Way& above) {
  UnitNames unit;
  unit.role = role;
  unit.name = entry.key;
  unit.symbol = define(Kind::subsystem, entry, definition.symbol, above, definition.name);
  unit.way = above;
  unit.way.push_back(entry.key);
  const Node& body = *entry.value;
  const std::string path = definition.name + "." + entry.key;
  const auto part = [&](const char* key, Kind kind, NamesOf& names) {
    Way way = unit.way;
    way.emplace_back(key);
    define_all(body[key], kind, unit.symbol, way, path, names);
  };
  part("inputs", Kind::input, unit.inputs);
  part("outputs", Kind::output, unit.outputs);
  part("memory", Kind::memory, unit.memory);
  define_values(unit, body["memory"], path);
  part("real", Kind::real, unit.real);
  part("parameters", Kind::parameter, unit.parameters);
  part("conditions", Kind::condition, unit.shared);
  define_behaviours(unit, body["behaviours"], {});
  nodes_.push_back(&body);
  definition.units.push_back(std::move(unit));
}

void IndexBuilder::define_values(UnitNames& unit, const Node& memory, const std::string& path) {
  std::set<std::string> taken;
  for (const auto& [name, id] : index_.types_) taken.insert(name);
  for (const auto& [name, id] : unit.memory) taken.insert(name);
  for (const Entry& cell : memory.entries) {
    const auto owner = unit.memory.find(cell.key);
    const Entry* list = cell.value->find("values");
    const bool is_goal = cell.value->find("goal") != nullptr;
    if ((list == nullptr && !is_goal) || owner == unit.memory.end() || unit.values.contains(cell.key))
      continue;
    index_.enumerations_[owner->second] = *taken.insert(spec::enumeration_name(cell.key, taken)).first;
    if (list == nullptr) continue;  // the states of a goal are no names of the file
    NamesOf& values = unit.values[cell.key];
    Way way = index_.symbols_[owner->second].way;
    way.emplace_back("values");
    for (const Entry& item : list->value->items) {
      const Node& text = *item.value;
      if (!text.is_scalar() || !text.verbatim || text.text.empty() || values.contains(text.text)) continue;
      if (spec::says_each(text.text)) continue;
      const Entry named{.key = text.text, .extent = text.extent, .value = &text};
      values.emplace(text.text, define(Kind::value, named, owner->second, way, path + "." + cell.key));
    }
  }
}

void IndexBuilder::define_member_values() {
  std::size_t at = 0;
  for (DefinitionNames& definition : index_.definitions_)
    for (UnitNames& unit : definition.units)
      for (const Entry& cell : (*nodes_[at++])["memory"].entries) {
        const auto values = unit.values.find(cell.key);
        if (values == unit.values.end()) continue;
        for (const Entry& item : (*cell.value)["values"].items) {
          if (!spec::says_each(item.value->text)) continue;
          const auto fleet = index_.agents_.find(fleet_in(item.value->text));
          if (fleet != index_.agents_.end()) values->second.insert(*fleet);
        }
      }
}

void IndexBuilder::define_behaviours(UnitNames& unit, const Node& map, const std::vector<SymbolId>& around) {
  const SymbolId owner = around.empty() ? unit.symbol : around.back();
  const std::string above = index_.symbols_[owner].path;
  Way way = around.empty() ? unit.way : index_.symbols_[owner].way;
  way.emplace_back("behaviours");
  NamesOf& names = around.empty() ? unit.behaviours : unit.groups[owner];
  define_all(map, Kind::behaviour, owner, way, above, names);
  std::string function;
  for (const SymbolId group : around) function += index_.symbols_[group].name + "_";
  for (const Entry& behaviour : map.entries) {
    const auto found = names.find(behaviour.key);
    if (found == names.end()) continue;
    std::vector<SymbolId> inside = around;
    inside.push_back(found->second);
    // An alias repeats the names that its anchor has.
    const bool is_known = unit.groups.contains(found->second) || unit.conditions.contains(found->second);
    define_conditions(unit, behaviour, found->second);
    if (!index_.symbols_[found->second].is_group)
      unit.functions.emplace(function + behaviour.key, std::move(inside));
    else if (!is_known && inside.size() <= spec::most_nested_groups)
      define_behaviours(unit, (*behaviour.value)["behaviours"], inside);
  }
}

void IndexBuilder::define_conditions(UnitNames& unit, const Entry& behaviour, SymbolId owner) {
  const Symbol symbol = index_.symbols_[owner];
  NamesOf& names = unit.conditions[owner];
  for (const char* key : {"terminal", "error"}) {
    Way way = symbol.way;
    way.emplace_back(key);
    const Node& condition = (*behaviour.value)[key];
    const auto share = [&](const std::string& name) {
      const auto shared = unit.shared.find(name);
      if (shared != unit.shared.end()) names.insert(*shared);
      return shared != unit.shared.end();
    };
    if (condition.is_scalar()) share(condition.text);
    for (const Entry& named : condition.entries) {
      const bool is_shared = is_nothing(*named.value) && (share(named.key) || in_template_);
      if (named.key.empty() || is_shared || names.contains(named.key)) continue;
      names.emplace(named.key, define(Kind::condition, named, owner, way, symbol.path));
    }
  }
}

Index::Index(std::string_view text, const Outline& outline) {
  IndexBuilder(text, outline.root(), *this).build();
}

}  // namespace tessera::language
