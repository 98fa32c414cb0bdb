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

/// Bytes that a text replaces.
struct Change {
  Extent extent;
  std::string text;
};
using Changes = std::vector<Change>;

/// The text after changes that do not overlap.
[[nodiscard]] std::string applied(std::string_view text, Changes changes);

/// How a text comes to stand in the file.
enum class Writing : std::uint8_t { scalar, list, quoted, as_is };

/// Finds the changes that an edit of one text needs. An edit of what is not there, or of an alias that would lose all
/// that it stands for, needs none.
///
/// Shape: each is linear in the text.
class TextEditor {
 public:
  /// Keeps the text.
  explicit TextEditor(std::string text) : text_(std::move(text)), outline_(text_) {}
  TextEditor(const TextEditor&) = delete;
  TextEditor& operator=(const TextEditor&) = delete;

  [[nodiscard]] const std::string& text() const { return text_; }

  /// The node at a path, not followed through aliases; nullptr: there is none.
  [[nodiscard]] const Node* node(const Path& path) const;
  [[nodiscard]] bool is_alias(const Path& path) const;
  [[nodiscard]] const Node* map(const Path& path) const;
  [[nodiscard]] const Node* list(const Path& path) const;
  /// The keys of the map at a path; none: it is no map.
  [[nodiscard]] std::vector<std::string> keys(const Path& path) const;
  /// Whether there is such a key or item.
  [[nodiscard]] bool has(const Path& path) const;
  /// A scalar's text, or the text of anything else as it is written; "" if there is none.
  [[nodiscard]] std::string value_text(const Path& path) const;
  /// The bytes of the entry or item, with its key and without comments behind it.
  [[nodiscard]] std::optional<Extent> extent(const Path& path) const;
  /// The bytes of the value alone.
  [[nodiscard]] std::optional<Extent> value_extent(const Path& path) const;
  /// The key, without quotes.
  [[nodiscard]] std::optional<Extent> key_extent(const Path& path) const;
  /// The first alias without an anchor before it.
  [[nodiscard]] std::optional<Anchor> lost_alias() const;
  [[nodiscard]] std::size_t column_of(std::size_t offset) const { return offset - line_start(offset); }
  [[nodiscard]] std::size_t line_end(std::size_t offset) const;

  /// Adds `key: value` at the end of the map at `path`, which is made if it is not there.
  [[nodiscard]] Changes insert(const Path& path, const std::string& key, const Value& value) const;
  /// Adds an item at the end of the list at `path`, which is made if it is not there.
  [[nodiscard]] Changes append(const Path& path, const std::string& item) const;
  /// Sets a value of the map at `path`. Blanks before it stay. An empty text removes the key.
  [[nodiscard]] Changes set(const Path& path, const std::string& key, std::string_view text,
                            Writing as) const;
  /// Replaces a value by text of the file.
  [[nodiscard]] Changes replace(const Path& path, const std::string& text) const;
  /// Makes the value at `path` the only item of a list.
  [[nodiscard]] Changes make_list(const Path& path) const;
  [[nodiscard]] Changes rename_key(const Path& path, const std::string& name) const;
  /// Removes an entry or item, with its line if it has one of its own. A map or list that would be empty goes as well,
  /// unless it is a flow.
  [[nodiscard]] Changes remove(const Path& path) const;

 private:
  /// A key or item in its map or list.
  struct Place {
    const Node* parent = nullptr;
    std::size_t at = 0;
  };
  [[nodiscard]] std::optional<Place> find(const Path& path) const;
  [[nodiscard]] static std::size_t size_of(const Node& parent);
  [[nodiscard]] const Node& value_of(const Place& place) const;
  [[nodiscard]] Extent alias_of(const Place& place) const;
  [[nodiscard]] Extent key_of(const Entry& entry) const;
  /// Behind the colon of an entry, or behind a key without one: `{ in, out }`.
  [[nodiscard]] std::size_t colon_of(const Entry& entry) const;
  [[nodiscard]] Extent written(const Node& node) const;
  /// The bytes of the value; empty: it has none.
  [[nodiscard]] Extent value_at(const Place& place) const;
  [[nodiscard]] std::size_t begin_of(const Place& place) const;
  [[nodiscard]] std::size_t end_of(const Place& place) const;
  [[nodiscard]] std::size_t line_start(std::size_t offset) const;
  [[nodiscard]] std::string_view new_line() const;
  [[nodiscard]] Change after_line(std::size_t offset, const std::string& line) const;
  [[nodiscard]] Changes insert_map(const Path& path, const std::string& key, const Value& value) const;
  [[nodiscard]] Changes insert_first(const std::string& key, const Value& value) const;
  [[nodiscard]] Changes replace_with(const Path& path, const Value& value) const;
  [[nodiscard]] Change remove_from_flow(const Node& parent, std::size_t at) const;
  [[nodiscard]] std::optional<Change> lines_of_item(const Node& parent, std::size_t at) const;
  [[nodiscard]] std::vector<std::string> anchors_before(std::size_t offset) const;
  [[nodiscard]] std::string as_written(std::string_view text, Writing as, std::size_t at) const;

  std::string text_;
  Outline outline_;
};

}  // namespace tessera::language
