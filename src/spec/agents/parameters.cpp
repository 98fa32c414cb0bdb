#include <charconv>
#include <cstdint>

#include "diagnostics/utf8.hpp"
#include "spec/agents/buffers.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/document/type_text.hpp"
#include "spec/values/literals.hpp"
#include "spec/values/quantities.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// Elements of an array: it is stored in place, and given on a command line.
constexpr std::uint64_t largest_array = 256;

Type not_a_unit(Span at, std::string_view text, Diagnostics& out) {
  out.error("E201", at, in_quotes(text) + " is not a unit", "for example m/s");
  return Types::unknown();
}

/// The type of a value without an explicit type: a number is a float64, quoted text a string.
Type shown_type(const Node& value, Diagnostics& out) {
  Type type;
  if (is_true(value) || is_false(value)) {
    type.scalar = Scalar::boolean;
  } else if (value.quoted) {
    type.kind = Type::Kind::string;
  } else if (const auto quantity = split_quantity(value.text)) {
    if (!is_unit(quantity->unit)) return not_a_unit(value.span, quantity->unit, out);
    type.unit = quantity->unit;
  } else {
    out.error("E203", value.span, in_quotes(value.text) + " is no number, true or false",
              is_old_boolean(value) ? "write true or false" : "put text in quotes");
    return Types::unknown();
  }
  return type;
}

/// A parameter written as a map.
class LongForm {
 public:
  LongForm(const Entry& entry, const Types& types, Diagnostics& out)
      : section_(*entry.value, entry.span, "a parameter", {"type", "default", "min", "max", "unit"}, out),
        types_(types),
        out_(out) {
    read_type(entry);
    read_unit();
    read_default();
    minimum_ = bound("min");
    maximum_ = bound("max");
    check_range();
  }

  void store(Parameter& parameter) const {
    parameter.type = type_;
    parameter.initial = initial_;
    parameter.minimum = minimum_;
    parameter.maximum = maximum_;
  }

 private:
  void read_type(const Entry& entry) {
    const Entry* given = section_.find("type");
    default_ = section_.require("default", "for example { type: int32, default: 3, min: 0, max: 9 }");
    if (given != nullptr) {
      type_ = types_.parse(*given->value, given->span, out_);
      check_type(entry.key, given->value->span);
    } else if (default_ != nullptr && default_->value->is_scalar()) {
      type_ = shown_type(*default_->value, out_);
    }
  }

  void check_type(const std::string& name, Span at) {
    if (Types::is_unknown(type_)) return;
    if (type_.kind == Type::Kind::structure || type_.is_sequence ||
        (type_.extent > 0 && type_.kind == Type::Kind::string)) {
      out_.error("E203", at,
                 "parameter " + in_quotes(name) + " must be a number, bool, string, or an array of numbers",
                 type_.is_sequence ? "give it a fixed length, such as float64[4]"
                                   : "give every field a parameter of its own");
    } else if (type_.extent > largest_array) {
      out_.error(
          "E204", at,
          "parameter " + in_quotes(name) + " has more than " + std::to_string(largest_array) + " elements",
          "a transition function can read a large table from a file");
    } else {
      return;
    }
    type_ = Types::unknown();
  }

  /// A number, or an array of numbers.
  [[nodiscard]] bool is_number() const {
    return type_.kind == Type::Kind::scalar && type_.scalar != Scalar::boolean;
  }

  [[nodiscard]] Type element() const { return type_.element(); }

  void read_unit() {
    const Entry* unit = section_.find("unit");
    if (unit == nullptr || Types::is_unknown(type_)) return;
    const Node* text = text_of(*unit->value, unit->span, "a unit", out_);
    if (text == nullptr) return;
    if (!is_number()) {
      out_.error("E201", text->span, "unit " + in_quotes(text->text) + " on a type that is no number");
    } else if (!is_unit(text->text)) {
      type_ = not_a_unit(text->span, text->text, out_);
    } else if (!type_.unit.empty() && type_.unit != text->text) {
      out_.error("E208", text->span,
                 "unit " + in_quotes(text->text) + " where the type is " + types_.spelled(type_),
                 "give the unit once");
    } else {
      type_.unit = text->text;
    }
  }

  void read_default() {
    if (default_ == nullptr) return;
    initial_ = initialiser(*default_->value, default_->span, type_, types_, "the default", out_).value_or("");
  }

  std::optional<double> bound(std::string_view key) {
    const Entry* entry = section_.find(key);
    if (entry == nullptr || Types::is_unknown(type_)) return std::nullopt;
    if (!is_number()) {
      out_.error("E203", entry->span, "only a number has a range");
      return std::nullopt;
    }
    if (!initialiser(*entry->value, entry->span, element(), types_, std::string(key), out_))
      return std::nullopt;
    return split_quantity(entry->value->text)->number;
  }

  void check_range() {
    if (minimum_ && maximum_ && *minimum_ > *maximum_) {
      out_.error("E204", section_.find("min")->value->span, "min is greater than max");
      return;
    }
    if (default_ == nullptr || initial_.empty() || !is_number()) return;
    if (type_.extent == 0) return check_value(*default_->value);
    for (const Node* item : default_->value->items) check_value(*item);
  }

  void check_value(const Node& node) {
    const double value = split_quantity(node.text)->number;
    if ((!minimum_ || value >= *minimum_) && (!maximum_ || value <= *maximum_)) return;
    out_.error("E204", node.span, "the default " + in_quotes(node.text) + " is outside min .. max");
  }

  Section section_;
  const Types& types_;
  Diagnostics& out_;
  const Entry* default_ = nullptr;
  Type type_ = Types::unknown();
  std::string initial_;
  std::optional<double> minimum_, maximum_;
};

Parameter read_parameter(const Entry& entry, const Types& types, Diagnostics& out) {
  Parameter parameter{entry.key, Types::unknown(), {}, {}, {}, entry.span};
  if (entry.value->is_map()) {
    LongForm(entry, types, out).store(parameter);
  } else if (const Node* value = entry.value; value->is_scalar()) {
    parameter.type = shown_type(*value, out);
    parameter.initial =
        initialiser(*value, entry.span, parameter.type, types, "the default", out).value_or("");
  } else {
    out.error("E104", entry.span, "a parameter must be a value or a map",
              entry.value->is_sequence() ? "write { type: \"float64[3]\", default: [1, 2, 3] }"
                                         : "for example 0.2 m/s, or { type: int32, default: 3 }");
  }
  return parameter;
}

}  // namespace

std::vector<Parameter> read_parameters(const Entry* entry, const Types& types, Diagnostics& out) {
  std::vector<Parameter> parameters;
  if (entry == nullptr) return parameters;
  for (const Entry& parameter : entries_of(*entry->value, entry->span, "parameters", out)) {
    check_name(parameter.key, parameter.span, "parameter", out);
    parameters.push_back(read_parameter(parameter, types, out));
  }
  return parameters;
}

}  // namespace tessera::spec
