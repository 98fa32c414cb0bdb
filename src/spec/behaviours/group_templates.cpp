#include "spec/behaviours/group_templates.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

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

/// Whether the word that begins at `at` is a name of its own, or the first one behind in., out., memory. and
/// parameters.
bool stands_alone(std::string_view text, std::size_t at) {
  if (at == 0 || text[at - 1] != '.') return true;
  const std::string_view before = text.substr(0, at - 1);
  for (const std::string_view root : {"in", "out", "memory", "parameters"})
    if (before.ends_with(root)) {
      const std::size_t begin = before.size() - root.size();
      if (begin == 0 || (!is_letter_of_word(before[begin - 1]) && before[begin - 1] != '.')) return true;
    }
  return false;
}

/// A text with the names of a template replaced, but not within quotes.
std::string with_texts(std::string_view text, const std::map<std::string, std::string>& texts,
                       std::set<std::string>& found) {
  std::string made;
  bool quoted = false;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '"') quoted = !quoted;
    if (quoted || !is_letter_of_word(text[at])) {
      made += text[at++];
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && is_letter_of_word(text[end])) ++end;
    const std::string word(text.substr(at, end - at));
    const auto stands = texts.find(word);
    const bool replaced = stands != texts.end() && stands_alone(text, at);
    if (replaced) found.insert(word);
    made += replaced ? stands->second : word;
    at = end;
  }
  return made;
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
  for (const Entry& key : behaviour.value->entries)
    if (key.key == "behaviours")
      out.error("E352", key.span, in_quotes(behaviour.key) + " has 'use' and 'behaviours'",
                "write the behaviours in template " + name->text + ", or leave out 'use'");
  for (const Entry& key : from.entry->value->entries)
    if (key.key == "next" || key.key == "use")
      out.error("E352", key.span, in_quotes(key.key) + " does not belong in a template of a group",
                key.key == "next" ? "it leads out of the group: write it beside 'use: " + name->text + "'"
                                  : "use another template in one of its 'behaviours'");
  const std::size_t errors = out.error_count();
  const Texts texts = texts_for(behaviour, from, out);
  if (out.error_count() > errors) return nullptr;
  std::set<std::string> found;
  // The keys beside `use` replace those of the template.
  std::vector<Entry> keys;
  for (const Entry& key : behaviour.value->entries)
    if (key.key != "use" && key.key != "with" && key.key != "behaviours") keys.push_back(key);
  for (const Entry& key : from.entry->value->entries) {
    if (key.key == "with" || key.key == "next" || key.key == "use") continue;
    const Node* value = replaced(*key.value, texts, found);
    if (std::ranges::find(keys, key.key, &Entry::key) != keys.end()) continue;
    keys.push_back({key.key, key.span, value});
  }
  for (const Node* taken : taken_by(*from.entry, out))
    if (texts.contains(taken->text) && !found.contains(taken->text))
      out.error("E354", taken->span,
                "nothing in template " + in_quotes(name->text) + " names " + in_quotes(taken->text),
                "leave it out, or name it: in." + taken->text + ", or send: [" + taken->text + "]");
  chain.push_back(name->text);
  for (Entry& key : keys)
    if (key.key == "behaviours" && key.value->is_map())
      key.value = map_of(*key.value, expand(key.value->entries, chain, out));
  chain.pop_back();
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
      else
        texts.emplace(one.key, one.value->text);
    }
  for (const std::string& name : names)
    if (with == nullptr || key_in(*with->value, name) == nullptr)
      out.error(
          "E355", (with != nullptr ? *with : behaviour).span,
          "template " + in_quotes(from.entry->key) + " takes " + in_quotes(name) + ", which is not given",
          "add it to 'with': with: { " + name + ": NAME }");
  return texts;
}

const Node* GroupTemplates::replaced(const Node& node, const Texts& texts, std::set<std::string>& found,
                                     bool gives) {
  if (texts.empty()) return &node;
  Node made = node;
  if (node.is_scalar()) {
    made.text = with_texts(node.text, texts, found);
    if (made.text == node.text) return &node;
    made.verbatim = false;
  }
  for (Entry& entry : made.entries) {
    if (!gives) entry.key = with_texts(entry.key, texts, found);
    entry.value = replaced(*entry.value, texts, found, entry.key == "with");
  }
  for (const Node*& item : made.items) item = replaced(*item, texts, found);
  return &nodes_.emplace_back(std::move(made));
}

const Node* GroupTemplates::map_of(const Node& at, std::vector<Entry> entries) {
  Node made;
  made.kind = Node::Kind::map;
  made.span = at.span;
  made.entries = std::move(entries);
  return &nodes_.emplace_back(std::move(made));
}

void GroupTemplates::complain_about_unused(Diagnostics& out) const {
  if (one_is_unknown_) return;  // the unknown name may mean this template
  // A file that several specifications include may have more than one of them needs.
  for (const auto& [name, one] : by_name_)
    if (!one.used && out.sources().own_line(one.entry->span.line) > 0)
      out.warning("W319", one.entry->span, "template " + in_quotes(name) + " is used by no behaviour",
                  "write use: " + name + " in a behaviour, or leave the template out");
}

}  // namespace tessera::spec
