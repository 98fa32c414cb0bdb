#include "tessera/value_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "tessera/value_layout.hpp"

namespace tessera {

namespace {

using ScalarValue = ValueLayout::ScalarValue;

template <class T>
[[nodiscard]] T as(std::string_view bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

[[nodiscard]] std::int64_t signed_of(std::string_view bytes) {
  switch (bytes.size()) {
    case 1:
      return as<std::int8_t>(bytes);
    case 2:
      return as<std::int16_t>(bytes);
    case 4:
      return as<std::int32_t>(bytes);
    default:
      return as<std::int64_t>(bytes);
  }
}

[[nodiscard]] std::uint64_t unsigned_of(std::string_view bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data(), bytes.size());
  return value;
}

[[nodiscard]] std::string hexadecimal(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

}  // namespace

namespace {

/// Visits the bytes of a value according to its type.
template <class Node>
class Walk {
 public:
  Walk(std::string_view bytes, const ValueLayout::Visit& visit, const ValueLayout::VisitLength& visit_length)
      : left_(bytes), visit_(visit), visit_length_(visit_length) {}

  [[nodiscard]] bool over(const Node& type, std::string& path) {
    using Kind = typename Node::Kind;
    switch (type.kind) {
      case Kind::sequence:
        return over_elements(type, path);
      case Kind::structure:
        return over_fields(type, path);
      case Kind::text:
        return text(type, path);
      default:
        return scalar(type, path);
    }
  }
  [[nodiscard]] bool finished() const { return left_.empty(); }

 private:
  [[nodiscard]] bool over_elements(const Node& type, std::string& path) {
    const std::size_t before = path.size();
    std::size_t count = type.size;
    if (type.bounded) {
      if (left_.size() < sizeof(std::uint32_t)) return false;
      count = as<std::uint32_t>(left_);
      left_.remove_prefix(sizeof(std::uint32_t));
      if (count > type.size) return false;
      if (visit_length_) visit_length_(path, count);
    }
    for (std::size_t index = 0; index < count; ++index) {
      path += fmt::format("[{}]", index);
      const bool whole = over(*type.element, path);
      path.resize(before);
      if (!whole) return false;
    }
    return true;
  }

  [[nodiscard]] bool over_fields(const Node& type, std::string& path) {
    const std::size_t length = path.size();
    for (const auto& field : type.fields) {
      if (!path.empty()) path += '.';
      path += field.name;
      const bool whole = over(*field.type, path);
      path.resize(length);
      if (!whole) return false;
    }
    return true;
  }

  [[nodiscard]] bool text(const Node& type, const std::string& path) {
    if (left_.size() < sizeof(std::uint32_t)) return false;
    const auto length = as<std::uint32_t>(left_);
    left_.remove_prefix(sizeof length);
    if (length > type.size || length > left_.size()) return false;
    ScalarValue scalar;
    scalar.kind = ScalarValue::Kind::text;
    scalar.text = left_.substr(0, length);
    left_.remove_prefix(length);
    visit_(path, scalar);
    return true;
  }

  [[nodiscard]] bool scalar(const Node& type, const std::string& path) {
    using Kind = typename Node::Kind;
    if (left_.size() < type.size) return false;
    const std::string_view bytes = left_.substr(0, type.size);
    left_.remove_prefix(type.size);
    ScalarValue scalar;
    std::string text;
    switch (type.kind) {
      case Kind::boolean:
        scalar.kind = ScalarValue::Kind::boolean;
        scalar.integer = unsigned_of(bytes) != 0 ? 1 : 0;
        scalar.number = static_cast<double>(scalar.integer);
        break;
      case Kind::integer:
        scalar.kind = ScalarValue::Kind::integer;
        scalar.integer = signed_of(bytes);
        scalar.number = static_cast<double>(scalar.integer);
        break;
      case Kind::natural:
        scalar.kind = ScalarValue::Kind::natural;
        scalar.integer = static_cast<std::int64_t>(unsigned_of(bytes));
        scalar.number = static_cast<double>(unsigned_of(bytes));
        break;
      case Kind::real:
        scalar.single = type.size == 4;
        scalar.number = scalar.single ? as<float>(bytes) : as<double>(bytes);
        break;
      default:
        scalar.kind = ScalarValue::Kind::text;
        text = hexadecimal(bytes);
        scalar.text = text;
        break;
    }
    visit_(path, scalar);
    return true;
  }

  std::string_view left_;
  const ValueLayout::Visit& visit_;
  const ValueLayout::VisitLength& visit_length_;
};

}  // namespace

std::string ValueLayout::ScalarValue::shown() const {
  switch (kind) {
    case Kind::boolean:
      return integer != 0 ? "true" : "false";
    case Kind::integer:
      return fmt::format("{}", integer);
    case Kind::natural:
      return fmt::format("{}", static_cast<std::uint64_t>(integer));
    case Kind::real:
      return single ? fmt::format("{}", static_cast<float>(number)) : fmt::format("{}", number);
    case Kind::text:
      return std::string(text);
  }
  return "";
}

bool ValueLayout::visit(std::string_view bytes, const Visit& visit, const VisitLength& visit_length) const {
  Walk<Node> walk(bytes, visit, visit_length);
  std::string path;
  return walk.over(*root_, path) && walk.finished();
}

namespace {

template <class Node>
void collect_paths(const Node& type, const std::string& path, std::vector<std::string>& paths) {
  using Kind = typename Node::Kind;
  if (type.kind == Kind::sequence) {
    for (std::size_t index = 0; index < type.size; ++index)
      collect_paths(*type.element, fmt::format("{}[{}]", path, index), paths);
  } else if (type.kind == Kind::structure) {
    for (const auto& field : type.fields)
      collect_paths(*field.type, path.empty() ? field.name : path + '.' + field.name, paths);
  } else {
    paths.push_back(path);
  }
}

}  // namespace

std::size_t ValueLayout::scalars() const { return root_->scalars; }

namespace {

void collect_sequences(const auto& type, const std::string& path, std::vector<std::string>& sequences) {
  using Kind = std::remove_cvref_t<decltype(type.kind)>;
  if (type.bounded) sequences.push_back(path);
  for (std::size_t index = 0; type.kind == Kind::sequence && index < type.size; ++index) {
    const std::size_t before = sequences.size();
    collect_sequences(*type.element, fmt::format("{}[{}]", path, index), sequences);
    if (sequences.size() == before) return;  // then no element has any
  }
  for (const auto& field : type.fields)
    collect_sequences(*field.type, path.empty() ? field.name : path + '.' + field.name, sequences);
}

}  // namespace

std::vector<std::string> ValueLayout::sequences() const {
  std::vector<std::string> sequences;
  collect_sequences(*root_, "", sequences);
  return sequences;
}

namespace {

bool holds_sequences(const auto& type) {
  return type.bounded || (type.element != nullptr && holds_sequences(*type.element)) ||
         std::ranges::any_of(type.fields, [](const auto& field) { return holds_sequences(*field.type); });
}

}  // namespace

bool ValueLayout::has_sequences() const { return holds_sequences(*root_); }

std::vector<std::string> ValueLayout::paths() const {
  std::vector<std::string> paths;
  collect_paths(*root_, "", paths);
  return paths;
}

namespace {

void collect_types(const auto& node, std::vector<std::string>& types) {
  using Kind = std::remove_cvref_t<decltype(node.kind)>;
  switch (node.kind) {
    case Kind::boolean:
      types.emplace_back("bool");
      return;
    case Kind::integer:
      types.push_back(fmt::format("int{}", 8 * node.size));
      return;
    case Kind::natural:
      types.push_back(fmt::format("uint{}", 8 * node.size));
      return;
    case Kind::real:
      types.push_back(fmt::format("float{}", 8 * node.size));
      return;
    case Kind::text:
      types.push_back(fmt::format("string({})", node.size));
      return;
    case Kind::bytes:
      types.push_back(fmt::format("bytes({})", node.size));
      return;
    case Kind::sequence:
      for (std::size_t index = 0; index < node.size; ++index) collect_types(*node.element, types);
      return;
    case Kind::structure:
      for (const auto& field : node.fields) collect_types(*field.type, types);
  }
}

}  // namespace

std::vector<std::string> ValueLayout::types() const {
  std::vector<std::string> types;
  collect_types(*root_, types);
  return types;
}

std::string ValueLayout::shown(std::string_view bytes, std::size_t most) const {
  std::string text;
  bool one = false;
  const auto add = [&](const std::string& path, const std::string& value) {
    one = path.empty();
    if (text.size() > most) return;
    text += (text.empty() ? "" : ", ") + (one ? "" : path + ": ") + value;
  };
  const bool whole = visit(
      bytes,
      [&](const std::string& path, const ScalarValue& scalar) {
        add(path,
            scalar.kind == ScalarValue::Kind::text ? '"' + std::string(scalar.text) + '"' : scalar.shown());
      },
      [&](const std::string& path, std::size_t length) {
        if (length == 0) add(path, "[]");
      });
  if (text.size() > most) text = text.substr(0, most) + "...";
  if (!whole) text += text.empty() ? "not the bytes of its type" : ", and bytes that are not of its type";
  return one ? text : '{' + text + '}';
}

}  // namespace tessera
