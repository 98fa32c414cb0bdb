// Copies of elements, within a specification and from another one.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "language/edits/elements.hpp"
#include "language/edits/entry_lines.hpp"

namespace tessera::language {
namespace {

constexpr const char* one_line = "it stands in one line with others: copy it in the text";

struct Replacement {
  Extent of;
  std::string by;
};

/// A part of a text after replacements in it.
std::string replaced(const std::string& text, Extent part, std::vector<Replacement> replacements) {
  std::ranges::sort(replacements, {}, [](const Replacement& one) { return one.of.begin; });
  std::string all;
  std::size_t at = part.begin;
  for (const auto& [of, by] : replacements) {
    if (of.begin < at || of.end > part.end) continue;
    all.append(text, at, of.begin - at).append(by);
    at = of.end;
  }
  return all.append(text, at, part.end - at);
}

bool is_in(const Extent& part, const Extent& whole) {
  return whole.begin <= part.begin && part.end <= whole.end;
}

/// New names for the anchors of a part, here and at the aliases in the part: a second anchor of a name would take over
/// the aliases behind it.
void rename_anchors(const std::vector<Anchor>& anchors, std::set<std::string> taken, Extent part,
                    std::vector<Replacement>& replacements) {
  std::map<std::string, std::string> names;
  for (const Anchor& one : anchors) {
    if (one.at < part.begin || one.at >= part.end) continue;
    if (!one.is_alias && taken.contains(one.name)) {
      std::string fresh;
      for (int number = 2; fresh.empty() || taken.contains(fresh); ++number)
        fresh = fmt::format("{}_{}", one.name, number);
      taken.insert(fresh);
      names[one.name] = fresh;
    }
    if (const auto found = names.find(one.name); found != names.end())
      replacements.push_back({{one.at + 1, one.at + 1 + one.name.size()}, found->second});
  }
}

constexpr const char* no_name = "a name has letters, digits and single underscores, and begins with a letter";

bool is_name(std::string_view text) {
  const auto is_letter = [](char one) { return (one >= 'a' && one <= 'z') || (one >= 'A' && one <= 'Z'); };
  return !text.empty() && is_letter(text.front()) && std::ranges::all_of(text, [&](char one) {
    return is_letter(one) || (one >= '0' && one <= '9') || one == '_';
  });
}

std::set<std::string> names_of(const std::vector<Anchor>& anchors) {
  std::set<std::string> names;
  for (const Anchor& one : anchors)
    if (!one.is_alias) names.insert(one.name);
  return names;
}

/// The channels of which both ends are in an agent, as items for its copy.
std::vector<std::string> own_channels(const Document& document, const TextEditor& editor, SymbolId agent,
                                      const std::string& name) {
  const Node* list = editor.list({"channels"});
  std::vector<std::string> channels;
  for (std::size_t at = 0; list != nullptr && at < list->items.size(); ++at) {
    const Entry& item = list->items[at];
    std::vector<Replacement> ends;
    for (const Use& use : document.index().uses())
      if (use.symbol == agent && !use.defines && is_in(use.extent, item.written))
        ends.push_back({use.extent, name});
    if (ends.size() == 2 && !item.is_alias)
      channels.push_back(replaced(editor.text(), item.written, std::move(ends)));
  }
  return channels;
}

}  // namespace

std::optional<std::string> copy_element(const Document& document, TextEditor& editor, const Path& at,
                                        const std::string& name) {
  const Entry* entry = editor.entry(at);
  if (entry == nullptr || key_of(at.back()) == nullptr)
    return "the text has changed: there is nothing of that name to copy here any more";
  if (!is_name(name)) return no_name;
  const Path above = without_last(at);
  const Node* map = editor.map(above);
  if (map->find(name) != nullptr) return fmt::format("'{}' is there already", name);
  const Use* defined = document.index().defined_at(entry->extent.begin);
  std::vector<std::string> channels;
  std::vector<Replacement> replacements{{entry->extent, name}};
  if (defined != nullptr) {
    const SymbolId symbol = defined->symbol;
    for (const Use& use : document.index().uses())
      if (use.symbol == symbol && !use.defines) replacements.push_back({use.extent, name});
    if (document.index()[symbol].kind == Kind::agent) channels = own_channels(document, editor, symbol, name);
  }
  const bool in_lines = !map->flow;
  const Extent part = in_lines ? lines_of(editor, *entry) : entry->whole;
  // The first entry of an item of a list stands behind the dash.
  if (in_lines && start_of_line(editor.text(), entry->whole.begin) + map->column != entry->whole.begin)
    return one_line;
  const std::vector<Anchor>& anchors = document.outline().anchors();
  rename_anchors(anchors, names_of(anchors), part, replacements);
  std::string copy = replaced(editor.text(), part, std::move(replacements));
  if (!in_lines)
    copy.insert(0, ", ");
  else if (!copy.ends_with('\n'))
    copy.insert(0, editor.text().find("\r\n") == std::string::npos ? "\n" : "\r\n");
  editor.change({part.end, part.end}, copy);
  for (const std::string& channel : channels)
    if (!editor.append({"channels"}, channel)) return "the list of channels is written elsewhere";
  return std::nullopt;
}

std::optional<std::string> paste_element(TextEditor& editor, const Path& map, const std::string& name,
                                         const std::string& from) {
  if (!is_name(name)) return no_name;
  const std::string new_line = editor.text().find("\r\n") == std::string::npos ? "\n" : "\r\n";
  std::string text;
  for (const char one : from)
    if (one == '\n')
      text += new_line;
    else if (one != '\r')
      text += one;
  const TextEditor given(text);
  const Node* root = given.map({});
  if (root == nullptr || root->entries.size() != 1 || root->entries.front().written.empty())
    return "what is pasted is no element of a specification";
  const Entry& entry = root->entries.front();
  std::set<std::string> known;
  for (const Anchor& one : given.outline().anchors()) {
    if (one.is_alias && !known.contains(one.name))
      return fmt::format("it uses *{}, which stands elsewhere in the text that it comes from", one.name);
    known.insert(one.name);
  }
  const bool flow = root->flow;
  const Extent part = flow ? entry.whole : lines_of(given, entry);
  std::vector<Replacement> replacements{{entry.extent, name}};
  rename_anchors(given.outline().anchors(), names_of(editor.outline().anchors()), part, replacements);
  std::string lines = replaced(text, part, std::move(replacements));
  const Node* into = editor.map(map);
  const bool is_new = into == nullptr || into->entries.empty();
  if (is_new && !editor.insert(map, name, Value::scalar("here")))
    return "the place has changed: nothing can be pasted there";
  into = editor.map(map);
  if (into == nullptr) return "the place has changed: nothing can be pasted there";
  const Extent last = into->entries.back().whole;
  if (into->flow) {
    lines.erase(lines.find_last_not_of(" \r\n") + 1);
    if (lines.find('\n') != std::string::npos || lines.find('#') != std::string::npos) return one_line;
    return is_new ? (editor.change(last, lines), std::nullopt)
                  : (editor.change({last.end, last.end}, ", " + lines), std::nullopt);
  }
  if (!lines.ends_with('\n')) lines += new_line;
  lines = moved_to_column(lines, flow ? 0 : given.column_of(entry.whole.begin), into->column);
  const std::size_t end = end_of_line(editor.text(), last.end);
  if (is_new) {
    editor.change({start_of_line(editor.text(), last.begin), end}, lines);
    return std::nullopt;
  }
  if (end > 0 && editor.text()[end - 1] != '\n') lines.insert(0, new_line);
  editor.change({end, end}, lines);
  return std::nullopt;
}

}  // namespace tessera::language
