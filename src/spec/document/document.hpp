#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"

/// YAML as a tree whose every part knows its position in the text. Specifications and files of parameters are
/// read so.
namespace tessera::spec {

using diagnostics::Diagnostics;
using diagnostics::Span;

struct Node;

/// A key of a map with its value.
struct Entry {
  std::string key;
  Span span;                    ///< of the key
  const Node* value = nullptr;  ///< never null
};

struct Node {
  enum class Kind : std::uint8_t { null, scalar, sequence, map } kind = Kind::null;
  Span span;                       ///< of a scalar's text without quotes; of its first line if it has several
  std::string text;                ///< of a scalar
  bool quoted = false;             ///< '...', "..." or a block (|, >): certainly a text
  bool verbatim = false;           ///< the text is in the file exactly as here, on one line
  std::vector<Entry> entries;      ///< of a map, in the order of the file, without duplicates
  std::vector<const Node*> items;  ///< of a sequence
  std::uint64_t size = 1;          ///< nodes from this one down, aliases counted wherever they are used
  std::uint32_t height = 1;

  [[nodiscard]] bool is_scalar() const { return kind == Kind::scalar; }
  [[nodiscard]] bool is_map() const { return kind == Kind::map; }
  [[nodiscard]] bool is_sequence() const { return kind == Kind::sequence; }
  [[nodiscard]] bool is_null() const { return kind == Kind::null; }
  /// The span of `length` bytes of a scalar's text from byte `offset`.
  [[nodiscard]] Span part(std::size_t offset, std::size_t length) const;
};

/// The nodes of one YAML document. Aliases share nodes. There are no cycles.
class Document {
 public:
  /// Whether there is no node, or only null. Otherwise there is a root.
  [[nodiscard]] bool empty() const { return root_ == nullptr || root_->is_null(); }
  [[nodiscard]] const Node& root() const { return *root_; }
  /// Adds `lines` to the line of every span: the text stands behind so many others.
  void shift(std::uint32_t lines);

 private:
  friend class TreeBuilder;
  std::deque<Node> nodes_;
  Node* root_ = nullptr;
};

inline constexpr std::uint64_t most_nodes = 2'000'000;  ///< of a document with its aliases expanded
inline constexpr std::uint32_t deepest = 64;            ///< nesting

/// Reads the only YAML document of out.text().
///
/// Errors: E002 empty, E005 syntax, E006 several documents, E007 nested too deeply, E008 aliases that
///         expand too far or contain themselves, E009 duplicate keys, E010 keys that are not text, tags. A
///         tree is returned with E009 and E010, so that the rest of the text is checked too.
/// beginning: the hint of E002.
[[nodiscard]] std::optional<Document> read_document(
    Diagnostics& out, std::string beginning = "begin with 'tessera: 1' and 'system: NAME'");

}  // namespace tessera::spec
