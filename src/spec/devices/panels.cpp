#include "spec/devices/panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "spec/values/types.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {

using ControlKind = PanelControl::Kind;

namespace {

using diagnostics::in_quotes;

constexpr const char* panel_hint =
    "for example { panel: { turn: { stick_x: [-2, 2] }, forward: { stick_y: [-0.5, 0.5] }, horn: button } }";
constexpr const char* control_hint = "button, switch, slider, stick_x or stick_y, or { slider: [0, 0.5] }";
constexpr std::size_t most_controls = 32;
constexpr std::chrono::milliseconds shortest_stale{100}, longest_stale{5000};

constexpr std::array<std::pair<std::string_view, ControlKind>, 5> control_kinds{
    {{"button", ControlKind::button},
     {"switch", ControlKind::switch_over},
     {"slider", ControlKind::slider},
     {"stick_x", ControlKind::stick_x},
     {"stick_y", ControlKind::stick_y}}};

/// The name that the control of a buffer has that is no structure.
constexpr const char* only_field = "value";

/// A number or a bool that an operator can give.
struct Operable {
  std::string field;
  Type type;
};

/// Arrays and texts have no controls.
void add_operable(const std::string& field, const Type& type, const Model& model,
                  std::vector<Operable>& all) {
  if (type.extent > 0 || Types::is_unknown(type)) return;
  if (type.kind == Type::Kind::scalar) all.push_back({field.empty() ? only_field : field, type});
  if (type.kind != Type::Kind::structure || !model.structures.has(type.structure)) return;
  for (const Field& one : model.structures[type.structure].fields) {
    // A structure uses only earlier ones, unless there is a cycle, which another function reports.
    if (one.type.kind == Type::Kind::structure && one.type.structure >= type.structure) continue;
    add_operable(field.empty() ? one.name : field + "." + one.name, one.type, model, all);
  }
}

bool is_bool(const Type& type) { return type.scalar == Scalar::boolean; }
bool is_whole(const Type& type) {
  return !is_bool(type) && type.scalar != Scalar::float32 && type.scalar != Scalar::float64;
}

/// The limits of integers that a double represents exactly.
std::pair<double, double> range_of(Scalar scalar) {
  constexpr double most = 9007199254740992.0;
  switch (scalar) {
    case Scalar::int8:
      return {-128, 127};
    case Scalar::int16:
      return {-32768, 32767};
    case Scalar::int32:
      return {-2147483648.0, 2147483647.0};
    case Scalar::int64:
      return {-most, most};
    case Scalar::uint8:
      return {0, 255};
    case Scalar::uint16:
      return {0, 65535};
    case Scalar::uint32:
      return {0, 4294967295.0};
    case Scalar::uint64:
      return {0, most};
    case Scalar::float32:
      return {-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    default:
      return {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  }
}

std::string spelled(const Type& type) {
  return std::string(name_of(type.scalar)) + (type.unit.empty() ? "" : " " + type.unit);
}

class PanelReader {
 public:
  PanelReader(std::vector<Operable> operable, Diagnostics& out) : operable_(std::move(operable)), out_(out) {}

  /// node: what stands behind `panel`.
  std::vector<PanelControl> read(const Node& node, Span at, bool is_structure) {
    const bool all = node.is_null() || (node.is_map() && node.entries.empty()) || is_true(node);
    if (all) {
      give_all(at);
    } else if (!is_structure) {
      read_control(node, at, operable_.front());
    } else if (node.is_map()) {
      for (const Entry& entry : node.entries) read_field(entry);
    } else {
      out_.error("E104", at, "the controls of a panel must be a map, or true", panel_hint);
    }
    if (controls_.size() > most_controls)
      out_.error("E213", at,
                 "a panel has at most " + std::to_string(most_controls) + " controls, and this has " +
                     std::to_string(controls_.size()),
                 "name the fields that an operator needs; the others stay zero");
    return std::move(controls_);
  }

 private:
  void give_all(Span at) {
    for (const Operable& one : operable_)
      add(one, is_bool(one.type) ? ControlKind::button : ControlKind::slider, std::nullopt, at);
  }

  void read_field(const Entry& entry) {
    const auto found = std::ranges::find(operable_, entry.key, &Operable::field);
    if (found != operable_.end()) return read_control(*entry.value, entry.span, *found);
    std::vector<std::string> names;
    for (const Operable& one : operable_) names.push_back(one.field);
    Hint hint = did_you_mean(entry.key, names);
    if (hint.empty()) {
      hint.text = "there are ";
      for (const std::string& name : names) hint.text += (&name == &names.front() ? "" : ", ") + name;
    }
    out_.error("E101", entry.span, "the real buffer has no number or bool " + in_quotes(entry.key), hint);
  }

  /// at: of the field.
  void read_control(const Node& node, Span at, const Operable& field) {
    if (node.is_scalar()) {
      if (const auto kind = kind_of(node.text, node.span)) add(field, *kind, std::nullopt, at);
      return;
    }
    if (!node.is_map() || node.entries.size() != 1) {
      out_.error("E104", at, "a field of a panel needs one control", control_hint);
      return;
    }
    const Entry& only = node.entries.front();
    const auto kind = kind_of(only.key, only.span);
    if (!kind) return;
    if (!PanelControl{.kind = *kind}.is_number()) {
      out_.error("E104", only.span, "a " + only.key + " has no range", "write " + only.key + " alone");
      return;
    }
    if (is_bool(field.type)) return add(field, *kind, std::nullopt, at);
    if (const auto range = read_range(only, field.type)) add(field, *kind, range, at);
  }

  std::optional<ControlKind> kind_of(const std::string& text, Span at) {
    std::vector<std::string> names;
    for (const auto& [name, kind] : control_kinds) {
      if (name == text) return kind;
      names.emplace_back(name);
    }
    const Hint guess = did_you_mean(text, names);
    out_.error("E101", at, "unknown control " + in_quotes(text),
               guess.empty() ? "there are button, switch, slider, stick_x and stick_y" : guess);
    return std::nullopt;
  }

  using Range = std::pair<double, double>;
  std::optional<Range> read_range(const Entry& entry, const Type& type) {
    const Node& node = *entry.value;
    if (!node.is_sequence() || node.items.size() != 2) {
      out_.error("E104", entry.span, "a range must be two numbers", "for example " + entry.key + ": [-1, 1]");
      return std::nullopt;
    }
    const auto first = read_limit(*node.items[0], entry.span, type);
    const auto last = read_limit(*node.items[1], entry.span, type);
    if (!first || !last) return std::nullopt;
    if (*first < *last) return Range{*first, *last};
    out_.error("E213", node.items[0]->span, "the range of " + entry.key + " is empty or the wrong way round",
               "the smaller number comes first");
    return std::nullopt;
  }

  std::optional<double> read_limit(const Node& node, Span at, const Type& type) {
    const Node* const text = text_of(node, at, "a limit of a range", out_, control_hint);
    if (text == nullptr) return std::nullopt;
    const auto quantity = split_quantity(text->text);
    if (!quantity) {
      out_.error("E205", text->span, "a limit of a range must be a number, not " + in_quotes(text->text));
      return std::nullopt;
    }
    if (!quantity->unit.empty() && quantity->unit != type.unit) {
      out_.error("E208", text->span,
                 "unit " + in_quotes(quantity->unit) + " where the type is " + spelled(type),
                 "units are compared as they are written");
      return std::nullopt;
    }
    const auto [least, most] = range_of(type.scalar);
    if (quantity->number >= least && quantity->number <= most &&
        (!is_whole(type) || quantity->number == std::floor(quantity->number)))
      return quantity->number;
    out_.error("E213", text->span, in_quotes(text->text) + " is no value of type " + spelled(type));
    return std::nullopt;
  }

  void add(const Operable& field, ControlKind kind, std::optional<Range> range, Span at) {
    PanelControl one{.kind = kind, .field = field.field, .unit = field.type.unit};
    if (one.is_number() == is_bool(field.type)) {
      out_.error("E213", at,
                 "a " + std::string(name_of(kind)) + " does not fit " + in_quotes(field.field) +
                     ", which is " + spelled(field.type),
                 is_bool(field.type) ? "a bool has a button or a switch"
                                     : "a number has a slider, stick_x or stick_y");
      return;
    }
    one.whole = is_whole(field.type);
    if (one.is_number()) {
      const bool natural = range_of(field.type.scalar).first == 0;
      std::tie(one.minimum, one.maximum) = range.value_or(Range{natural ? 0 : -1, 1});
    }
    if (is_stick(kind) && !fits_stick(one, at)) return;
    controls_.push_back(std::move(one));
  }

  static bool is_stick(ControlKind kind) {
    return kind == ControlKind::stick_x || kind == ControlKind::stick_y;
  }

  bool fits_stick(const PanelControl& one, Span at) {
    if (one.minimum > 0 || one.maximum < 0) {
      out_.error("E213", at, "a stick springs back to zero, and zero is not in its range",
                 "give the range of a stick both signs, or use a slider");
      return false;
    }
    const auto other = std::ranges::find(controls_, one.kind, &PanelControl::kind);
    if (other == controls_.end()) return true;
    out_.error("E213", at,
               "a panel has one " + std::string(name_of(one.kind)) + ", and " + in_quotes(other->field) +
                   " has it already",
               "a second stick is the panel of a second real buffer");
    return false;
  }

  std::vector<Operable> operable_;
  Diagnostics& out_;
  std::vector<PanelControl> controls_;
};

}  // namespace

std::string_view name_of(ControlKind kind) {
  return std::ranges::find(control_kinds, kind, [](const auto& one) { return one.second; })->first;
}

Panel read_panel(const Entry& entry, const Type& type, const Model& model, Diagnostics& out) {
  Panel panel;
  const Section section(*entry.value, entry.span, "a panel", {"panel", "stale"}, out);
  const Entry* const controls = section.find("panel");
  std::vector<Operable> operable;
  add_operable("", type, model, operable);
  if (operable.empty()) {
    if (!Types::is_unknown(type))
      out.error("E210", entry.span, "driver 'panel' needs a number or a bool that an operator can give",
                "arrays and texts have no controls");
  } else if (controls != nullptr) {
    panel.controls = PanelReader(std::move(operable), out)
                         .read(*controls->value, controls->span, type.kind == Type::Kind::structure);
  }
  if (const Entry* const stale = section.find("stale")) {
    panel.stale = read_duration(*stale->value, stale->span, "stale", out).value_or(panel.stale);
    if (panel.stale < shortest_stale)
      out.error("E206", stale->value->span, "an input of an operator counts for at least 100 ms",
                "a page repeats its inputs, but not more often than it can");
    if (panel.stale > longest_stale)
      out.error("E206", stale->value->span, "an input of an operator counts for at most 5 s",
                "the robot goes on for so long when the operator is gone");
  }
  return panel;
}

}  // namespace tessera::spec
