#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "spec/document/document.hpp"

namespace tessera::spec {

/// A map of the file with a fixed set of keys. An empty value counts as an empty map.
class Section {
 public:
  /// at: the key of the section, for complaints about the section as a whole.
  /// what: the section in words, e.g. "a behaviour".
  /// Errors: E104 not a map; E102 keys that are not among `keys`.
  Section(const Node& node, Span at, std::string what, std::initializer_list<std::string_view> keys,
          Diagnostics& out);

  /// The entry of `key`, or nullptr.
  [[nodiscard]] const Entry* find(std::string_view key) const;
  /// The same. E103 if the key is missing, unless an unknown key looks like it.
  const Entry* require(std::string_view key, std::string hint = {}) const;

  [[nodiscard]] bool readable() const { return node_ != nullptr; }
  /// Whether a key was unknown. If so, the author may have meant the key that seems to be missing.
  [[nodiscard]] bool has_unknown_keys() const { return unknown_keys_; }

 private:
  const Node* node_ = nullptr;  ///< null if it is no map
  Span at_;
  std::string what_;
  bool unknown_keys_ = false;
  std::vector<std::string> guesses_;  ///< what the unknown keys probably mean
  Diagnostics& out_;
};

/// The entry of that key in the map that stands behind an entry, or nullptr.
[[nodiscard]] const Entry* entry_in(const Entry& section, std::string_view key);

/// The entries of a map with free keys; empty if `node` is empty. Errors: E104 not a map.
[[nodiscard]] const std::vector<Entry>& entries_of(const Node& node, Span at, std::string_view what,
                                                   Diagnostics& out);

/// The items of a list; empty if `node` is empty. Errors: E104 not a list.
[[nodiscard]] const std::vector<const Node*>& items_of(const Node& node, Span at, std::string_view what,
                                                       Diagnostics& out,
                                                       std::string hint = "write [A, B] or - A");

/// The text of a scalar that is not empty, or nullptr. Errors: E104.
/// at: position for a complaint about a missing value.
[[nodiscard]] const Node* text_of(const Node& node, Span at, std::string_view what, Diagnostics& out,
                                  std::string hint = {});

/// true or false. Errors: E104.
[[nodiscard]] bool bool_of(const Entry& entry, std::string_view what, Diagnostics& out);

/// A plain `true` or `false` as YAML 1.2 reads it.
[[nodiscard]] bool is_true(const Node& node);
[[nodiscard]] bool is_false(const Node& node);
/// yes, no, on, off: YAML 1.1 reads them as booleans, this module as text.
[[nodiscard]] bool is_old_boolean(const Node& node);

}  // namespace tessera::spec
