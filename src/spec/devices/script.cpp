#include "spec/devices/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/agents/paths.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* script_hint = "for example { at: 3 s, set: office.console.panel.pause, to: true }";

/// The length of AGENT.SUBSYSTEM.BUFFER, behind which a field may follow; an index may have dots of no meaning.
std::size_t buffer_length(const std::string& text) {
  std::size_t dots = 0;
  for (std::size_t at = 0; at < text.size(); ++at)
    if (text[at] == '.' && ++dots == 3) return at;
  return text.size();
}

class ScriptReader {
 public:
  ScriptReader(const Model& model, const AgentGroups& groups, std::vector<Driver>& drivers, Diagnostics& out)
      : lookup_(model, groups), drivers_(drivers), out_(out) {}

  void read(const Entry& entry) {
    for (const Node* item : items_of(*entry.value, entry.span, "the script", out_))
      read_one(*item, item->is_null() ? entry.span : item->span);
  }

 private:
  void read_one(const Node& node, Span at) {
    const Section section(node, at, "an entry of the script", {"at", "set", "to"}, out_);
    if (!section.readable()) return;
    const Entry* const time = section.require("at", script_hint);
    const Entry* const path = section.require("set", script_hint);
    const Entry* const value = section.require("to", script_hint);
    const std::optional<Duration> moment =
        time == nullptr ? std::nullopt : read_moment(*time->value, time->span, "at", out_);
    if (moment && !is_later(*moment, time->value->span)) return;
    if (moment && path != nullptr && value != nullptr) read_step(*moment, *path, *value);
  }

  bool is_later(Duration moment, Span at) {
    if (last_ && moment < *last_) {
      out_.error("E283", at, "this time is before that of the entry above",
                 fmt::format("the entries stand in the order of their times; the one above is at line {}",
                             last_line_));
      return false;
    }
    last_ = moment;
    last_line_ = at.line;
    return true;
  }

  void read_step(Duration moment, const Entry& path_entry, const Entry& value) {
    const Node* const text = text_of(*path_entry.value, path_entry.span, "a path", out_, script_hint);
    if (text == nullptr) return;
    const std::size_t length = buffer_length(text->text);
    const auto path = split_path(*text, 0, length, out_);
    PathTarget target;
    KnownUpTo known = KnownUpTo::nothing;
    if (!path || !lookup_.find(*path, target, known, out_)) return;
    if (path->selector.kind == Selector::Kind::variable) {
      out_.error("E112", path->index_span, "an entry of the script is for one agent or all",
                 "write [3] or [*]");
      return;
    }
    const RealId real =
        lookup_.find_buffer(*path, target, lookup_.subsystem(target).real, "real buffer", out_);
    if (!real.valid()) return;
    const std::string field = length < text->text.size() ? text->text.substr(length + 1) : "";
    const bool all = path->selector.kind == Selector::Kind::all;
    const std::uint32_t first = path->selector.kind == Selector::Kind::constant
                                    ? static_cast<std::uint32_t>(path->selector.number)
                                    : 0;
    const std::uint32_t last = all ? target.group->count : first + 1;
    for (std::uint32_t number = first; number < last; ++number)
      if (!add(moment, lookup_.instance(target, number), real, field, *text, value)) return;
  }

  /// false: a mistake, which all members of a fleet have.
  bool add(Duration moment, InstanceId instance, RealId real, const std::string& field, const Node& path,
           const Entry& value) {
    const auto driver = std::ranges::find_if(drivers_, [&](const Driver& one) {
      return one.instance == instance && one.real == real && one.panel;
    });
    if (driver == drivers_.end()) {
      out_.error("E281", path.span, "there is no panel in the simulation that could be set here",
                 "give the real buffer one: simulation: drivers: { " + path_of(instance, real) +
                     ": { panel: true } }");
      return false;
    }
    const std::string wanted = field.empty() ? "value" : field;
    const auto control = std::ranges::find(driver->panel->controls, wanted, &PanelControl::field);
    if (control == driver->panel->controls.end()) {
      complain_of_control(*driver->panel, field, path);
      return false;
    }
    if (const auto given = value_of(value, *control)) {
      driver->panel->script.push_back({moment, wanted, *given});
      return true;
    }
    return false;
  }

  [[nodiscard]] std::string path_of(InstanceId instance, RealId real) const {
    return lookup_.model().instance_path(instance) + "." +
           lookup_.model().subsystem(instance).real[real].name;
  }

  void complain_of_control(const Panel& panel, const std::string& field, const Node& path) {
    std::vector<std::string> names;
    for (const PanelControl& one : panel.controls) names.push_back(one.field);
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    if (panel.controls.empty()) return;  // reported with the panel
    if (field.empty()) {
      out_.error("E101", path.span, "this names a panel, not one of its controls", "it has " + list);
      return;
    }
    const std::size_t begin = path.text.size() - field.size();
    const Hint guess = did_you_mean(field, names);
    out_.error("E101", path.part(begin, field.size()), "the panel has no control " + in_quotes(field),
               guess.empty() ? Hint("it has " + list) : guess);
  }

  /// As the panel takes it from an operator.
  std::optional<std::variant<double, bool>> value_of(const Entry& entry, const PanelControl& control) {
    const Node& node = *entry.value;
    if (!control.is_number()) {
      if (is_true(node) || is_false(node)) return is_true(node);
      if (text_of(node, entry.span, "the value", out_, "write true or false") != nullptr)
        out_.error("E282", node.span,
                   in_quotes(control.field) + " is true or false, not " + in_quotes(node.text),
                   "write true or false");
      return std::nullopt;
    }
    const Node* const text = text_of(node, entry.span, "the value", out_, "write a number");
    if (text == nullptr) return std::nullopt;
    const auto quantity = text->quoted ? std::nullopt : split_quantity(text->text);
    if (!quantity) {
      out_.error("E282", text->span, in_quotes(control.field) + " is a number, not " + in_quotes(text->text));
      return std::nullopt;
    }
    if (!quantity->unit.empty() && quantity->unit != control.unit) {
      out_.error("E282", text->span,
                 control.unit.empty() ? in_quotes(control.field) + " has no unit"
                                      : in_quotes(control.field) + " is in " + control.unit,
                 "units are compared as they are written");
      return std::nullopt;
    }
    if (control.whole && quantity->number != std::floor(quantity->number)) {
      out_.error("E282", text->span, in_quotes(control.field) + " is a whole number");
      return std::nullopt;
    }
    if (quantity->number >= control.minimum && quantity->number <= control.maximum) return quantity->number;
    out_.error(
        "E282", text->span,
        fmt::format("{} goes from {} to {}", in_quotes(control.field), control.minimum, control.maximum),
        "the panel has this range");
    return std::nullopt;
  }

  PathLookup lookup_;
  std::vector<Driver>& drivers_;
  Diagnostics& out_;
  std::optional<Duration> last_;
  std::uint32_t last_line_ = 0;
};

}  // namespace

void read_script(const Entry* entry, const Model& model, const AgentGroups& groups,
                 std::vector<Driver>& drivers, Diagnostics& out) {
  if (entry != nullptr) ScriptReader(model, groups, drivers, out).read(*entry);
}

}  // namespace tessera::spec
