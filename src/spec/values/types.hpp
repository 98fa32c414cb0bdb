#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The types of one specification: the built-in ones and its own structures.
class Types {
 public:
  /// Reads the section `types`; null: there is none.
  ///
  /// Errors: E101 unknown type, E105/E106/E107 names, E201 no type, E202 a structure
  ///         contains itself, E204 too large.
  void read(const Entry* section, Diagnostics& out);

  /// The type that a scalar names: "float64 m/s", "string<=64", "Point[8]", "Point<=8". After
  /// an error: the unknown type.
  [[nodiscard]] Type parse(const Node& node, Span at, Diagnostics& out) const;

  /// As people write it, with the unit.
  [[nodiscard]] std::string spelled(const Type& type) const;

  /// Each uses only earlier ones, unless one contains itself.
  [[nodiscard]] const Numbered<StructureId, Structure>& structures() const { return structures_; }

  /// The fields of the structure that `type` names, or of its elements. Empty for a type without fields, and
  /// for an unknown type.
  [[nodiscard]] const std::vector<Field>& fields_of(const Type& type) const;

  /// Whether a value of the type has floating-point numbers.
  [[nodiscard]] bool holds_floats(const Type& type) const;

  /// Stands for a type that could not be read, so that no second error follows from the first. It is a structure
  /// without number: only fields_of may ask for its fields.
  [[nodiscard]] static Type unknown();
  [[nodiscard]] static bool is_unknown(const Type& type);

 private:
  void read_fields(const Entry& entry, Structure& structure, Diagnostics& out) const;
  /// Returns false if there are cycles.
  bool sort(Diagnostics& out);
  void check_size(Diagnostics& out) const;

  Numbered<StructureId, Structure> structures_;
  std::unordered_map<std::string, StructureId> by_name_;
  std::vector<std::string> known_names_;  ///< built-in ones first, for hints
};

}  // namespace tessera::spec
