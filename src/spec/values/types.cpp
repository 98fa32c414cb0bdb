#include "spec/values/types.hpp"

#include <algorithm>
#include <array>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/document/type_text.hpp"
#include "spec/model/structure_order.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// Names of our types in other languages.
struct Synonym {
  std::string_view theirs, ours;
};
constexpr std::array synonyms = {
    Synonym{"double", "float64"}, Synonym{"float", "float32"},   Synonym{"int", "int32"},
    Synonym{"long", "int64"},     Synonym{"unsigned", "uint32"}, Synonym{"char", "int8"},
    Synonym{"byte", "uint8"},     Synonym{"boolean", "bool"},    Synonym{"str", "string"},
    Synonym{"text", "string"},    Synonym{"number", "float64"}};

/// The status of a buffer stands beside the fields of its value: in.line.left, in.line.fresh.
constexpr std::array status_names = std::to_array<std::string_view>(
    {"fresh", "age", "stamp", "timed_out", "valid", "failed", "disconnected"});
constexpr std::array generated_types =
    std::to_array<std::string_view>({"Context", "Inputs", "Outputs", "Memory", "Parameters", "Real"});

constexpr std::uint64_t largest_type = std::uint64_t{256} * 1024 * 1024;

template <std::size_t N>
std::optional<std::size_t> index_of(const std::array<std::string_view, N>& words, std::string_view word) {
  const auto* const found = std::find(words.begin(), words.end(), word);
  return found == words.end() ? std::nullopt
                              : std::optional<std::size_t>(static_cast<std::size_t>(found - words.begin()));
}

bool is_built_in(std::string_view name) {
  return name == "string" || index_of(scalar_names, name).has_value();
}

bool has_unit(const Type& type) { return type.kind == Type::Kind::scalar && type.scalar != Scalar::boolean; }

/// Saturates well above the limit.
std::uint64_t bytes_of(const Type& type, const Numbered<StructureId, std::uint64_t>& structures) {
  std::uint64_t one = std::uint64_t{type.capacity} + 4;
  if (type.kind == Type::Kind::scalar) one = bytes_of(type.scalar);
  if (type.kind == Type::Kind::structure)
    one = structures.has(type.structure) ? structures[type.structure] : 0;
  const std::uint64_t extent = std::max<std::uint64_t>(type.extent, 1);
  if (type.is_sequence) one = std::min(one + 1, largest_type);  // its length, at most
  return one > largest_type / extent ? largest_type + 1 : one * extent;
}

}  // namespace

Type Types::unknown() {
  Type type;
  type.kind = Type::Kind::structure;
  return type;
}

bool Types::is_unknown(const Type& type) {
  return type.kind == Type::Kind::structure && !type.structure.valid();
}

const std::vector<Field>& Types::fields_of(const Type& type) const {
  static const std::vector<Field> none;
  const bool known = type.kind == Type::Kind::structure && structures_.has(type.structure);
  return known ? structures_[type.structure].fields : none;
}

void Types::read(const Entry* section, Diagnostics& out) {
  known_names_.assign(scalar_names.begin(), scalar_names.end());
  known_names_.emplace_back("string");
  if (section == nullptr) return;
  const std::vector<Entry>& entries = entries_of(*section->value, section->span, "types", out);
  for (const Entry& entry : entries) {
    check_name(entry.key, entry.span, "type", out);
    if (is_built_in(entry.key)) {
      out.error("E107", entry.span, "type " + in_quotes(entry.key) + " is built in");
    } else if (index_of(generated_types, entry.key)) {
      out.error("E106", entry.span, "type name " + in_quotes(entry.key) + " is taken by the generated code");
    }
    by_name_.emplace(entry.key, structures_.next_id());
    known_names_.push_back(entry.key);
    structures_.push_back({entry.key, {}, entry.span});
  }
  for (std::size_t i = 0; i < entries.size(); ++i) read_fields(entries[i], structures_[i], out);
  if (!sort(out)) return;
  check_size(out);
}

void Types::read_fields(const Entry& entry, Structure& structure, Diagnostics& out) const {
  const std::string what = "type " + in_quotes(entry.key);
  const auto& fields = entries_of(*entry.value, entry.span, what, out);
  if (fields.empty() && (entry.value->is_map() || entry.value->is_null())) {
    out.error("E104", entry.span, what + " needs at least one field", "for example { value: float64 }");
  }
  for (const Entry& field : fields) {
    if (index_of(status_names, field.key)) {
      out.error("E106", field.span,
                "field name " + in_quotes(field.key) + " is reserved for the status of a buffer",
                "for example '" + field.key + "_value'");
    } else if (field.key == entry.key) {
      out.error("E107", field.span, "field " + in_quotes(field.key) + " has the name of its type",
                "begin types with a capital letter");
    } else {
      check_name(field.key, field.span, "field", out);
    }
    structure.fields.push_back({field.key, parse(*field.value, field.span, out), {}, field.span});
  }
}

bool Types::sort(Diagnostics& out) {
  const StructureOrder order = order_structures(structures_);
  for (const std::vector<StructureId>& cycle : order.cycles) {
    std::string names;
    for (const StructureId one : cycle) names += structures_[one].name + " -> ";
    const Structure& first = structures_[cycle.front()];
    out.error("E202", first.span, "type " + in_quotes(first.name) + " contains itself: " + names + first.name,
              "a structure has a fixed size, so it cannot hold one of its own kind");
  }
  if (!order.cycles.empty()) return false;
  structures_ = reordered(std::move(structures_), order.sorted);
  for (const StructureId i : structures_.ids()) by_name_[structures_[i].name] = i;
  return true;
}

void Types::check_size(Diagnostics& out) const {
  Numbered<StructureId, std::uint64_t> sizes;
  for (const Structure& structure : structures_) {
    std::uint64_t size = 0;
    for (const Field& field : structure.fields) {
      size = std::min(size + bytes_of(field.type, sizes), largest_type + 1);
    }
    if (size > largest_type) {
      out.error("E204", structure.span, "type " + in_quotes(structure.name) + " is larger than 256 MB");
      return;
    }
    sizes.push_back(size);
  }
}

Type Types::parse(const Node& node, Span at, Diagnostics& out) const {
  const Node* text = text_of(node, at, "a type", out, "for example float64 m/s");
  if (text == nullptr) return unknown();
  const auto parts = split_type(*text, out);
  if (!parts) return unknown();
  Type type;
  type.extent = parts->extent;
  type.is_sequence = parts->is_sequence;
  type.unit = parts->unit;
  if (const auto scalar = index_of(scalar_names, parts->name)) {
    type.scalar = static_cast<Scalar>(*scalar);
  } else if (parts->name == "string") {
    type.kind = Type::Kind::string;
    if (parts->capacity) type.capacity = *parts->capacity;
  } else {
    type.kind = Type::Kind::structure;
    const auto found = by_name_.find(parts->name);
    if (found == by_name_.end()) {
      const auto* const synonym = std::find_if(synonyms.begin(), synonyms.end(),
                                               [&](const Synonym& one) { return one.theirs == parts->name; });
      out.error("E101", parts->name_span, "unknown type " + in_quotes(parts->name),
                synonym != synonyms.end() ? "here it is called " + std::string(synonym->ours)
                                          : did_you_mean(parts->name, known_names_));
      return unknown();
    }
    type.structure = found->second;
  }
  if (!type.unit.empty() && !has_unit(type)) {
    out.error("E201", parts->unit_span, "unit " + in_quotes(type.unit) + " on a type that is no number");
  } else if (bytes_of(type, {}) > largest_type) {
    out.error("E204", text->span, "an array larger than 256 MB");
  } else {
    return type;
  }
  return unknown();
}

bool Types::holds_floats(const Type& type) const {
  if (type.kind == Type::Kind::scalar)
    return type.scalar == Scalar::float32 || type.scalar == Scalar::float64;
  if (type.kind != Type::Kind::structure || !structures_.has(type.structure)) return false;
  // A structure uses only earlier ones, unless there is a cycle, which another function reports.
  return std::ranges::any_of(structures_[type.structure].fields, [&](const Field& field) {
    const bool cycle = field.type.kind == Type::Kind::structure && field.type.structure >= type.structure;
    return !cycle && holds_floats(field.type);
  });
}

std::string Types::spelled(const Type& type) const {
  std::string text(name_of(type.scalar));
  if (type.kind == Type::Kind::string) text = "string<=" + std::to_string(type.capacity);
  if (type.kind == Type::Kind::structure) text = is_unknown(type) ? "?" : structures_[type.structure].name;
  if (type.extent > 0)
    text += type.is_sequence ? "<=" + std::to_string(type.extent) : "[" + std::to_string(type.extent) + "]";
  return type.unit.empty() ? text : text + " " + type.unit;
}

}  // namespace tessera::spec
