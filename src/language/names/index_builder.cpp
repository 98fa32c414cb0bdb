#include <algorithm>
#include <set>

#include "language/names/index.hpp"
#include "language/names/kinds.hpp"

namespace tessera::language {
/// Walks the outline twice: first the definitions, then the uses.
class IndexBuilder {
 public:
  IndexBuilder(std::string_view text, const Node& root, Index& index)
      : text_(text), root_(root), index_(index) {}

  void build() {
    index_.system_ = root_["system"].text;
    define_types();
    define_all(root_["parameters"], Kind::parameter, {}, {"parameters"}, "", index_.parameters_);
    define_agents("templates", Kind::agent_template, index_.templates_);
    define_agents("agents", Kind::agent, index_.agents_);
    define_all(root_["models"], Kind::model, {}, {"models"}, "", index_.models_);
    NamesOf processes;
    define_all(root_["deploy"]["processes"], Kind::process, {}, {"deploy", "processes"}, "", processes);
    use_types();
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
    use_in_world(root_["simulation"]);
    sort_uses();
  }

 private:
  SymbolId define(Kind kind, const Entry& entry, SymbolId owner, Way way, const std::string& above) {
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

  void define_all(const Node& map, Kind kind, SymbolId owner, const Way& way, const std::string& above,
                  NamesOf& names) {
    for (const Entry& entry : map.entries) {
      if (entry.key.empty() || names.contains(entry.key)) continue;
      const SymbolId id = define(kind, entry, owner, way, above);
      index_.symbols_[id].type = type_of(kind, *entry.value);
      names.emplace(entry.key, id);
    }
  }

  void define_types() {
    for (const Entry& type : root_["types"].entries) {
      if (type.key.empty() || index_.types_.contains(type.key)) continue;
      const SymbolId id = define(Kind::type, type, {}, {"types"}, "");
      index_.types_.emplace(type.key, id);
      define_all(*type.value, Kind::field, id, {"types", type.key}, type.key, index_.fields_[id]);
    }
  }

  void define_agents(const char* section, Kind kind, NamesOf& names) {
    for (const Entry& agent : root_[section].entries) {
      if (agent.key.empty() || names.contains(agent.key)) continue;
      const Node& body = *agent.value;
      const SymbolId id = define(kind, agent, {}, {section}, "");
      names.emplace(agent.key, id);
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

  void define_unit(DefinitionNames& definition, const Entry& entry, SubsystemRole role, const Way& above) {
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
    part("real", Kind::real, unit.real);
    part("parameters", Kind::parameter, unit.parameters);
    part("behaviours", Kind::behaviour, unit.behaviours);
    part("conditions", Kind::condition, unit.shared);
    for (const Entry& behaviour : body["behaviours"].entries) define_conditions(unit, behaviour, path);
    nodes_.push_back(&body);
    definition.units.push_back(std::move(unit));
  }

  void define_conditions(UnitNames& unit, const Entry& behaviour, const std::string& path) {
    const auto owner = unit.behaviours.find(behaviour.key);
    if (owner == unit.behaviours.end()) return;
    for (const char* key : {"terminal", "error"}) {
      Way way = unit.way;
      way.insert(way.end(), {"behaviours", behaviour.key, key});
      const Node& condition = (*behaviour.value)[key];
      NamesOf& names = unit.conditions[behaviour.key];
      const auto share = [&](const std::string& name) {
        const auto shared = unit.shared.find(name);
        if (shared != unit.shared.end()) names.insert(*shared);
        return shared != unit.shared.end();
      };
      if (condition.is_scalar()) share(condition.text);
      for (const Entry& named : condition.entries) {
        if (named.key.empty() || (is_nothing(*named.value) && share(named.key)) || names.contains(named.key))
          continue;
        names.emplace(named.key,
                      define(Kind::condition, named, owner->second, way, path + "." + behaviour.key));
      }
    }
  }

  // ------------------------------------------------------------------------------------------------ uses

  void use(Extent extent, const NamesOf& names, std::string_view name) {
    if (const auto found = names.find(name); found != names.end())
      index_.uses_.push_back({extent, found->second, false});
  }
  void use(const Node& scalar, const NamesOf& names) {
    if (scalar.is_scalar() && scalar.verbatim) use(scalar.extent, names, scalar.text);
  }
  /// Buffers of `send` or `receive`, or changes of the list of the subsystem: [+request, -grip].
  void use_list(const Node& list, const NamesOf& names) {
    for (const Entry& order : list.entries) use_list(*order.value, names);
    for (const Entry& item : list.items) {
      const Node& text = *item.value;
      if (!text.is_scalar() || !text.verbatim) continue;
      const std::size_t sign = text.text.starts_with('+') || text.text.starts_with('-') ? 1 : 0;
      use({text.extent.begin + sign, text.extent.end}, names, std::string_view(text.text).substr(sign));
    }
  }

  void use_type(const Node& value) {
    const Node& text = value.is_map() ? value["type"] : value;
    if (!text.is_scalar() || !text.verbatim) return;
    const std::size_t end = std::min(text.text.find_first_of(" \t[<"), text.text.size());
    use({text.extent.begin, text.extent.begin + end}, index_.types_,
        std::string_view(text.text).substr(0, end));
  }

  void use_types() {
    for (const Entry& type : root_["types"].entries)
      for (const Entry& field : type.value->entries) use_type(*field.value);
    for (const char* section : {"templates", "agents"})
      for (const Entry& agent : root_[section].entries) use((*agent.value)["use"], index_.templates_);
  }

  void use_in_unit(UnitNames& unit) {
    const Node& body = *nodes_[next_node_++];
    for (const char* key : {"inputs", "outputs", "memory", "real"})
      for (const Entry& field : body[key].entries) use_type(*field.value);
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
    for (const Entry& behaviour : body["behaviours"].entries) use_in_behaviour(unit, behaviour);
  }

  /// `on_error` of the system and of agents: the behaviour of the first subsystem that does not say it itself.
  void use_on_errors() {
    std::size_t at = 0;
    for (const DefinitionNames& definition : index_.definitions_) {
      const Way& way = index_.symbols_[definition.symbol].way;
      const Node& agent = root_[way[0]][way[1]];
      for (const UnitNames& unit : definition.units)
        if (nodes_[at++]->find("on_error") == nullptr)
          use(agent.find("on_error") != nullptr ? agent["on_error"] : root_["on_error"], unit.behaviours);
    }
  }

  /// The keys of a map that is a value of a structure.
  void use_fields(const Node& value, const std::string& type) {
    const NamesOf* fields = index_.fields_of(type);
    for (const Entry& item : value.items) use_fields(*item.value, type);
    if (fields == nullptr) return;
    for (const Entry& field : value.entries) {
      use(field.extent, *fields, field.key);
      if (const auto symbol = fields->find(field.key); symbol != fields->end())
        use_fields(*field.value, index_.symbols_[symbol->second].type);
    }
  }

  void use_limit(const UnitNames& unit, const Entry& limit) {
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

  /// The bytes of the file: several lines and escapes as they stand there.
  [[nodiscard]] std::string_view written(Extent extent) const {
    return text_.substr(extent.begin, extent.end - std::min(extent.begin, extent.end));
  }

  static Extent moved(Extent extent, std::size_t by) { return {extent.begin + by, extent.end + by}; }

  void use_in_behaviour(const UnitNames& unit, const Entry& behaviour) {
    const Node& body = *behaviour.value;
    static const NamesOf nothing;
    const auto found = unit.conditions.find(behaviour.key);
    const NamesOf& conditions = found == unit.conditions.end() ? nothing : found->second;
    for (const char* key : {"terminal", "error"}) {
      use_expression(unit, body[key]);
      use(body[key], unit.shared);
      for (const Entry& named : body[key].entries) {
        use_expression(unit, *named.value);
        if (is_nothing(*named.value)) use(named.extent, unit.shared, named.key);
      }
    }
    use(body["send"], unit.outputs);
    use(body["receive"], unit.inputs);
    use_list(body["send"], unit.outputs);
    use_list(body["receive"], unit.inputs);
    const auto step = [&](const Node& next) {
      use(next, unit.behaviours);
      use(next["to"], unit.behaviours);
      const Node& when = next["when"];
      use(when, conditions);
      use_expression(unit, when);
    };
    const Node& next = body["next"];
    step(next);
    for (const Entry& item : next.items) step(*item.value);
  }

  void use_expression(const UnitNames& unit, const Node& text) {
    if (!text.is_scalar()) return;
    resolve_members(index_, unit, tokens_of(written(text.extent)), [&](Extent extent, SymbolId symbol) {
      index_.uses_.push_back({moved(extent, text.extent.begin), symbol, false});
    });
  }

  // ------------------------------------------------------------------------------------------------ paths

  void paths(Extent extent, Place place) {
    for (const DottedPath& path : paths_in(written(extent))) {
      Place here = place;
      if (path.before_arrow) here = Place::from;
      if (path.after_arrow) here = Place::to;
      use_path(path, extent.begin, here);
    }
  }
  void paths(const Node& scalar, Place place) {
    if (scalar.is_scalar()) paths(scalar.extent, place);
  }

  void use_path(const DottedPath& path, std::size_t base, Place place) {
    const auto& words = path.words;
    // The places of the system itself.
    if (words.size() == 1 && place == Place::formula && (words[0].name == "in" || words[0].name == "out"))
      return;
    use(moved(words[0].extent, base), index_.agents_, words[0].name);
    if (words.size() < 2 || place == Place::agent) return;
    const DefinitionNames* definition = index_.definition_of(words[0].name);
    if (definition == nullptr) return;
    const auto unit = std::find_if(definition->units.begin(), definition->units.end(),
                                   [&](const UnitNames& one) { return one.name == words[1].name; });
    if (unit == definition->units.end()) return;
    index_.uses_.push_back({moved(words[1].extent, base), unit->symbol, false});
    if (words.size() < 3) return;
    use(moved(words[2].extent, base), members(*unit, place, words[2].name), words[2].name);
  }

  void use_in_channels() {
    for (const Entry& item : root_["channels"].items) {
      const Node& channel = *item.value;
      paths(channel, Place::formula);
      paths(channel["from"], Place::from);
      paths(channel["to"], Place::to);
      use(channel["model"], index_.models_);
    }
  }

  void use_in_drivers(const Node& drivers) {
    for (const Entry& driver : drivers.entries) paths(driver.extent, Place::real);
  }

  void use_in_deployment() {
    for (const Entry& process : root_["deploy"]["processes"].entries) {
      const Node& agents = process.value->is_map() ? (*process.value)["agents"] : *process.value;
      paths(agents, Place::agent);
      for (const Entry& agent : agents.items) paths(*agent.value, Place::agent);
    }
  }

  void use_in_formulas() {
    for (const Entry& property : root_["properties"].items)
      for (const Entry& entry : property.value->entries) {
        if (entry.key == "name") continue;
        paths(*entry.value, Place::formula);
        for (const Entry& item : entry.value->items) paths(*item.value, Place::formula);
      }
  }

  /// Objects that are models placed in the world; others are bodies of its file.
  void use_in_world(const Node& simulation) {
    std::set<std::string_view> placed;
    for (const Entry& model : simulation["models"].entries) {
      const std::string_view key = std::string_view(model.key).substr(0, model.key.find('['));
      placed.insert(key.substr(0, key.find_last_not_of(' ') + 1));
    }
    std::set<const Node*> seen;  // aliases share nodes
    const auto objects = [&](const Node& node, bool only_marked, const auto& inside) -> void {
      if (!seen.insert(&node).second) return;
      if (node.is_scalar())
        for (const Extent& object : objects_in(written(node.extent), only_marked)) {
          const Extent at = moved(object, node.extent.begin);
          if (!placed.contains(written(at))) continue;
          index_.objects_.push_back(at);
          use(at, index_.agents_, written(at));
        }
      for (const Entry& part : node.parts()) inside(*part.value, only_marked, inside);
    };
    for (const Entry& check : simulation["checks"].items)
      for (const Entry& entry : check.value->entries)
        if (entry.key != "name" && entry.key != "within") objects(*entry.value, false, objects);
    for (const Entry& measure : simulation["measures"].entries) objects(*measure.value, false, objects);
    for (const Entry& driver : simulation["drivers"].entries)
      // The options of a class and the controls of an operator are no objects of the world.
      if (driver.value->find("cpp") == nullptr && driver.value->find("panel") == nullptr)
        objects(*driver.value, true, objects);
  }

  void sort_uses() {
    auto& uses = index_.uses_;
    std::stable_sort(uses.begin(), uses.end(),
                     [](const Use& a, const Use& b) { return a.extent < b.extent; });
    const auto same = [](const Use& a, const Use& b) { return a.extent == b.extent; };
    uses.erase(std::unique(uses.begin(), uses.end(), same), uses.end());
  }

  std::string_view text_;
  const Node& root_;
  Index& index_;
  std::map<std::size_t, SymbolId> defined_at_;  ///< an alias repeats definitions of its anchor
  std::vector<const Node*> nodes_;              ///< the bodies of the units, in their order
  std::size_t next_node_ = 0;
};

Index::Index(std::string_view text, const Outline& outline) {
  IndexBuilder(text, outline.root(), *this).build();
}

}  // namespace tessera::language
