#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "net/ids.hpp"

namespace tessera::drawing {

/// Appends JSON to a text, on one line, without a tree in between: the net of a thousand
/// agents has tens of megabytes.
class JsonWriter {
 public:
  void value(std::uint32_t number) {
    std::array<char, 10> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text_.append(digits.data(), end);
  }
  /// No element is written as null.
  template <class Tag>
  void value(net::Id<Tag> id) {
    id.valid() ? value(id.value) : null();
  }
  void value(std::string_view text) {
    const auto plain = [](char one) { return one >= ' ' && one != '"' && one != '\\' && one != '\x7f'; };
    if (std::all_of(text.begin(), text.end(), plain))
      text_.append(1, '"').append(text).append(1, '"');
    else
      text_ += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  void null() { text_ += "null"; }
  /// Appends text that is JSON already.
  void raw(std::string_view json) { text_ += json; }

  template <class Members>
  void object(Members members) {
    text_ += '{';
    members();
    close('}');
  }
  template <class Elements, class Each>
  void list(const Elements& elements, Each each) {
    text_ += '[';
    for (const auto& element : elements) {
      each(element);
      text_ += ',';
    }
    close(']');
  }
  /// Writes the key of a member, its value and a comma.
  template <class Value>
  void member(std::string_view name, Value value_of) {
    text_.append(1, '"').append(name).append("\":");
    if constexpr (std::is_invocable_v<Value>)
      value_of();
    else
      value(value_of);
    text_ += ',';
  }

  void reserve(std::size_t bytes) { text_.reserve(bytes); }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  void close(char bracket) {
    if (text_.back() == ',')
      text_.back() = bracket;
    else
      text_ += bracket;
  }
  std::string text_;
};

}  // namespace tessera::drawing
