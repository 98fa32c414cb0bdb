#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::language {

/// A way through a specification: keys of maps, and "" for an item of a list.
using Way = std::vector<std::string>;

/// The JSON Schema of the specification (share/tessera/spec.schema.json), asked for what may stand at a place.
///
/// Threads: may be shared after construction.
class Grammar {
 public:
  /// schema: its text. Throws std::runtime_error if it is no JSON.
  explicit Grammar(const std::string& schema);
  ~Grammar();
  Grammar(const Grammar&) = delete;
  Grammar& operator=(const Grammar&) = delete;

  struct Key {
    std::string name;
    std::string description;
    bool needed = false;
    bool holds_lines = false;  ///< its value is a map or a list
  };
  /// The keys that a map at `way` may have; empty if its keys are free.
  [[nodiscard]] std::vector<Key> keys(const Way& way) const;
  /// Values that are fixed words: "blocking", "true"; without those that are only examples.
  [[nodiscard]] std::vector<std::string> values(const Way& way) const;
  /// Examples of values: "20 Hz".
  [[nodiscard]] std::vector<std::string> examples(const Way& way) const;
  /// The description of the value at `way` in the schema; empty: there is none.
  [[nodiscard]] std::string description(const Way& way) const;

 private:
  struct Schema;
  std::unique_ptr<Schema> schema_;
};

}  // namespace tessera::language
