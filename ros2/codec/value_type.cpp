#include "ros2/codec/value_type.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace tessera::ros2 {
namespace {

constexpr int deepest_structure = 64;

class ValueTypeReader {
 public:
  explicit ValueTypeReader(std::string_view text) : left_(text) {}

  std::optional<ValueType> read_all() {
    auto type = read(0);
    return type && left_.empty() ? type : std::nullopt;
  }

 private:
  bool skip(std::string_view what) {
    if (!left_.starts_with(what)) return false;
    left_.remove_prefix(what.size());
    return true;
  }

  std::optional<std::uint32_t> number() {
    std::uint32_t number = 0;
    const auto [end, problem] = std::from_chars(left_.data(), left_.data() + left_.size(), number);
    if (problem != std::errc()) return std::nullopt;
    left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
    return number;
  }

  std::optional<ValueType> read(int depth) {
    if (depth > deepest_structure) return std::nullopt;
    ValueType type;
    if (left_.starts_with('{') ? !read_members(type, depth) : !read_scalar(type)) return std::nullopt;
    if (!skip("[")) return type;
    type.is_sequence = skip("<=");
    const auto count = number();
    if (!count || *count == 0 || !skip("]")) return std::nullopt;
    type.count = *count;
    return type;
  }

  bool read_members(ValueType& type, int depth) {
    type.primitive = Primitive::structure;
    skip("{");
    while (!skip("}")) {
      if (!type.members.empty() && !skip(", ")) return false;
      const std::size_t colon = left_.find(": ");
      if (colon == std::string_view::npos) return false;
      std::string name(left_.substr(0, colon));
      left_.remove_prefix(colon + 2);
      auto member = read(depth + 1);
      if (!member) return false;
      type.members.push_back({std::move(name), std::move(*member)});
    }
    return true;
  }

  bool read_scalar(ValueType& type) {
    if (skip("string(")) {
      type.primitive = Primitive::string;
      const auto capacity = number();
      type.capacity = capacity.value_or(0);
      return capacity && skip(")");
    }
    const std::string_view word = left_.substr(0, left_.find_first_of("[,}"));
    for (std::size_t one = 0; one <= static_cast<std::size_t>(Primitive::float64); ++one) {
      type.primitive = static_cast<Primitive>(one);
      if (word == name_of(type.primitive)) return skip(word);
    }
    return false;
  }

  std::string_view left_;
};

}  // namespace

std::string ValueType::text() const {
  std::string text = primitive == Primitive::structure ? "a structure" : name_of(primitive);
  if (primitive == Primitive::string) text += "<=" + std::to_string(capacity);
  if (count > 0 && primitive == Primitive::structure)
    return (is_sequence ? "at most " : "") + std::to_string(count) + " structures";
  if (count == 0) return text;
  return text + (is_sequence ? "<=" + std::to_string(count) : "[" + std::to_string(count) + "]");
}

const ValueType::Member* ValueType::find(std::string_view name) const {
  const auto found = std::ranges::find(members, name, &Member::name);
  return found == members.end() ? nullptr : &*found;
}

std::optional<ValueType> parse_value_type(std::string_view text) { return ValueTypeReader(text).read_all(); }

}  // namespace tessera::ros2
