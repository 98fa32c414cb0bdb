#include "language/edits/text_editor.hpp"

#include <algorithm>
#include <set>

namespace tessera::language {
namespace {

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

}  // namespace

Path operator/(Path path, Step step) {
  path.push_back(std::move(step));
  return path;
}
Path without_last(Path path) {
  path.pop_back();
  return path;
}
const std::string* key_of(const Step& step) { return std::get_if<std::string>(&step); }

// ------------------------------------------------------------------------------------------------ finding

std::optional<TextEditor::Place> TextEditor::find(const Path& path) const {
  const Node* node = &outline_.root();
  std::optional<Place> place;
  for (const Step& step : path) {
    if (place && place->entry().is_alias) return std::nullopt;
    const std::string* key = key_of(step);
    const std::vector<Entry>& parts = key != nullptr ? node->entries : node->items;
    const std::size_t at =
        key != nullptr ? static_cast<std::size_t>(std::ranges::find(parts, *key, &Entry::key) - parts.begin())
                       : std::get<std::size_t>(step);
    if (at >= parts.size()) return std::nullopt;
    place = Place{node, at};
    node = place->entry().value;
  }
  return place;
}

const Entry* TextEditor::entry(const Path& path) const {
  const std::optional<Place> place = find(path);
  return place ? &place->entry() : nullptr;
}

const Node* TextEditor::node(const Path& path) const {
  if (path.empty()) return &outline_.root();
  const Entry* found = entry(path);
  return found != nullptr && !found->is_alias ? found->value : nullptr;
}

const Node* TextEditor::map(const Path& path) const {
  const Node* found = node(path);
  return found != nullptr && found->is_map() ? found : nullptr;
}

const Node* TextEditor::list(const Path& path) const {
  const Node* found = node(path);
  return found != nullptr && found->is_sequence() ? found : nullptr;
}

std::vector<std::string> TextEditor::keys(const Path& path) const {
  std::vector<std::string> all;
  if (const Node* found = map(path))
    for (const Entry& entry : found->entries) all.push_back(entry.key);
  return all;
}

std::string TextEditor::value_text(const Path& path) const {
  if (const Node* found = node(path); found != nullptr && found->is_scalar()) return found->text;
  const Entry* found = entry(path);
  return found == nullptr ? ""
                          : text_.substr(found->written.begin, found->written.end - found->written.begin);
}

std::optional<Anchor> TextEditor::lost_alias() const {
  std::set<std::string> known;
  for (const Anchor& one : outline_.anchors()) {
    if (!one.is_alias)
      known.insert(one.name);
    else if (!known.contains(one.name))
      return one;
  }
  return std::nullopt;
}

std::size_t TextEditor::line_start(std::size_t offset) const {
  const std::size_t end = offset == 0 ? std::string::npos : text_.rfind('\n', offset - 1);
  return end == std::string::npos ? 0 : end + 1;
}

bool TextEditor::begins_line(std::size_t offset) const {
  return is_blank(std::string_view(text_).substr(line_start(offset), column_of(offset)));
}

std::string_view TextEditor::new_line() const {
  return text_.find("\r\n") == std::string::npos ? "\n" : "\r\n";
}

// ------------------------------------------------------------------------------------------------ changing

bool TextEditor::change(Extent extent, std::string_view text) {
  text_.replace(extent.begin, extent.end - extent.begin, text);
  outline_ = Outline(text_);
  return true;
}

/// Puts a value in the place of another one. A value within a flow is a flow.
bool TextEditor::put(const Place& place, const Value& value) {
  const Entry& now = place.entry();
  const bool in_lines = value.kind != Value::Kind::text && place.parent->is_map() && !place.parent->flow;
  if (!in_lines && !now.written.empty()) return change(now.written, flow_text(value));
  const std::string text =
      in_lines ? block_text(value, column_of(now.whole.begin) + 2, new_line()) : " " + flow_text(value);
  return change({now.behind, now.written.end}, (now.complete ? "" : ":") + text);
}

/// Adds the one part of a map or list to the map or list at `path`.
bool TextEditor::add(const Path& path, const Value& one) {
  const Node* into = one.kind == Value::Kind::map ? map(path) : list(path);
  if (into != nullptr && !into->parts().empty()) {
    const std::size_t end = into->parts().back().whole.end;
    if (into->flow) return change({end, end}, ", " + flow_parts(one));
    const std::size_t line_end = std::min(text_.find_first_of("\r\n", end), text_.size());
    std::string lines = block_text(one, column_of(into->parts().front().whole.begin), new_line());
    if (line_end == text_.size()) lines += new_line();
    return change({line_end, line_end}, lines);
  }
  if (path.empty()) return add_at_end(one);
  if (const std::optional<Place> place = find(path))
    // A new part in place of the alias would drop all that it stands for.
    return !place->entry().is_alias && put(*place, one);
  const std::string* key = key_of(path.back());
  if (key == nullptr) return false;
  const Value whole = Value::map(scalar_text(*key), one);
  // A list at the top stands apart.
  const bool apart = path.size() == 1 && one.kind == Value::Kind::list && !outline_.root().flow;
  return apart ? add_at_end(whole) : add(without_last(path), whole);
}

/// Adds an entry behind all others of the text. A text that is no map stays as it is.
bool TextEditor::add_at_end(const Value& one) {
  const Node& root = outline_.root();
  if (root.flow && root.is_map()) return change(root.extent, flow_text(one));
  if (one.kind != Value::Kind::map || (root.kind != Node::Kind::null && !root.is_map())) return false;
  std::string lines = block_text(one, 0, new_line());
  const bool apart = root.is_map();
  if (apart && !text_.ends_with('\n')) lines.insert(0, new_line());
  if (!apart && (text_.empty() || text_.ends_with('\n'))) lines.erase(0, new_line().size());
  return change({text_.size(), text_.size()}, lines.append(new_line()));
}

bool TextEditor::insert(const Path& path, const std::string& key, const Value& value) {
  return add(path, Value::map(scalar_text(key), value));
}

bool TextEditor::append(const Path& path, const std::string& item) {
  return add(path, Value::list(Value::scalar(item)));
}

std::string TextEditor::as_written(std::string_view text, Writing as, std::size_t at) const {
  std::vector<std::string> anchors;
  for (const Anchor& one : outline_.anchors())
    if (!one.is_alias && one.at < at) anchors.push_back(one.name);
  switch (as) {
    case Writing::scalar:
      return scalar_text(text, anchors);
    case Writing::list:
      return list_text(text, anchors);
    case Writing::quoted:
      return quoted_text(text);
    case Writing::as_is:
      break;
  }
  return std::string(text);
}

bool TextEditor::set(const Path& path, const std::string& key, std::string_view text, Writing as) {
  const Path at = path / key;
  const Entry *now = entry(at), *holder = entry(path);
  if (is_blank(text) && as != Writing::quoted) {
    if (now != nullptr) remove(at);
    return now != nullptr || holder == nullptr || !holder->is_alias;
  }
  const std::string value = as_written(text, as,
                                       now != nullptr      ? now->whole.begin
                                       : holder != nullptr ? holder->whole.end
                                                           : text_.size());
  return now != nullptr ? replace(at, value) : insert(path, key, Value::scalar(value));
}

bool TextEditor::replace(const Path& path, const std::string& text) {
  const std::optional<Place> place = find(path);
  return place && put(*place, Value::scalar(text));
}

bool TextEditor::make_list(const Path& path) {
  const std::optional<Place> place = find(path);
  if (!place) return false;
  const Extent now = place->entry().written;
  const std::string old = text_.substr(now.begin, now.end - now.begin);
  const Node* value = map(path);
  if (value == nullptr || value->flow) return change(now, "[" + old + "]");
  std::string lines = "- ";
  for (std::size_t at = 0; at < old.size(); ++at) {
    lines += old[at];
    if (old[at] == '\n' && at + 1 < old.size() && old[at + 1] != '\n') lines += "  ";
  }
  return change(now, lines);
}

bool TextEditor::remove(const Path& path) {
  const std::optional<Place> place = find(path);
  if (!place) return false;
  const Node& parent = *place->parent;
  const std::vector<Entry>& parts = parent.parts();
  if (parts.size() == 1) {
    if (parent.flow) return change(parent.extent, parent.is_map() ? "{}" : "[]");
    return path.size() > 1 && remove(without_last(path));
  }
  const Extent whole = place->entry().whole;
  const std::size_t rest = text_.find_first_not_of(parent.flow ? " \t\r," : " \t\r", whole.end);
  const bool ends_line = rest == std::string::npos || text_[rest] == '\n' || text_[rest] == '#';
  if (begins_line(whole.begin) && ends_line) {
    const std::size_t end = text_.find('\n', whole.end);
    return change({line_start(whole.begin), end == std::string::npos ? text_.size() : end + 1}, "");
  }
  // The first entry of an item of a list stands behind the dash: the next one takes its place.
  if (place->at == 0) return change({whole.begin, parts[1].whole.begin}, "");
  return change({parts[place->at - 1].whole.end, whole.end}, "");
}

}  // namespace tessera::language
