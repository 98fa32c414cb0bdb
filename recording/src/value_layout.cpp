#include "tessera/value_layout.hpp"

#include <charconv>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace tessera {

/// Reads the text of a type (tessera/value_encoding.hpp).
class ValueLayoutParser {
 public:
  using Node = ValueLayout::Node;
  using NodePtr = std::shared_ptr<const Node>;

  explicit ValueLayoutParser(std::string_view text) : left_(text) {}

  std::optional<ValueLayout> result() {
    NodePtr root = type();
    if (root == nullptr || !left_.empty()) return std::nullopt;
    return ValueLayout(std::move(root));
  }

 private:
  /// Deeper than any type in a specification.
  static constexpr int deepest = 64;
  /// More than any type in a specification: the text may come from a damaged file.
  static constexpr std::size_t most_scalars = std::size_t{1} << 28U;

  bool accept(std::string_view token) {
    if (!left_.starts_with(token)) return false;
    left_.remove_prefix(token.size());
    return true;
  }

  std::optional<std::size_t> number() {
    std::size_t value = 0;
    const auto [end, problem] = std::from_chars(left_.data(), left_.data() + left_.size(), value);
    if (problem != std::errc{}) return std::nullopt;
    left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
    return value;
  }

  NodePtr type() {
    if (++depth_ > deepest) return nullptr;
    NodePtr made = accept("{") ? structure() : scalar();
    while (made != nullptr && accept("[")) {
      const bool bounded = accept("<=");
      const std::optional<std::size_t> count = number();
      if (!count || !accept("]") || made->scalars == 0 || *count > most_scalars / made->scalars)
        return nullptr;
      made = std::make_shared<Node>(
          Node{Node::Kind::sequence, *count, made, {}, *count * made->scalars, bounded});
    }
    --depth_;
    return made;
  }

  NodePtr structure() {
    auto made = std::make_shared<Node>();
    made->kind = Node::Kind::structure;
    made->scalars = 0;
    while (!accept("}")) {
      if (!made->fields.empty() && !accept(", ")) return nullptr;
      const std::size_t colon = left_.find(": ");
      if (colon == std::string_view::npos) return nullptr;
      std::string name(left_.substr(0, colon));
      left_.remove_prefix(colon + 2);
      NodePtr field = type();
      if (field == nullptr) return nullptr;
      made->scalars += field->scalars;
      if (made->scalars > most_scalars) return nullptr;
      made->fields.push_back({std::move(name), std::move(field)});
    }
    return made;
  }

  NodePtr scalar() {
    using Kind = Node::Kind;
    const auto make = [](Kind kind, std::size_t size) {
      return std::make_shared<const Node>(Node{kind, size, {}, {}, 1, false});
    };
    if (accept("bool")) return make(Kind::boolean, 1);
    struct Name {
      std::string_view text;
      Kind kind;
    };
    for (const Name& name :
         {Name{"int", Kind::integer}, Name{"uint", Kind::natural}, Name{"float", Kind::real}}) {
      if (!accept(name.text)) continue;
      const std::optional<std::size_t> bits = number();
      const bool known = bits == 32 || bits == 64 || (name.kind != Kind::real && (bits == 8 || bits == 16));
      return known ? make(name.kind, *bits / 8) : nullptr;
    }
    for (const Name& name : {Name{"string(", Kind::text}, Name{"bytes(", Kind::bytes}}) {
      if (!accept(name.text)) continue;
      const std::optional<std::size_t> size = number();
      const bool known = size && (name.kind == Kind::text || *size > 0) && accept(")");
      return known ? make(name.kind, *size) : nullptr;
    }
    return nullptr;
  }

  std::string_view left_;
  int depth_ = 0;
};

std::optional<ValueLayout> ValueLayout::parse(std::string_view type) {
  return ValueLayoutParser(type).result();
}

}  // namespace tessera
