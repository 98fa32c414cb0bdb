#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "language/text/lines.hpp"

/// The outline of a YAML text that is being typed.
/// yaml-cpp refuses such a text: a bracket is still open, a key has no colon yet. This reader takes every
/// text. For a correct text, it makes the same tree as the parser of the specification (a test compares).
namespace tessera::language {

struct Node;

/// A key of a map with its value, or an item of a sequence, which has no key.
struct Entry {
  std::string key{};
  Extent extent{};              ///< of the key without quotes
  const Node* value = nullptr;  ///< never null
  bool complete = true;         ///< false: there is no colon yet
  bool is_alias = false;        ///< an alias stands for the value
  Extent whole{};          ///< from the quotes of the key, the dash or the anchor to the end of the value
  Extent written{};        ///< the value as it is written, or the alias; empty: there is none
  std::size_t behind = 0;  ///< where a value may begin: behind the colon or the dash
};

struct Node {
  enum class Kind : std::uint8_t { null, scalar, sequence, map } kind = Kind::null;
  Extent extent;           ///< a scalar: its text without quotes; others: from the first to the last byte
  Extent written;          ///< with the quotes of scalars, or from | or > on
  std::string text;        ///< of a scalar
  bool quoted = false;     ///< '...', "..." or a block (|, >)
  bool verbatim = false;   ///< text is exactly the bytes of `extent`
  bool flow = false;       ///< { } or [ ]
  std::size_t column = 0;  ///< of a block map or sequence: bytes before its entries
  std::vector<Entry> entries;
  std::vector<Entry> items;

  [[nodiscard]] bool is_scalar() const { return kind == Kind::scalar; }
  [[nodiscard]] bool is_map() const { return kind == Kind::map; }
  [[nodiscard]] bool is_sequence() const { return kind == Kind::sequence; }
  /// The entries of a map, or the items of a sequence.
  [[nodiscard]] const std::vector<Entry>& parts() const { return is_map() ? entries : items; }
  /// The first entry of that key, or nullptr.
  [[nodiscard]] const Entry* find(std::string_view key) const;
  /// The value of that key; a null node if there is none.
  [[nodiscard]] const Node& operator[](std::string_view key) const;
};

/// An anchor or an alias: its name, and where its & or * stands.
struct Anchor {
  std::string name;
  std::size_t at = 0;
  bool is_alias = false;
};

/// The tree of one text. Aliases share nodes.
class Outline {
 public:
  /// Linear in the text. It leaves out parts that are nested deeper than 64 levels.
  explicit Outline(std::string_view text);
  [[nodiscard]] const Node& root() const { return *root_; }
  /// All anchors and aliases, in the order of the text.
  [[nodiscard]] const std::vector<Anchor>& anchors() const { return anchors_; }

 private:
  std::deque<Node> nodes_;
  std::vector<Anchor> anchors_;
  const Node* root_ = nullptr;
};

}  // namespace tessera::language
