#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

/// Makes wrong specifications of right ones, as people do: a typo in a name, a name of another section, a value of
/// another key, a block that is lost, copied or moved, a section as the schema allows it whose names mean nothing.
/// Most of its texts are still YAML, so that what they reach lies behind the reader.
///
/// Threads: one.
class SpecificationMutator {
 public:
  /// schema: share/tessera/spec.schema.json, as text.
  explicit SpecificationMutator(const std::string& schema);

  /// A few changes of `text`. The same seed makes the same changes.
  [[nodiscard]] std::string mutated(std::string text, std::uint32_t seed);

 private:
  using json = nlohmann::json;

  /// The position of a part of the text.
  struct Extent {
    std::size_t begin = 0, end = 0;
  };
  /// A key of the text, with its value: "rate: 20 Hz".
  struct Pair {
    std::string key;
    Extent whole, value;
  };

  void change(std::string& text);
  void cross_names(std::string& text);
  void misspell(std::string& text);
  void change_number(std::string& text);
  void change_type(std::string& text);
  void cross_values(std::string& text);
  void generate_value(std::string& text);
  void generate_sibling(std::string& text);
  void generate_section(std::string& text);
  void move_lines(std::string& text);

  /// A value that the schema allows, mostly, in YAML's flow style.
  [[nodiscard]] std::string generated(const json& schema, unsigned depth);
  [[nodiscard]] std::string generated_map(const json& schema, unsigned depth);
  [[nodiscard]] std::string generated_text(const json& schema);
  [[nodiscard]] std::string some_name();

  [[nodiscard]] std::size_t below(std::size_t count);
  template <class List>
  [[nodiscard]] const auto& one_of(const List& list) {
    return list[below(list.size())];
  }
  void collect_keys(const json& schema);

  json schema_;
  std::map<std::string, std::vector<const json*>> values_;    ///< of each key: the schemas of its value
  std::map<std::string, std::vector<std::string>> siblings_;  ///< of each key: keys that may stand beside it
  std::mt19937 random_;
  std::vector<std::string> names_;  ///< of the text that is being changed
};
