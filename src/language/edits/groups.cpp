// Moves of behaviours between groups.

#include <fmt/format.h>

#include <algorithm>

#include "language/edits/elements.hpp"
#include "language/edits/entry_lines.hpp"

namespace tessera::language {
namespace {

constexpr const char* in_one_line = "it stands in one line with others: move it in the text";

/// The subsystem that a behaviour is in; empty: the path leads to no behaviour.
Path unit_of(const Path& behaviour) {
  const auto is_list = [](const Step& step) {
    return key_of(step) != nullptr && *key_of(step) == "behaviours";
  };
  // agents, robot, control or receptors, NAME
  const auto first = std::find_if(behaviour.begin() + std::min<std::ptrdiff_t>(3, std::ssize(behaviour)),
                                  behaviour.end(), is_list);
  return first == behaviour.end() ? Path{} : Path(behaviour.begin(), first);
}

/// "charge.dock" as a path behind the subsystem, to its `behaviours`.
Path list_of(Path unit, const std::string& group) {
  for (std::size_t at = 0; !group.empty() && at <= group.size();) {
    const std::size_t end = std::min(group.find('.', at), group.size());
    unit = unit / "behaviours" / group.substr(at, end - at);
    at = end + 1;
  }
  return unit / "behaviours";
}

bool is_inside(const Path& path, const Path& of) {
  return path.size() >= of.size() && std::equal(of.begin(), of.end(), path.begin());
}

}  // namespace

std::optional<std::string> move_to_group(TextEditor& editor, const Path& behaviour,
                                         const std::string& group) {
  const Path unit = unit_of(behaviour);
  const Path list = list_of(unit, group), old = without_last(behaviour);
  const Entry* entry = editor.entry(behaviour);
  const Node *from = editor.map(old), *into = editor.map(list);
  if (unit.empty() || entry == nullptr || from == nullptr || into == nullptr || into->entries.empty())
    return "the text has changed: there is no such behaviour or group any more";
  if (is_inside(list, behaviour)) return "a group cannot stand in itself";
  if (list == old) return std::nullopt;
  const std::string name = entry->key;
  if (into->find(name) != nullptr) return fmt::format("'{}' is taken there", name);
  if (from->entries.size() == 1)
    return fmt::format("'{}' is all that the group has; remove the group, or move the others in the text",
                       name);
  const bool in_lines = !from->flow;
  if (into->flow && (in_lines || entry->written.empty())) return in_one_line;
  const std::string whole = editor.text().substr(entry->whole.begin, entry->whole.end - entry->whole.begin);
  if (into->flow) {
    if (whole.find('\n') != std::string::npos) return in_one_line;
    if (!editor.remove(behaviour)) return in_one_line;
    const std::size_t end = editor.map(list)->entries.back().whole.end;
    editor.change({end, end}, ", " + whole);
    return std::nullopt;
  }
  const std::string new_line = editor.text().find("\r\n") == std::string::npos ? "\n" : "\r\n";
  std::string lines = whole + new_line;
  std::size_t column = 0;
  if (in_lines) {
    const Extent extent = lines_of(editor, *entry);
    column = editor.column_of(entry->whole.begin);
    lines = editor.text().substr(extent.begin, extent.end - extent.begin);
    if (!lines.ends_with('\n')) lines += new_line;
    editor.change(extent, "");
  } else if (whole.find('\n') != std::string::npos || !editor.remove(behaviour)) {
    return in_one_line;
  }
  into = editor.map(list);
  const std::size_t to = editor.column_of(into->entries.front().whole.begin);
  std::size_t end = end_of_line(editor.text(), into->entries.back().whole.end);
  std::string added = moved_to_column(lines, column, to);
  if (end > 0 && editor.text()[end - 1] != '\n') added.insert(0, new_line);
  editor.change({end, end}, added);
  return std::nullopt;
}

}  // namespace tessera::language
