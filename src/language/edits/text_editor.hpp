#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "language/edits/values.hpp"
#include "language/text/outline.hpp"

/// Changes of a YAML text in place: comments, order, layout and quotes of everything else stay as they are.
namespace tessera::language {

/// A key of a map, or the number of an item of a list.
using Step = std::variant<std::string, std::size_t>;
using Path = std::vector<Step>;

/// "agents", "robot", 3
[[nodiscard]] Path operator/(Path path, Step step);
[[nodiscard]] Path without_last(Path path);
/// nullptr: it is the number of an item.
[[nodiscard]] const std::string* key_of(const Step& step);

/// How a text comes to stand in the file.
enum class Writing : std::uint8_t { scalar, list, quoted, as_is };

/// A text and the edits of it. An edit of what is not there, or of an alias that would lose all that it stands for,
/// changes nothing and returns false.
///
/// Shape: each edit is linear in the text. Nodes and entries are valid until the next one.
class TextEditor {
 public:
  explicit TextEditor(std::string text) : text_(std::move(text)), outline_(text_) {}
  TextEditor(const TextEditor&) = delete;
  TextEditor& operator=(const TextEditor&) = delete;

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const Outline& outline() const { return outline_; }

  /// The entry or item at a path; nullptr: there is none.
  [[nodiscard]] const Entry* entry(const Path& path) const;
  /// The node at a path, not followed through aliases; nullptr: there is none.
  [[nodiscard]] const Node* node(const Path& path) const;
  [[nodiscard]] const Node* map(const Path& path) const;
  [[nodiscard]] const Node* list(const Path& path) const;
  /// The keys of the map at a path; none: it is no map.
  [[nodiscard]] std::vector<std::string> keys(const Path& path) const;
  /// A scalar's text, or the text of anything else as it is written; "" if there is none.
  [[nodiscard]] std::string value_text(const Path& path) const;
  /// The first alias without an anchor before it.
  [[nodiscard]] std::optional<Anchor> lost_alias() const;
  [[nodiscard]] std::size_t column_of(std::size_t offset) const { return offset - line_start(offset); }

  /// Replaces these bytes.
  bool change(Extent extent, std::string_view text);
  /// Adds `key: value` at the end of the map at `path`, which is made if it is not there.
  bool insert(const Path& path, const std::string& key, const Value& value);
  /// Adds an item at the end of the list at `path`, which is made if it is not there.
  bool append(const Path& path, const std::string& item);
  /// Sets a value of the map at `path`. An empty text removes the key.
  bool set(const Path& path, const std::string& key, std::string_view text, Writing as);
  /// Replaces a value by text of the file.
  bool replace(const Path& path, const std::string& text);
  /// Makes the value at `path` the only item of a list.
  bool make_list(const Path& path);
  /// Removes an entry or item, with its line if it has one of its own. A map or list that would be empty goes as well,
  /// unless it is a flow.
  bool remove(const Path& path);

 private:
  /// A key or item in its map or list.
  struct Place {
    const Node* parent = nullptr;
    std::size_t at = 0;
    [[nodiscard]] const Entry& entry() const { return parent->parts()[at]; }
  };
  [[nodiscard]] std::optional<Place> find(const Path& path) const;
  [[nodiscard]] std::size_t line_start(std::size_t offset) const;
  [[nodiscard]] bool begins_line(std::size_t offset) const;
  [[nodiscard]] std::string_view new_line() const;
  [[nodiscard]] std::string as_written(std::string_view text, Writing as, std::size_t at) const;
  bool add(const Path& path, const Value& one);
  bool add_at_end(const Value& one);
  bool put(const Place& place, const Value& value);

  std::string text_;
  Outline outline_;
};

}  // namespace tessera::language
