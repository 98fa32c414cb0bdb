#include "spec/values/literals.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

struct IntegerRange {
  std::int64_t lowest;
  std::uint64_t highest;
};

template <class T>
constexpr IntegerRange range_of() {
  return {static_cast<std::int64_t>(std::numeric_limits<T>::min()),
          static_cast<std::uint64_t>(std::numeric_limits<T>::max())};
}

IntegerRange range(Scalar scalar) {
  switch (scalar) {
    case Scalar::int8:
      return range_of<std::int8_t>();
    case Scalar::int16:
      return range_of<std::int16_t>();
    case Scalar::int32:
      return range_of<std::int32_t>();
    case Scalar::uint8:
      return range_of<std::uint8_t>();
    case Scalar::uint16:
      return range_of<std::uint16_t>();
    case Scalar::uint32:
      return range_of<std::uint32_t>();
    case Scalar::uint64:
      return range_of<std::uint64_t>();
    default:
      return range_of<std::int64_t>();
  }
}

/// `.nan` and `.inf` of YAML as C++; empty: the text is neither.
std::string non_finite_literal(std::string_view text, Scalar scalar) {
  const std::string limits =
      std::string("std::numeric_limits<") + (scalar == Scalar::float32 ? "float" : "double") + ">::";
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return limits + "quiet_NaN()";
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text != ".inf" && text != ".Inf" && text != ".INF") return {};
  return (negative ? "-" : "") + limits + "infinity()";
}

/// How YAML spells a number that is not finite, for a text that means one; empty: it means none.
std::string yaml_of_non_finite(std::string_view text) {
  std::string word;
  for (const char c : text) word += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (word == "nan" || word == "qnan" || word == "null" || word == "~") return "write .nan";
  if (word == "inf" || word == "infinity" || word == "+inf") return "write .inf";
  return word == "-inf" || word == "-infinity" ? "write -.inf" : "";
}

template <class Float>
std::string shortest(Float value) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// Writes values of one file; its members are shared by all parts of a value.
class Writer {
 public:
  Writer(const Types& types, std::string_view what, Diagnostics& out,
         std::vector<NonFiniteNumber>* non_finite)
      : types_(types), what_(what), out_(out), non_finite_(non_finite) {}

  /// path: of the fields that lead to the value.
  std::optional<std::string> write(const Node& node, Span at, const Type& type,
                                   const std::string& path = {}) const {
    if (Types::is_unknown(type)) return std::nullopt;
    if (type.extent > 0) return array(node, at, type, path);
    if (type.kind == Type::Kind::structure) return structure(node, at, type, path);
    if (!node.is_scalar()) return mismatch(node, at, type);
    if (type.kind == Type::Kind::string) return string(node, type);
    if (type.scalar == Scalar::boolean) return boolean(node, at, type);
    return number(node, at, type, path);
  }

 private:
  std::nullopt_t mismatch(const Node& node, Span at, const Type& type, std::string hint = {}) const {
    const bool scalar = node.is_scalar();
    out_.error("E203", scalar ? node.span : at,
               what_ + " must be a value of type " + types_.spelled(type) +
                   (scalar ? ", not " + in_quotes(node.text) : ""),
               std::move(hint));
    return std::nullopt;
  }

  std::nullopt_t out_of_range(const Node& node, const Type& type) const {
    out_.error("E204", node.span, in_quotes(node.text) + " is out of the range of " + types_.spelled(type));
    return std::nullopt;
  }

  std::optional<std::string> array(const Node& node, Span at, const Type& type,
                                   const std::string& path) const {
    if (!node.is_sequence())
      return mismatch(node, at, type,
                      type.is_sequence ? "write a list: [], [1, 2]" : "write a list: [1, 2, 3]");
    if (type.is_sequence ? node.items.size() > type.extent : node.items.size() != type.extent) {
      out_.error("E203", at,
                 what_ + " has " + std::to_string(node.items.size()) + " elements, " + types_.spelled(type) +
                     (type.is_sequence ? " has at most " : " has ") + std::to_string(type.extent));
      return std::nullopt;
    }
    const Type element = type.element();
    std::string text;
    for (const Node* item : node.items) {
      auto part = write(*item, item->span, element, path);
      if (!part) return std::nullopt;
      if (element.kind == Type::Kind::structure) part = "{" + *part + "}";
      text += (text.empty() ? "" : ", ") + *part;
    }
    if (type.is_sequence) return text;
    return "{" + text + "}";  // the elements of std::array have their own braces
  }

  std::optional<std::string> structure(const Node& node, Span at, const Type& type,
                                       const std::string& path) const {
    const Structure& shape = types_.structures()[type.structure];
    if (!node.is_map()) return mismatch(node, at, type, "write a map: { " + first_field(shape) + ": ... }");
    check_fields(node, shape);
    std::string text;
    for (const Field& field : shape.fields) {
      const auto given = std::find_if(node.entries.begin(), node.entries.end(),
                                      [&](const Entry& entry) { return entry.key == field.name; });
      std::optional<std::string> part = std::string();
      if (given != node.entries.end())
        part = write(*given->value, given->span, field.type,
                     path.empty() ? field.name : path + "." + field.name);
      if (!part) return std::nullopt;
      // Compilers warn of braces around a number.
      const bool bare = field.type.kind == Type::Kind::scalar && field.type.extent == 0 && !part->empty();
      text += (text.empty() ? "." : ", .") + field.name + (bare ? " = " + *part : "{" + *part + "}");
    }
    return text;
  }

  static std::string first_field(const Structure& shape) {
    return shape.fields.empty() ? "field" : shape.fields.front().name;
  }

  void check_fields(const Node& node, const Structure& shape) const {
    std::vector<std::string> names;
    for (const Field& field : shape.fields) names.push_back(field.name);
    for (const Entry& entry : node.entries) {
      if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
      out_.error("E101", entry.span,
                 "type " + in_quotes(shape.name) + " has no field " + in_quotes(entry.key),
                 did_you_mean(entry.key, names));
    }
  }

  std::optional<std::string> string(const Node& node, const Type& type) const {
    if (node.text.size() > type.capacity) return out_of_range(node, type);
    return string_literal(node.text);
  }

  std::optional<std::string> boolean(const Node& node, Span at, const Type& type) const {
    if (is_true(node)) return "true";
    if (is_false(node)) return "false";
    return mismatch(node, at, type, "write true or false");
  }

  std::optional<std::string> number(const Node& node, Span at, const Type& type,
                                    const std::string& path) const {
    const bool real = type.scalar == Scalar::float64 || type.scalar == Scalar::float32;
    if (std::string special = non_finite_literal(node.text, type.scalar);
        real && non_finite_ != nullptr && !node.quoted && !special.empty()) {
      non_finite_->push_back({path, node.span});
      return special;
    }
    const auto quantity = split_quantity(node.text);
    if (!quantity)
      return mismatch(node, at, type,
                      real && non_finite_ != nullptr ? yaml_of_non_finite(node.text) : std::string());
    if (!quantity->unit.empty() && quantity->unit != type.unit) {
      out_.error("E208", node.span,
                 "unit " + in_quotes(quantity->unit) + " where the type is " + types_.spelled(type),
                 "units are compared as they are written");
      return std::nullopt;
    }
    if (type.scalar == Scalar::float64) return float_literal(quantity->number);
    if (type.scalar == Scalar::float32) return narrow_float(node, *quantity, type);
    return integer(node, at, *quantity, type);
  }

  std::optional<std::string> narrow_float(const Node& node, const Quantity& quantity,
                                          const Type& type) const {
    if (std::abs(quantity.number) > static_cast<double>(std::numeric_limits<float>::max()))
      return out_of_range(node, type);
    return shortest(static_cast<float>(quantity.number)) + "F";
  }

  std::optional<std::string> integer(const Node& node, Span at, const Quantity& quantity,
                                     const Type& type) const {
    const std::string_view digits = quantity.digits;
    const bool negative = digits.starts_with('-');
    const char* const end = digits.data() + digits.size();
    std::uint64_t magnitude = 0;
    const auto [stop, error] = std::from_chars(digits.data() + (negative ? 1 : 0), end, magnitude);
    if (stop != end) return mismatch(node, at, type, "write a whole number");
    const IntegerRange bounds = range(type.scalar);
    const std::uint64_t largest = negative ? ~static_cast<std::uint64_t>(bounds.lowest) + 1 : bounds.highest;
    if (error != std::errc() || magnitude > largest) return out_of_range(node, type);
    // The lowest int64 has no literal of its own: its digits without the sign are out of range.
    if (negative && magnitude == std::uint64_t{1} << 63U) return "-9223372036854775807 - 1";
    // The digits are not copied as written: C++ reads 010 as eight.
    return (negative ? "-" : "") + std::to_string(magnitude) + (type.scalar == Scalar::uint64 ? "U" : "");
  }

  const Types& types_;
  std::string what_;
  Diagnostics& out_;
  std::vector<NonFiniteNumber>* non_finite_;
};

}  // namespace

std::optional<std::string> initialiser(const Node& node, Span at, const Type& type, const Types& types,
                                       std::string_view what, Diagnostics& out,
                                       std::vector<NonFiniteNumber>* non_finite) {
  return Writer(types, what, out, non_finite).write(node, at, type);
}

std::string float_literal(double value) { return shortest(value); }

std::string string_literal(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else if (byte < 0x20 || byte == 0x7F) {
      // Octal, because it ends after three digits, unlike \x.
      const auto digit = [byte](unsigned shift) { return static_cast<char>('0' + ((byte >> shift) & 7U)); };
      result += {'\\', digit(6), digit(3), digit(0)};
    } else {
      result += c;
    }
  }
  return result + "\"";
}

}  // namespace tessera::spec
