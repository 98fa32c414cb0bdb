#include "language/edits/text_editor.hpp"

#include <algorithm>
#include <set>

namespace tessera::language {
namespace {

constexpr std::string_view blanks = " \t";

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

Value one_item(const std::string& item) { return Value::list(Value::scalar(item)); }

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

std::string applied(std::string_view text, Changes changes) {
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.extent < b.extent; });
  std::string after;
  std::size_t at = 0;
  for (const Change& change : changes) {
    if (change.extent.begin < at) continue;
    after += text.substr(at, change.extent.begin - at);
    after += change.text;
    at = change.extent.end;
  }
  return after.append(text.substr(at));
}

// ------------------------------------------------------------------------------------------------ places

std::size_t TextEditor::size_of(const Node& parent) {
  return parent.is_map() ? parent.entries.size() : parent.items.size();
}

const Node& TextEditor::value_of(const Place& place) const {
  return place.parent->is_map() ? *place.parent->entries[place.at].value : *place.parent->items[place.at];
}

Extent TextEditor::alias_of(const Place& place) const {
  return place.parent->is_map() ? place.parent->entries[place.at].alias
                                : place.parent->item_aliases[place.at];
}

std::optional<TextEditor::Place> TextEditor::find(const Path& path) const {
  const Node* node = &outline_.root();
  std::optional<Place> place;
  for (const Step& step : path) {
    if (place && !alias_of(*place).empty()) return std::nullopt;
    std::size_t at = 0;
    if (const std::string* key = language::key_of(step)) {
      const auto& entries = node->entries;
      at = static_cast<std::size_t>(
          std::find_if(entries.begin(), entries.end(), [&](const Entry& one) { return one.key == *key; }) -
          entries.begin());
      if (at == entries.size()) return std::nullopt;
    } else {
      at = std::get<std::size_t>(step);
      if (at >= node->items.size()) return std::nullopt;
    }
    place = Place{node, at};
    node = &value_of(*place);
  }
  return place;
}

const Node* TextEditor::node(const Path& path) const {
  if (path.empty()) return &outline_.root();
  const std::optional<Place> place = find(path);
  return place && alias_of(*place).empty() ? &value_of(*place) : nullptr;
}

bool TextEditor::is_alias(const Path& path) const {
  const std::optional<Place> place = find(path);
  return place && !alias_of(*place).empty();
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

bool TextEditor::has(const Path& path) const { return find(path).has_value(); }

std::string TextEditor::value_text(const Path& path) const {
  const std::optional<Extent> written = value_extent(path);
  if (!written) return {};
  const Node* found = node(path);
  if (found != nullptr && found->is_scalar()) return found->text;
  return text_.substr(written->begin, written->end - written->begin);
}

Extent TextEditor::key_of(const Entry& entry) const {
  const auto [begin, end] = entry.extent;
  const bool quoted = begin > 0 && end < text_.size() && text_[begin - 1] == text_[end] &&
                      (text_[end] == '"' || text_[end] == '\'');
  return quoted ? Extent{begin - 1, end + 1} : entry.extent;
}

std::size_t TextEditor::colon_of(const Entry& entry) const {
  const std::size_t end = key_of(entry).end;
  const std::size_t colon = text_.find_first_not_of(blanks, end);
  return colon != std::string::npos && text_[colon] == ':' ? colon + 1 : end;
}

Extent TextEditor::written(const Node& node) const {
  if (node.is_scalar()) return node.written;
  if (node.kind == Node::Kind::null) return {node.extent.begin, node.extent.begin};
  if (node.flow || size_of(node) == 0) return node.extent;
  return {node.extent.begin, end_of({&node, size_of(node) - 1})};
}

Extent TextEditor::value_at(const Place& place) const {
  if (const Extent alias = alias_of(place); !alias.empty()) return alias;
  const Node& value = value_of(place);
  if (value.kind != Node::Kind::null) return written(value);
  const std::size_t at = place.parent->is_map()         ? colon_of(place.parent->entries[place.at])
                         : place.parent->dashes.empty() ? value.extent.begin
                                                        : place.parent->dashes[place.at] + 1;
  return {at, at};
}

std::size_t TextEditor::begin_of(const Place& place) const {
  if (place.parent->is_map()) return key_of(place.parent->entries[place.at]).begin;
  if (!place.parent->dashes.empty()) return place.parent->dashes[place.at];
  std::size_t begin = value_at(place).begin;
  for (const Anchor& one : outline_.anchors())
    if (!one.is_alias && one.at < begin &&
        is_blank(std::string_view(text_).substr(one.at, begin - one.at).substr(one.name.size() + 1)))
      begin = one.at;
  return begin;
}

std::size_t TextEditor::end_of(const Place& place) const { return value_at(place).end; }

std::optional<Extent> TextEditor::extent(const Path& path) const {
  const std::optional<Place> place = find(path);
  if (!place) return std::nullopt;
  return Extent{begin_of(*place), end_of(*place)};
}

std::optional<Extent> TextEditor::value_extent(const Path& path) const {
  const std::optional<Place> place = find(path);
  return place ? std::optional(value_at(*place)) : std::nullopt;
}

std::optional<Extent> TextEditor::key_extent(const Path& path) const {
  const std::optional<Place> place = find(path);
  if (!place || !place->parent->is_map()) return std::nullopt;
  return place->parent->entries[place->at].extent;
}

std::vector<std::string> TextEditor::anchors_before(std::size_t offset) const {
  std::vector<std::string> names;
  for (const Anchor& one : outline_.anchors())
    if (!one.is_alias && one.at < offset) names.push_back(one.name);
  return names;
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

// ------------------------------------------------------------------------------------------------ lines

std::size_t TextEditor::line_start(std::size_t offset) const {
  const std::size_t end = offset == 0 ? std::string::npos : text_.rfind('\n', offset - 1);
  return end == std::string::npos ? 0 : end + 1;
}

std::size_t TextEditor::line_end(std::size_t offset) const {
  return std::min(text_.find_first_of("\r\n", offset), text_.size());
}

std::string_view TextEditor::new_line() const {
  return text_.find("\r\n") == std::string::npos ? "\n" : "\r\n";
}

Change TextEditor::after_line(std::size_t offset, const std::string& line) const {
  const std::size_t end = line_end(offset);
  const std::string after = std::string(new_line()) + line;
  return {{end, end}, end == text_.size() ? after + std::string(new_line()) : after};
}

// ------------------------------------------------------------------------------------------------ adding

Changes TextEditor::insert(const Path& path, const std::string& key, const Value& value) const {
  const Node* into = map(path);
  if (into == nullptr || into->entries.empty()) return insert_map(path, key, value);
  const Place last{into, into->entries.size() - 1};
  const std::size_t end = end_of(last);
  if (into->flow) return {{{end, end}, ", " + scalar_text(key) + ": " + flow_text(value)}};
  const std::size_t indent = column_of(begin_of({into, 0}));
  return {after_line(
      end, std::string(indent, ' ') + scalar_text(key) + ":" + block_text(value, indent, new_line()))};
}

Changes TextEditor::insert_map(const Path& path, const std::string& key, const Value& value) const {
  // An entry in place of the alias would drop all that it stands for.
  if (is_alias(path)) return {};
  if (path.empty()) return insert_first(key, value);
  const bool in_list = language::key_of(path.back()) == nullptr;
  if (in_list) return replace(path, flow_text(Value::map(scalar_text(key), value)));
  if (has(path)) return replace_with(path, Value::map(scalar_text(key), value));
  return insert(without_last(path), *language::key_of(path.back()), Value::map(scalar_text(key), value));
}

/// The first entry of a text that has none. A text that is no map stays as it is.
Changes TextEditor::insert_first(const std::string& key, const Value& value) const {
  const Node& root = outline_.root();
  if (root.is_map()) return {{root.extent, flow_text(Value::map(scalar_text(key), value))}};
  if (root.kind != Node::Kind::null) return {};
  const std::size_t end = text_.size();
  const std::string gap(end == 0 || text_.ends_with('\n') ? "" : new_line());
  return {{{end, end},
           gap + scalar_text(key) + ":" + block_text(value, 0, new_line()) + std::string(new_line())}};
}

/// A value within a flow is a flow.
Changes TextEditor::replace_with(const Path& path, const Value& value) const {
  const std::optional<Place> place = find(path);
  if (!place || !place->parent->is_map()) return {};
  const Entry& entry = place->parent->entries[place->at];
  const std::size_t colon = colon_of(entry);
  const Extent key = key_of(entry);
  const std::string text = place->parent->flow || value.kind == Value::Kind::text
                               ? " " + flow_text(value)
                               : block_text(value, column_of(key.begin), new_line());
  return {{{colon, std::max(colon, end_of(*place))}, colon == key.end ? ":" + text : text}};
}

Changes TextEditor::append(const Path& path, const std::string& item) const {
  if (is_alias(path)) return {};
  const Node* to = list(path);
  if (to != nullptr && !to->items.empty()) {
    const std::size_t end = end_of({to, to->items.size() - 1});
    if (to->flow) return {{{end, end}, ", " + item}};
    return {after_line(end, std::string(column_of(to->dashes.front()), ' ') + "- " + item)};
  }
  if (path.empty()) return {};
  if (language::key_of(path.back()) == nullptr) return replace(path, flow_text(one_item(item)));
  if (has(path)) return replace_with(path, one_item(item));
  const std::string& key = *language::key_of(path.back());
  if (path.size() > 1) return insert(without_last(path), key, one_item(item));
  if (outline_.root().flow) return insert({}, key, one_item(item));
  const std::string end(new_line());
  const std::string gap = text_.ends_with('\n') ? end : end + end;
  return {{{text_.size(), text_.size()}, gap + key + ":" + end + "  - " + item + end}};
}

// ------------------------------------------------------------------------------------------------ changing

std::string TextEditor::as_written(std::string_view text, Writing as, std::size_t at) const {
  switch (as) {
    case Writing::scalar:
      return scalar_text(text, anchors_before(at));
    case Writing::list:
      return list_text(text, anchors_before(at));
    case Writing::quoted:
      return quoted_text(text);
    case Writing::as_is:
      break;
  }
  return std::string(text);
}

Changes TextEditor::set(const Path& path, const std::string& key, std::string_view text, Writing as) const {
  const Path at = path / key;
  const std::optional<Place> place = find(at);
  if (is_blank(text) && as != Writing::quoted) return place ? remove(at) : Changes{};
  const std::optional<Extent> whole = extent(path);
  const std::string value = as_written(text, as,
                                       place   ? begin_of(*place)
                                       : whole ? whole->end
                                               : text_.size());
  if (!place) return insert(path, key, Value::scalar(value));
  const Extent now = value_at(*place);
  if (now.empty()) return replace_with(at, Value::scalar(value));
  return {{now, value}};
}

Changes TextEditor::replace(const Path& path, const std::string& text) const {
  const std::optional<Place> place = find(path);
  if (!place) return {};
  const Extent now = value_at(*place);
  const bool behind_sign =
      now.empty() && now.begin > 0 && (text_[now.begin - 1] == '-' || text_[now.begin - 1] == ':');
  return {{now, (behind_sign ? " " : "") + text}};
}

Changes TextEditor::make_list(const Path& path) const {
  const std::optional<Place> place = find(path);
  if (!place) return {};
  const Extent now = value_at(*place);
  const std::string old = text_.substr(now.begin, now.end - now.begin);
  const Node* value = node(path);
  if (value == nullptr || !value->is_map() || value->flow) return {{now, "[" + old + "]"}};
  std::string lines = "- ";
  for (std::size_t at = 0; at < old.size(); ++at) {
    lines += old[at];
    if (old[at] == '\n' && at + 1 < old.size() && old[at + 1] != '\n') lines += "  ";
  }
  return {{now, lines}};
}

Changes TextEditor::rename_key(const Path& path, const std::string& name) const {
  const std::optional<Place> place = find(path);
  if (!place || !place->parent->is_map()) return {};
  return {{key_of(place->parent->entries[place->at]), place->parent->flow ? scalar_text(name) : name}};
}

// ------------------------------------------------------------------------------------------------ removing

Changes TextEditor::remove(const Path& path) const {
  const std::optional<Place> place = find(path);
  if (!place) return {};
  const Node& parent = *place->parent;
  if (parent.flow) {
    if (std::optional<Change> lines = lines_of_item(parent, place->at)) return {*lines};
    return {remove_from_flow(parent, place->at)};
  }
  if (size_of(parent) == 1) return path.size() > 1 ? remove(without_last(path)) : Changes{};
  const std::size_t begin = begin_of(*place);
  const std::size_t start = line_start(begin);
  // The first entry of an item of a list stands behind the dash: the next one takes its place.
  if (!is_blank(std::string_view(text_).substr(start, begin - start)))
    return place->at + 1 < size_of(parent) ? Changes{{{begin, begin_of({&parent, place->at + 1})}, ""}}
                                           : Changes{};
  const std::size_t end = text_.find('\n', end_of(*place));
  return {{{start, end == std::string::npos ? text_.size() : end + 1}, ""}};
}

/// The lines of an item of a flow, if they have nothing but it and its comment.
std::optional<Change> TextEditor::lines_of_item(const Node& parent, std::size_t at) const {
  const Place place{&parent, at};
  const std::size_t begin = begin_of(place), start = line_start(begin);
  const std::size_t end = text_.find('\n', end_of(place));
  if (size_of(parent) < 2 || end == std::string::npos) return std::nullopt;
  const std::string_view all(text_);
  if (!is_blank(all.substr(start, begin - start))) return std::nullopt;
  std::string_view behind = all.substr(end_of(place), end - end_of(place));
  const auto skip_blanks = [&] {
    behind.remove_prefix(std::min(behind.find_first_not_of(" \t\r"), behind.size()));
  };
  skip_blanks();
  if (behind.starts_with(',')) behind.remove_prefix(1);
  skip_blanks();
  if (!behind.empty() && behind.front() != '#') return std::nullopt;
  return Change{{start, end + 1}, ""};
}

Change TextEditor::remove_from_flow(const Node& parent, std::size_t at) const {
  if (size_of(parent) == 1) return {parent.extent, parent.is_map() ? "{}" : "[]"};
  if (at > 0) return {{end_of({&parent, at - 1}), end_of({&parent, at})}, ""};
  return {{begin_of({&parent, 0}), begin_of({&parent, 1})}, ""};
}

}  // namespace tessera::language
