#include "language/names/index.hpp"

#include <algorithm>
#include <array>

namespace tessera::language {

namespace {

struct Words {
  std::string_view words, prefix;
};
constexpr std::array<Words, 16> words_of_kinds{{{"structure", "type"},
                                                {"field", "field"},
                                                {"parameter", "parameter"},
                                                {"memory cell", "memory"},
                                                {"value", "value"},
                                                {"input buffer", "input"},
                                                {"output buffer", "output"},
                                                {"real buffer", "real"},
                                                {"behaviour", ""},
                                                {"condition", "condition"},
                                                {"subsystem", ""},
                                                {"agent", ""},
                                                {"template", "template"},
                                                {"communication model", "model"},
                                                {"process", "process"},
                                                {"name that a template takes", "with"}}};

}  // namespace

std::string_view words_of(Kind kind) { return words_of_kinds[static_cast<std::size_t>(kind)].words; }
std::string_view words_of(const Symbol& symbol) {
  if (!symbol.is_group) return words_of(symbol.kind);
  return symbol.kind == Kind::behaviour ? "group of behaviours" : "template of a group";
}
std::string_view prefix_of(Kind kind) { return words_of_kinds[static_cast<std::size_t>(kind)].prefix; }

const Use* Index::at(std::size_t offset) const {
  const Use* best = nullptr;
  auto use = std::upper_bound(uses_.begin(), uses_.end(), offset,
                              [](std::size_t value, const Use& one) { return value < one.extent.begin; });
  while (use != uses_.begin()) {
    --use;
    if (use->extent.touches(offset)) {
      best = &*use;
      break;
    }
    if (use->extent.begin + 256 < offset) break;  // a name is short
  }
  return best;
}

const Use* Index::defined_at(std::size_t offset) const {
  const Use* use = at(offset);
  return use != nullptr && use->defines && use->extent.begin == offset ? use : nullptr;
}

const UnitNames* Index::unit_at(const Way& way) const {
  for (const DefinitionNames& definition : definitions_)
    for (const UnitNames& unit : definition.units)
      if (unit.way.size() <= way.size() && std::equal(unit.way.begin(), unit.way.end(), way.begin()))
        return &unit;
  if (way.size() < 2 || way[0] != "templates") return nullptr;
  const GroupTemplateNames* found = group_template(way[1]);
  return found == nullptr ? nullptr : &found->unit;
}

const GroupTemplateNames* Index::group_template(std::string_view name) const {
  const auto found = std::find_if(group_templates_.begin(), group_templates_.end(),
                                  [&](const GroupTemplateNames& one) { return one.unit.name == name; });
  return found == group_templates_.end() ? nullptr : &*found;
}

const NamesOf& UnitNames::behaviours_in(SymbolId group) const {
  static const NamesOf nothing;
  if (!group.valid()) return behaviours;
  const auto found = groups.find(group);
  return found == groups.end() ? nothing : found->second;
}

std::vector<SymbolId> UnitNames::all_behaviours() const {
  std::vector<SymbolId> all;
  for (const auto& [name, id] : behaviours) all.push_back(id);
  for (const auto& [group, names] : groups)
    for (const auto& [name, id] : names) all.push_back(id);
  std::sort(all.begin(), all.end());  // as in the file
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::optional<PlaceInBehaviours> Index::behaviour_at(const UnitNames& unit, const Way& way) const {
  std::size_t at = unit.way.size();
  if (at >= way.size() || way[at] != "behaviours") return std::nullopt;
  PlaceInBehaviours place;
  while (at + 1 < way.size() && way[at] == "behaviours") {
    if (place.behaviour.valid()) place.group = place.behaviour;
    const NamesOf& names = unit.behaviours_in(place.group);
    const auto found = names.find(way[at + 1]);
    place.behaviour = found == names.end() ? SymbolId{} : found->second;
    at += 2;
    if (!place.behaviour.valid()) break;
  }
  if (at + 1 == way.size() && way[at] == "behaviours" && place.behaviour.valid()) {
    place.group = place.behaviour;
    place.behaviour = {};
    ++at;
  }
  place.inside = std::min(at, way.size());
  return place;
}

const DefinitionNames* Index::definition_of(std::string_view agent) const {
  std::string_view name = agent;
  bool through_use = false;
  for (int step = 0; step < 64; ++step) {
    const auto use = use_of_.find(std::string(through_use ? "templates." : "agents.") + std::string(name));
    if (use == use_of_.end()) break;
    name = use->second;
    through_use = true;
  }
  const Kind kind = through_use ? Kind::agent_template : Kind::agent;
  const auto found = std::find_if(definitions_.begin(), definitions_.end(), [&](const DefinitionNames& one) {
    return one.name == name && symbols_[one.symbol].kind == kind;
  });
  return found == definitions_.end() ? nullptr : &*found;
}

const NamesOf* Index::fields_of(std::string_view type) const {
  const std::size_t begin = std::min(type.find_first_not_of(" \t"), type.size());
  const std::size_t end = std::min(type.find_first_of(" \t[<", begin), type.size());
  const auto structure = types_.find(type.substr(begin, end - begin));
  if (structure == types_.end()) return nullptr;
  const auto fields = fields_.find(structure->second);
  return fields == fields_.end() ? nullptr : &fields->second;
}

std::string Index::enumeration_of(SymbolId cell) const {
  const auto found = enumerations_.find(cell);
  return found == enumerations_.end() ? std::string() : found->second;
}

}  // namespace tessera::language
