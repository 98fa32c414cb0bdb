#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "checks/expression.hpp"
#include "checks/parser.hpp"

namespace tessera::checks {

inline constexpr const char* element_hint =
    "for example rover, arm/gripper, robot[3], robot[*] or robot[i+1]";

/// Letters, words and elements of a text, from its beginning to its end. After the first mistake the text
/// counts as ended, so every rule of a parser ends soon; the results of the rules then mean nothing.
class TextReader {
 public:
  explicit TextReader(std::string_view text) : text_(text) {}

 protected:
  [[nodiscard]] static bool is_digit(char letter);
  [[nodiscard]] static bool is_letter(char letter);
  /// The rest of the text without leading blanks, which count as read.
  [[nodiscard]] std::string_view rest();
  /// The next letters, digits and underscores, which stay there.
  [[nodiscard]] std::string_view word();
  bool take(std::string_view symbol);
  bool take_word(std::string_view wanted);
  [[nodiscard]] Place since(std::size_t from) const { return {from, at_ - from}; }
  /// Only the first mistake counts.
  void fail(Place place, std::string text, Hint hint);
  [[nodiscard]] Element element();

  std::string_view text_;
  std::optional<Mistake> mistake_;
  std::size_t at_ = 0;

 private:
  [[nodiscard]] std::string name_part();
  void read_index(Element& element);
  [[nodiscard]] std::int64_t index_number(std::size_t from);
};

}  // namespace tessera::checks
