// Templates of groups: a group that uses one has its behaviours, and the text of a template means something in each
// subsystem that uses it.

#include <algorithm>
#include <iterator>
#include <utility>

#include "language/names/index_builder.hpp"
#include "spec/behaviours/groups.hpp"
#include "spec/behaviours/replacements.hpp"

namespace tessera::language {
namespace {

/// More uses of templates in one another than a specification has: the text is one that is being typed.
constexpr std::size_t most_expansions = 20'000;

}  // namespace

void IndexBuilder::define_group_template(const Entry& entry, SymbolId id) {
  index_.symbols_[id].is_group = true;
  GroupTemplateNames made;
  made.unit.symbol = id;
  made.unit.name = entry.key;
  made.unit.way = {"templates", entry.key};
  const Node& body = *entry.value;
  for (const Entry& name : body["with"].items) {
    const Node& text = *name.value;
    if (!text.is_scalar() || !text.verbatim || text.text.empty() || made.taken.contains(text.text)) continue;
    const Entry named{.key = text.text, .extent = text.extent, .value = &text};
    made.taken.emplace(text.text,
                       define(Kind::taken, named, id, {"templates", entry.key, "with"}, entry.key));
  }
  in_template_ = true;
  define_behaviours(made.unit, body["behaviours"], {});
  in_template_ = false;
  made.unit.functions.clear();
  index_.group_templates_.push_back(std::move(made));
}

// ------------------------------------------------------------------------------ what a group has from its template

void IndexBuilder::link_all() {
  for (GroupTemplateNames& one : index_.group_templates_) {
    link_templates(one.unit, root_["templates"][one.unit.name]["behaviours"], {});
    one.unit.functions.clear();
  }
  std::size_t at = 0;
  for (DefinitionNames& definition : index_.definitions_)
    for (UnitNames& unit : definition.units) link_templates(unit, (*nodes_[at++])["behaviours"], {});
}

void IndexBuilder::link_templates(UnitNames& unit, const Node& map, const std::vector<SymbolId>& inside) {
  if (inside.size() > spec::most_nested_groups) return;
  const NamesOf names = unit.behaviours_in(inside.empty() ? SymbolId{} : inside.back());
  for (const Entry& entry : map.entries) {
    const auto found = names.find(entry.key);
    if (found == names.end()) continue;
    std::vector<SymbolId> path = inside;
    path.push_back(found->second);
    if (const Entry* use = entry.value->find("use")) {
      if (const GroupTemplateNames* from = index_.group_template(use->value->text))
        link_template(unit, *from, path);
    } else {
      link_templates(unit, (*entry.value)["behaviours"], path);
    }
  }
}

void IndexBuilder::link_template(UnitNames& unit, const GroupTemplateNames& from,
                                 const std::vector<SymbolId>& inside) {
  if (inside.size() > spec::most_nested_groups || std::ranges::count(open_templates_, from.unit.name) > 0 ||
      ++expansions_ > most_expansions)
    return;
  open_templates_.push_back(from.unit.name);
  link_group(unit, from.unit, {}, inside);
  open_templates_.pop_back();
}

void IndexBuilder::link_group(UnitNames& unit, const UnitNames& from, SymbolId group,
                              const std::vector<SymbolId>& inside) {
  const NamesOf names = from.behaviours_in(group);
  unit.groups[inside.back()] = names;
  std::string function;
  for (const SymbolId part : inside) function += index_.symbols_[part].name + "_";
  for (const auto& [name, id] : names) {
    std::vector<SymbolId> path = inside;
    path.push_back(id);
    if (const auto conditions = from.conditions.find(id); conditions != from.conditions.end())
      unit.conditions[id] = conditions->second;
    const auto use = used_templates_.find(id);
    const GroupTemplateNames* other =
        use == used_templates_.end() ? nullptr : index_.group_template(use->second);
    if (!index_.symbols_[id].is_group)
      unit.functions.emplace(function + name, std::move(path));
    else if (other != nullptr)
      link_template(unit, *other, path);
    else if (use == used_templates_.end() && path.size() <= spec::most_nested_groups)
      link_group(unit, from, id, path);
  }
}

// -------------------------------------------------------------------------------------------------- what it means

void IndexBuilder::use_in_templates() {
  expansions_ = 0;
  for (GroupTemplateNames& one : index_.group_templates_) {
    const Node& body = root_["templates"][one.unit.name];
    for (const Entry& key : body.entries)
      if (key.key != "with") use_taken(*key.value, one.taken, false);
    for (const char* key : {"start", "on_error"}) use(body[key], one.unit.behaviours);
    use_in_behaviours(one.unit, body["behaviours"], {}, 0);
  }
}

void IndexBuilder::use_taken(Extent extent, const NamesOf& taken) {
  for (const spec::WordAt& word : spec::replaceable_words(written(extent)))
    use({extent.begin + word.begin, extent.begin + word.begin + word.text.size()}, taken, word.text);
}

void IndexBuilder::use_taken(const Node& node, const NamesOf& taken, bool gives) {
  if (node.is_scalar()) use_taken(node.extent, taken);
  for (const Entry& entry : node.entries) {
    if (!gives) use_taken(entry.extent, taken);
    use_taken(*entry.value, taken, entry.key == "with");
  }
  for (const Entry& item : node.items) use_taken(*item.value, taken, false);
}

IndexBuilder::Givens IndexBuilder::givens_of(const Node& with) const {
  Givens all;
  for (const Entry& entry : with.entries) {
    const Node& value = *entry.value;
    if (!value.is_scalar()) continue;
    Given given{value.text, value.extent.begin, value.verbatim};
    if (givens_ != nullptr) {
      const auto around = givens_->find(value.text);
      if (around != givens_->end()) {
        given = around->second;
      } else {
        given.text = spec::with_texts(value.text, [&](const std::string& word) -> const std::string* {
          const auto found = givens_->find(word);
          return found == givens_->end() ? nullptr : &found->second.text;
        });
        given.is_written = given.is_written && given.text == value.text;
      }
    }
    all.emplace(entry.key, std::move(given));
  }
  return all;
}

void IndexBuilder::use_template(const UnitNames& unit, const Entry& behaviour, SymbolId group) {
  const Node& body = *behaviour.value;
  const std::string& name = body["use"].text;
  use(body["use"], index_.templates_);
  const GroupTemplateNames* from = index_.group_template(name);
  if (from == nullptr) return;
  for (const Entry& given : body["with"].entries) {
    const Givens* const around = std::exchange(givens_, nullptr);  // the keys are names of the other template
    use(given.extent, from->taken, given.key);
    givens_ = around;
  }
  if (open_templates_.size() > spec::most_nested_groups || std::ranges::count(open_templates_, name) > 0 ||
      ++expansions_ > most_expansions)
    return;
  auto& users = users_[name];
  if (std::ranges::count(users, &unit) == 0) users.push_back(&unit);
  const Givens givens = givens_of(body["with"]);
  const Givens* const around = std::exchange(givens_, &givens);
  std::set<const Node*> walked;
  std::swap(walked_, walked);
  open_templates_.push_back(name);
  const Node& written = root_["templates"][name];
  const NamesOf& inside = unit.behaviours_in(group);
  use(written["start"], inside);
  use(written["on_error"], inside);
  use_expression(unit, written["until"]);
  use_sets(unit, written["sets"]);
  use_in_behaviours(unit, written["behaviours"], group, 0);
  open_templates_.pop_back();
  std::swap(walked_, walked);
  givens_ = around;
}

std::vector<Token> IndexBuilder::words_of_expression(const Node& text) const {
  const std::string_view source = written(text.extent);
  std::vector<Token> tokens = tokens_of(source);
  for (Token& token : tokens) token.extent = moved(token.extent, text.extent.begin);
  if (givens_ == nullptr) return tokens;
  std::vector<Token> replaced;
  const std::vector<spec::WordAt> words = spec::replaceable_words(source);
  for (const Token& token : tokens) {
    const auto given = givens_->find(token.text);
    const bool stands = given != givens_->end() && std::ranges::any_of(words, [&](const spec::WordAt& word) {
                          return text.extent.begin + word.begin == token.extent.begin;
                        });
    if (!stands) {
      replaced.push_back(token);
      continue;
    }
    for (Token part : tokens_of(given->second.text)) {
      part.extent = given->second.is_written ? moved(part.extent, given->second.at) : Extent{};
      replaced.push_back(part);
    }
  }
  return replaced;
}

// ------------------------------------------------------------------------------------- what may stand in its text

void IndexBuilder::share_names() {
  const auto common = [](const std::vector<const UnitNames*>& users, NamesOf UnitNames::*names,
                         const NamesOf& taken) {
    NamesOf all = users.empty() ? NamesOf{} : users.front()->*names;
    for (const UnitNames* user : users)
      std::erase_if(all, [&](const auto& one) { return !(user->*names).contains(one.first); });
    all.insert(taken.begin(), taken.end());
    return all;
  };
  for (GroupTemplateNames& one : index_.group_templates_) {
    std::vector<const UnitNames*> users;
    for (const UnitNames* user : users_[one.unit.name])
      if (!index_.symbols_[user->symbol].is_group) users.push_back(user);  // not another template
    if (!users.empty()) one.unit.role = users.front()->role;
    for (NamesOf UnitNames::*names :
         {&UnitNames::inputs, &UnitNames::outputs, &UnitNames::memory, &UnitNames::parameters})
      one.unit.*names = common(users, names, one.taken);
    for (NamesOf UnitNames::*names : {&UnitNames::real, &UnitNames::shared})
      one.unit.*names = common(users, names, {});
    if (users.size() == 1) one.unit.values = users.front()->values;
  }
}

}  // namespace tessera::language
