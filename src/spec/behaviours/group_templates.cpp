#include "spec/behaviours/group_templates.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/behaviours/groups.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

/// Uses of templates in a specification, each counted wherever the template that it is in is used.
constexpr std::size_t most_expansions = 20'000;

using diagnostics::in_quotes;

/// Words of conditions, of `next` and of units, which a template cannot take as names.
constexpr std::array words_with_meaning = std::to_array<std::string_view>(
    {"in",    "out",   "memory", "parameters", "elapsed", "index", "i",     "error", "end",  "until", "true",
     "false", "fresh", "valid",  "any",        "all",     "count", "which", "to",    "when", "h",     "min",
     "s",     "ms",    "us",     "ns",         "and",     "or",    "not",   "skip",  "with", "use"});

const Entry* key_in(const Node& map, std::string_view key) {
  const auto found = std::ranges::find(map.entries, key, &Entry::key);
  return found == map.entries.end() ? nullptr : &*found;
}

bool is_letter_of_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Whether it may stand for a name: names with dots and indices, and numbers with units.
bool is_plain_text(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return is_letter_of_word(c) || c == '.' || c == '[' || c == ']' || c == ' ' || c == '/';
  });
}

/// All names of behaviours in a template, also in groups in it.
void collect_behaviours(const Node& group, std::set<std::string>& names) {
  const Entry* behaviours = key_in(group, "behaviours");
  if (behaviours == nullptr || !behaviours->value->is_map()) return;
  for (const Entry& one : behaviours->value->entries) {
    names.insert(one.key);
    collect_behaviours(*one.value, names);
  }
}

/// names: that a template takes.
Hint hint_of(const std::string& name, const std::vector<std::string>& names) {
  Hint hint = did_you_mean(name, names);
  if (!hint.empty()) return hint;
  std::string all;
  for (const std::string& one : names) all += (all.empty() ? "it takes " : ", ") + one;
  return all.empty() ? Hint("it takes nothing: leave out 'with'") : Hint(all);
}

/// The names that a template takes.
std::vector<const Node*> taken_by(const Entry& from, Diagnostics& out) {
  const Entry* with = key_in(*from.value, "with");
  if (with == nullptr) return {};
  std::vector<const Node*> names;
  std::set<std::string> behaviours, seen;
  collect_behaviours(*from.value, behaviours);
  for (const Node* name : items_of(*with->value, with->span, "'with' of a template", out)) {
    const char* wrong = nullptr;
    if (!name->is_scalar() || !is_identifier(name->text))
      wrong = "is no name that a template can take";
    else if (std::ranges::find(words_with_meaning, name->text) != words_with_meaning.end() ||
             is_keyword(name->text))
      wrong = "means something in a specification already";
    else if (behaviours.contains(name->text))
      wrong = "is a behaviour of the template already";
    else if (!seen.insert(name->text).second)
      wrong = "is taken twice";
    if (wrong != nullptr)
      out.error("E354", name->is_scalar() ? name->span : with->span, in_quotes(name->text) + " " + wrong,
                "write a name that only stands for something else, such as with: [request]");
    else
      names.push_back(name);
  }
  return names;
}

/// Checks the keys beside the use of a template.
void check_keys(const Entry& from, Diagnostics& out) {
  for (const Entry& key : from.value->entries)
    if (key.key == "next" || key.key == "use")
      out.error("E352", key.span, in_quotes(key.key) + " does not belong in a template of a group",
                key.key == "next" ? "it leads out of the group: write it beside 'use: " + from.key + "'"
                                  : "use another template in one of its 'behaviours'");
}

}  // namespace

GroupTemplates::GroupTemplates(const Entry* templates) {
  if (templates == nullptr || !templates->value->is_map()) return;
  for (const Entry& entry : templates->value->entries)
    if (is_group(entry)) by_name_.emplace(entry.key, Template{&entry});
}

bool GroupTemplates::is_group(const Entry& entry) {
  return entry.value->is_map() && key_in(*entry.value, "behaviours") != nullptr &&
         key_in(*entry.value, "control") == nullptr;
}

const std::vector<Entry>& GroupTemplates::expanded(const std::vector<Entry>& entries, Diagnostics& out) {
  std::vector<std::string> chain;
  replacements_.clear();
  return lists_.emplace_back(expand(entries, chain, out));
}

std::vector<Entry> GroupTemplates::expand(const std::vector<Entry>& entries, std::vector<std::string>& chain,
                                          Diagnostics& out) {
  std::vector<Entry> all = entries;
  for (Entry& entry : all) {
    if (!entry.value->is_map()) continue;
    if (const Entry* use = key_in(*entry.value, "use")) {
      const Node* group = group_of(entry, *use, chain, out);
      if (group == nullptr)
        group = map_of(*entry.value, {});  // an error was found; nothing more is said about it
      entry.value = group;
    } else if (const Entry* inside = key_in(*entry.value, "behaviours");
               inside != nullptr && inside->value->is_map()) {
      std::vector<Entry> keys = entry.value->entries;
      for (Entry& key : keys)
        if (key.key == "behaviours") key.value = map_of(*key.value, expand(key.value->entries, chain, out));
      entry.value = map_of(*entry.value, std::move(keys));
    }
  }
  return all;
}

const Node* GroupTemplates::group_of(const Entry& behaviour, const Entry& use,
                                     std::vector<std::string>& chain, Diagnostics& out) {
  const Node* name = text_of(*use.value, use.span, "use", out, "name a template of a group");
  if (name == nullptr) return nullptr;
  const auto known = by_name_.find(name->text);
  if (known == by_name_.end()) {
    one_is_unknown_ = true;
    std::vector<std::string> names;
    for (const auto& [one, what] : by_name_) names.push_back(one);
    Hint hint = did_you_mean(name->text, names);
    if (hint.empty())
      hint = "a template of a group stands under 'templates' and has 'behaviours': " + name->text +
             ": { behaviours: { run: { terminal: true } } }";
    out.error("E351", name->span, "there is no template " + in_quotes(name->text) + " of a group",
              std::move(hint));
    return nullptr;
  }
  Template& from = known->second;
  from.used = true;
  if (std::ranges::find(chain, name->text) != chain.end()) {
    std::string circle;
    for (const std::string& one : chain) circle += one + " -> ";
    out.error("E353", name->span, "templates use each other in a circle: " + circle + name->text,
              "one of them must have behaviours of its own in this place");
    return nullptr;
  }
  if (chain.size() >= most_nested_groups || ++expansions_ > most_expansions) {
    if (expansions_ <= most_expansions + 1)
      out.error("E341", name->span, "templates of groups use each other too deep, or too often",
                "let the subsystem name the behaviours in a template of fewer levels");
    return nullptr;
  }
  for (const Entry& key : behaviour.value->entries)
    if (key.key == "behaviours")
      out.error("E352", key.span, in_quotes(behaviour.key) + " has 'use' and 'behaviours'",
                "write the behaviours in template " + name->text + ", or leave out 'use'");
  check_keys(*from.entry, out);
  const std::size_t errors = out.error_count();
  const Texts texts = texts_for(behaviour, from, out);
  if (out.error_count() > errors) return nullptr;
  chain.push_back(name->text);
  const Node* body = body_of(behaviour, from, texts, chain, out);
  chain.pop_back();
  return body;
}

const Node* GroupTemplates::body_of(const Entry& behaviour, const Template& from, const Texts& texts,
                                    std::vector<std::string>& chain, Diagnostics& out) {
  const std::string& name = from.entry->key;
  Replacing replacing{name, texts};
  // The keys beside `use` replace those of the template.
  std::vector<Entry> keys;
  for (const Entry& key : behaviour.value->entries)
    if (key.key != "use" && key.key != "with" && key.key != "behaviours") keys.push_back(key);
  for (const Entry& key : from.entry->value->entries) {
    if (key.key == "with" || key.key == "next" || key.key == "use") continue;
    const Node* value = replaced(*key.value, replacing);
    if (std::ranges::find(keys, key.key, &Entry::key) != keys.end()) continue;
    keys.push_back({key.key, key.span, value});
  }
  for (const Node* taken : taken_by(*from.entry, out))
    if (texts.contains(taken->text) && !replacing.found.contains(taken->text))
      out.error("E354", taken->span,
                "nothing in template " + in_quotes(name) + " names " + in_quotes(taken->text),
                "leave it out, or name it: in." + taken->text + ", or send: [" + taken->text + "]");
  for (Entry& key : keys)
    if (key.key == "behaviours" && key.value->is_map())
      key.value = map_of(*key.value, expand(key.value->entries, chain, out));
  return map_of(*behaviour.value, std::move(keys));
}

GroupTemplates::Texts GroupTemplates::texts_for(const Entry& behaviour, const Template& from,
                                                Diagnostics& out) const {
  Texts texts;
  const std::vector<const Node*> taken = taken_by(*from.entry, out);
  const Entry* with = key_in(*behaviour.value, "with");
  std::vector<std::string> names;
  for (const Node* name : taken) names.push_back(name->text);
  if (with != nullptr)
    for (const Entry& one : entries_of(*with->value, with->span, "with", out)) {
      if (std::ranges::find(names, one.key) == names.end())
        out.error("E355", one.span,
                  "template " + in_quotes(from.entry->key) + " takes no " + in_quotes(one.key),
                  hint_of(one.key, names));
      else if (!one.value->is_scalar() || !is_plain_text(one.value->text))
        out.error("E355", one.value->is_scalar() ? one.value->span : one.span,
                  in_quotes(one.key) + " stands for a name or a number",
                  "for example " + one.key + ": request_left, parameters.lease or 20 s");
      else if (const auto before = given_before_.find(one.value); before != given_before_.end())
        texts.emplace(one.key, before->second);
      else
        texts.emplace(one.key, Given{one.value->text, one.value->span, one.value->verbatim});
    }
  for (const std::string& name : names)
    if (with == nullptr || key_in(*with->value, name) == nullptr)
      out.error(
          "E355", (with != nullptr ? *with : behaviour).span,
          "template " + in_quotes(from.entry->key) + " takes " + in_quotes(name) + ", which is not given",
          "add it to 'with': with: { " + name + ": NAME }");
  return texts;
}

std::string GroupTemplates::replaced(const std::string& text, Span at, Replacing& with) {
  return with_texts(text, [&](const std::string& word) -> const std::string* {
    const auto given = with.texts.find(word);
    if (given == with.texts.end()) return nullptr;
    with.found.insert(word);
    if (given->second.at.line > 0) replacements_.push_back({at, word, with.name, given->second});
    return &given->second.text;
  });
}

const Node* GroupTemplates::replaced(const Node& node, Replacing& with, bool gives) {
  if (with.texts.empty()) return &node;
  Node made = node;
  if (node.is_scalar()) {
    made.text = replaced(node.text, node.span, with);
    const auto whole = with.texts.find(node.text);
    if (made.text == node.text && whole == with.texts.end()) return &node;
    made.verbatim = false;
    const Node& placed = nodes_.emplace_back(std::move(made));
    if (whole != with.texts.end()) given_before_.emplace(&placed, whole->second);
    return &placed;
  }
  for (Entry& entry : made.entries) {
    if (!gives) entry.key = replaced(entry.key, entry.span, with);
    entry.value = replaced(*entry.value, with, entry.key == "with");
  }
  for (const Node*& item : made.items) item = replaced(*item, with);
  return &nodes_.emplace_back(std::move(made));
}

const Node* GroupTemplates::map_of(const Node& at, std::vector<Entry> entries) {
  Node made;
  made.kind = Node::Kind::map;
  made.span = at.span;
  made.entries = std::move(entries);
  return &nodes_.emplace_back(std::move(made));
}

std::vector<Entry> GroupTemplates::unused(Diagnostics& out) {
  std::vector<const Template*> all;
  replacements_.clear();
  for (const auto& [name, one] : by_name_)
    if (!one.used) all.push_back(&one);
  std::vector<Entry> groups;
  for (const Template* one : all) {
    const Entry& entry = *one->entry;
    // An unknown name may mean this template. A file that several specifications include may have more than one of
    // them needs.
    if (!one_is_unknown_ && out.sources().own_line(entry.span.line) > 0)
      out.warning("W319", entry.span, "template " + in_quotes(entry.key) + " is used by no behaviour",
                  "write use: " + entry.key + " in a behaviour, or leave the template out");
    check_keys(entry, out);
    Texts texts;
    for (const Node* name : taken_by(entry, out)) texts.emplace(name->text, Given{name->text, name->span});
    std::vector<std::string> chain{entry.key};
    groups.push_back({entry.key, entry.span,
                      body_of({entry.key, entry.span, map_of(*entry.value, {})}, *one, texts, chain, out)});
  }
  return groups;
}

}  // namespace tessera::spec
