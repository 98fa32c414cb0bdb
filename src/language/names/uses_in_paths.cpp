// The second walk of an index: paths in channels, drivers, properties, chains and checks.

#include <algorithm>
#include <set>

#include "language/names/index_builder.hpp"

namespace tessera::language {

namespace {

/// "==" and the like, with blanks.
bool is_comparison(std::string_view between) {
  return between.find_first_of("=<>") != std::string_view::npos &&
         between.find_first_not_of(" \t\r\n=!<>") == std::string_view::npos;
}

}  // namespace

void IndexBuilder::paths(Extent extent, Place place) {
  const std::string_view text = written(extent);
  const NamesOf* values = nullptr;
  std::size_t end = text.size();
  for (const DottedPath& path : paths_in(text)) {
    const bool is_value = end < path.extent.begin && path.words.size() == 1 &&
                          is_comparison(text.substr(end, path.extent.begin - end));
    end = path.extent.end;
    if (is_value) {
      if (values != nullptr) use(moved(path.words[0].extent, extent.begin), *values, path.words[0].name);
      continue;
    }
    Place here = place;
    if (path.before_arrow) here = Place::from;
    if (path.after_arrow) here = Place::to;
    values = use_path(path, extent.begin, here);
  }
}

void IndexBuilder::paths(const Node& scalar, Place place) {
  if (scalar.is_scalar()) paths(scalar.extent, place);
}

const NamesOf* IndexBuilder::use_path(const DottedPath& path, std::size_t base, Place place) {
  const auto& words = path.words;
  // The places of the system itself.
  if (words.size() == 1 && place == Place::formula && (words[0].name == "in" || words[0].name == "out"))
    return nullptr;
  use(moved(words[0].extent, base), index_.agents_, words[0].name);
  if (words.size() < 2 || place == Place::agent) return nullptr;
  const DefinitionNames* definition = index_.definition_of(words[0].name);
  if (definition == nullptr) return nullptr;
  const auto unit = std::find_if(definition->units.begin(), definition->units.end(),
                                 [&](const UnitNames& one) { return one.name == words[1].name; });
  if (unit == definition->units.end()) return nullptr;
  index_.uses_.push_back({moved(words[1].extent, base), unit->symbol, false});
  if (words.size() < 3) return nullptr;
  if (place == Place::formula && words.size() > 3 && words[2].name == "memory")
    return use_memory_path(*unit, path, base);
  const NamesOf* names = &members(*unit, place, words[2].name);
  for (std::size_t at = 2; at < words.size(); ++at) {
    const auto name = names->find(words[at].name);
    if (name == names->end()) break;
    use(moved(words[at].extent, base), *names, words[at].name);
    names = &unit->behaviours_in(name->second);
    if (place != Place::formula || !index_.symbols_[name->second].is_group) break;
  }
  return nullptr;
}

const NamesOf* IndexBuilder::use_memory_path(const UnitNames& unit, const DottedPath& path,
                                             std::size_t base) {
  const auto& words = path.words;
  use(moved(words[3].extent, base), unit.memory, words[3].name);
  const auto values = unit.values.find(words[3].name);
  if (values == unit.values.end()) return nullptr;
  if (words.size() > 4) use(moved(words[4].extent, base), values->second, words[4].name);
  return &values->second;
}

void IndexBuilder::use_in_channels() {
  for (const Entry& item : root_["channels"].items) {
    const Node& channel = *item.value;
    paths(channel, Place::formula);
    paths(channel["from"], Place::from);
    paths(channel["to"], Place::to);
    use(channel["model"], index_.models_);
  }
}

void IndexBuilder::use_in_drivers(const Node& drivers) {
  for (const Entry& driver : drivers.entries) paths(driver.extent, Place::real);
}

void IndexBuilder::use_in_deployment() {
  for (const Entry& process : root_["deploy"]["processes"].entries) {
    const Node& agents = process.value->is_map() ? (*process.value)["agents"] : *process.value;
    paths(agents, Place::agent);
    for (const Entry& agent : agents.items) paths(*agent.value, Place::agent);
  }
}

void IndexBuilder::use_in_formulas() {
  for (const Entry& property : root_["properties"].items)
    for (const Entry& entry : property.value->entries) {
      if (entry.key == "name") continue;
      paths(*entry.value, Place::formula);
      for (const Entry& item : entry.value->items) paths(*item.value, Place::formula);
    }
}

void IndexBuilder::use_in_chains() {
  for (const Entry& chain : root_["timing"]["chains"].items)
    for (const Entry& stop : (*chain.value)["path"].items) paths(*stop.value, Place::chain);
}

void IndexBuilder::use_in_world(const Node& simulation) {
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

void IndexBuilder::sort_uses() {
  auto& uses = index_.uses_;
  std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.extent < b.extent; });
  const auto same = [](const Use& a, const Use& b) { return a.extent == b.extent; };
  for (auto first = uses.begin(); first != uses.end();) {
    const auto last = std::find_if(first, uses.end(), [&](const Use& one) { return !same(one, *first); });
    SharedWord word{first->extent, {}};
    for (auto one = first; one != last; ++one)
      if (std::ranges::count(word.symbols, one->symbol) == 0) word.symbols.push_back(one->symbol);
    if (word.symbols.size() > 1) index_.shared_words_.push_back(std::move(word));
    first = last;
  }
  uses.erase(std::unique(uses.begin(), uses.end(), same), uses.end());
}

}  // namespace tessera::language
