#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Values as they come to stand in a specification.
namespace tessera::language {

/// A scalar or a flow as text of the file, or a list or map of values.
struct Value {
  enum class Kind : std::uint8_t { text, list, map } kind = Kind::text;
  std::string text;
  std::vector<std::string> keys;  ///< of a map
  std::vector<Value> items;       ///< of a list; of a map, in the order of its keys

  [[nodiscard]] static Value scalar(std::string text) { return {Kind::text, std::move(text), {}, {}}; }
  [[nodiscard]] static Value list(Value item) { return {Kind::list, {}, {}, {std::move(item)}}; }
  [[nodiscard]] static Value map(std::string key, Value value) {
    return {Kind::map, {}, {std::move(key)}, {std::move(value)}};
  }
};

/// A text as a YAML scalar, in quotes only if YAML needs them. A flow ("[...]", "{...}") that can be read stays one,
/// and so does an alias. anchors: the names that an alias may have here.
[[nodiscard]] std::string scalar_text(std::string_view text, const std::vector<std::string>& anchors = {});

/// The same for "a, b": a list in one line; a single name is no list.
[[nodiscard]] std::string list_text(std::string_view text, const std::vector<std::string>& anchors = {});

/// In double quotes.
[[nodiscard]] std::string quoted_text(std::string_view text);

/// A value in one line.
[[nodiscard]] std::string flow_text(const Value& value);
/// The same of a list or map without its brackets.
[[nodiscard]] std::string flow_parts(const Value& value);

/// The text behind the colon of a key whose entries or items stand at column `indent`: maps that hold maps in lines of
/// their own, others in one line; each item of a list in its own line. end: of a line.
[[nodiscard]] std::string block_text(const Value& value, std::size_t indent, std::string_view end);

}  // namespace tessera::language
