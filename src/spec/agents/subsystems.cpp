#include "spec/agents/subsystems.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "spec/agents/buffers.hpp"
#include "spec/agents/limits.hpp"
#include "spec/agents/policies.hpp"
#include "spec/agents/safe_commands.hpp"
#include "spec/behaviours/behaviour_flow.hpp"
#include "spec/behaviours/behaviours.hpp"
#include "spec/behaviours/conditions.hpp"
#include "spec/behaviours/groups.hpp"
#include "spec/document/section.hpp"
#include "spec/memory/few_values.hpp"
#include "spec/memory/goals.hpp"
#include "spec/model/endings.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// A key that only some kinds of subsystems have.
struct SpecialKey {
  std::string_view name;
  bool receptors;
  std::string_view owners;
};
constexpr std::array special_keys = {
    SpecialKey{"real", true, "receptors and effectors"}, SpecialKey{"safe", false, "effectors"},
    SpecialKey{"limits", false, "effectors"}, SpecialKey{"stale", false, "effectors"},
    SpecialKey{"recovery", false, "effectors"}};

void check_kind(const Section& section, SubsystemKind kind, Diagnostics& out) {
  for (const SpecialKey& key : special_keys) {
    const Entry* entry = section.find(key.name);
    const bool allowed =
        kind == SubsystemKind::effector || (kind == SubsystemKind::receptor && key.receptors);
    if (entry == nullptr || allowed) continue;
    out.error("E110", entry->span,
              in_quotes(key.name) + " belongs to " + std::string(key.owners) + ", this is a " +
                  std::string(name_of(kind)) + (kind == SubsystemKind::control ? " subsystem" : ""));
  }
}

BehaviourId read_start(const Entry* entry, const Numbered<BehaviourId, Behaviour>& behaviours,
                       Diagnostics& out) {
  if (entry == nullptr) return {0};
  const Node* text = text_of(*entry->value, entry->span, "start", out, "name a behaviour");
  if (text == nullptr) return {0};
  const auto name = read_indexed(*text, 0, out);
  if (!name) return {0};
  const auto found = std::ranges::find_if(behaviours, [&](const Behaviour& one) {
    return !one.parent.valid() && (one.member ? one.member->family : one.name) == name->name;
  });
  if (found == behaviours.end()) {
    const auto inner = std::ranges::find_if(behaviours, [&](const Behaviour& one) {
      return one.parent.valid() && (one.name == text->text || one.label() == name->name);
    });
    if (inner != behaviours.end()) {
      BehaviourId group = inner->parent;
      while (behaviours[group].parent.valid()) group = behaviours[group].parent;
      out.error("E345", text->span,
                in_quotes(text->text) + " is in group " + in_quotes(behaviours[group].name),
                "a group is entered at its beginning: write " + behaviours[group].name +
                    ", and 'start' in the group");
      return {0};
    }
    std::vector<std::string> names = written_names(behaviours);
    // Those in groups begin with the group.
    std::erase_if(names, [](const std::string& one) { return one.find('.') != std::string::npos; });
    out.error("E101", text->span, "unknown behaviour " + in_quotes(name->name),
              did_you_mean(name->name, names));
    return {0};
  }
  const auto first = static_cast<std::uint32_t>(found - behaviours.begin());
  if (!found->member) {
    static_cast<void>(check_single(*name, "behaviour", out));
    return {first};
  }
  return {first + number_of(*name, *found->member, nullptr, "behaviour", out).value_or(0)};
}

void check_shadowing(const std::vector<Parameter>& own, const std::vector<Parameter>& system,
                     Diagnostics& out) {
  for (const Parameter& parameter : own) {
    const auto outer = std::find_if(system.begin(), system.end(),
                                    [&](const Parameter& one) { return one.name == parameter.name; });
    if (outer == system.end()) continue;
    out.error("E107", parameter.span,
              "parameter " + in_quotes(parameter.name) + " is one of the system already",
              "the first is on " + out.words(outer->span.line));
  }
}

/// If a device is to keep its last command, the author has to say so.
void read_stale(const Entry* stale, Subsystem& subsystem, Diagnostics& out) {
  if (stale != nullptr && stale->value->is_scalar() && stale->value->text == "never") return;
  if (stale != nullptr) {
    subsystem.stale = read_duration(*stale->value, stale->span, "stale", out);
  } else if (subsystem.kind == SubsystemKind::effector && !subsystem.real.empty() &&
             !subsystem.inputs.empty()) {
    out.warning("W324", subsystem.span,
                "effector " + in_quotes(subsystem.name) +
                    " goes on with its last command when no values come any more",
                "'stale: 500 ms' gives the safe command when an input has had no valid value for so long; "
                "'stale: never' says that it shall go on");
  }
}

/// `send` or `receive` of the subsystem, if it is a list.
ListDefault read_list(const Entry* entry, const ListScope& scope, Diagnostics& out) {
  ListDefault none;
  const Entry* list = entry == nullptr ? nullptr : list_of(*entry);
  if (list == nullptr) return none;
  if (entry->value->is_map() && scope.what == "output") {
    out.error("E331", entry->span, "'send' of a subsystem is a list: only a behaviour says when it sends",
              "write the map under 'send' of the behaviour, such as send: { NAME: { when: CONDITION } }");
    return none;
  }
  ListDefault read;
  read.entry = entry;
  read.list = read_buffer_list(*list->value, *list, scope, none, out);
  return read;
}

SubsystemDefaults read_defaults(const Section& section, const ConditionScope& scope, Diagnostics& out) {
  SubsystemDefaults defaults;
  defaults.send = read_list(section.find("send"), {scope.outputs, scope.inputs, "output"}, out);
  defaults.receive = read_list(section.find("receive"), {scope.inputs, scope.outputs, "input"}, out);
  defaults.conditions = read_shared_conditions(section.find("conditions"), scope, out);
  return defaults;
}

void check_used(const SubsystemDefaults& defaults, Diagnostics& out) {
  check_used(defaults.send, out);
  check_used(defaults.receive, out);
  check_used(defaults.conditions, out);
}

/// Completes every `next` by `on_error`, and by the entries that are implied.
///
/// The behaviour that `on_error` names does not lead its own failures to itself: it is what is left when something
/// fails, and would hide that it fails, too.
void read_failures(const Section& section, const SystemScope& around, Subsystem& subsystem,
                   std::vector<std::optional<OnError>>& of_groups, Diagnostics& out) {
  complete_groups(subsystem, of_groups, out);
  std::optional<OnError> own = read_on_error(section, out);
  OnError* on_error = own ? &*own : around.on_error;
  if (on_error != nullptr) {
    const BehaviourId to = resolve_on_error(*on_error, {}, own.has_value(), subsystem, out);
    if (to.valid()) {
      const Next entry = entry_for_errors(to, on_error->span, subsystem, out);
      for (const BehaviourId from : subsystem.behaviours.ids())
        if (from != to && !subsystem.behaviours[from].parent.valid() &&
            lead_failures(subsystem.behaviours[from], entry))
          on_error->used = true;
    }
  }
  if (own) check_used(*own, out);
  for (Behaviour& behaviour : subsystem.behaviours) complete_next(behaviour);
}

}  // namespace

std::string_view name_of(SubsystemKind kind) {
  switch (kind) {
    case SubsystemKind::control:
      return "control";
    case SubsystemKind::receptor:
      return "receptor";
    case SubsystemKind::effector:
      break;
  }
  return "effector";
}

Subsystem read_subsystem(const Entry& entry, SubsystemKind kind, const SystemScope& around,
                         Diagnostics& out) {
  const Section section(
      *entry.value, entry.span, "a subsystem",
      {"rate", "inputs",  "outputs",  "memory",     "parameters", "start",      "behaviours",
       "real", "safe",    "limits",   "stale",      "recovery",   "overrun",    "overtime",
       "send", "receive", "on_error", "conditions", "watchdog",   "non_finite", "realtime"},
      out);
  check_kind(section, kind, out);
  Subsystem subsystem;
  subsystem.kind = kind;
  subsystem.name = entry.key;
  subsystem.span = entry.span;
  if (const Entry* rate = section.find("rate")) {
    // A rate that cannot be read is still a rate, so that no error about standing time follows from it.
    subsystem.period = read_rate(*rate->value, rate->span, out).value_or(std::chrono::seconds(1));
  }
  subsystem.inputs = read_buffers(section.find("inputs"), "input", around.types, around.fleets, out);
  subsystem.outputs = read_buffers(section.find("outputs"), "output", around.types, around.fleets, out);
  subsystem.real = read_buffers(section.find("real"), "real buffer", around.types, around.fleets, out);
  if (kind == SubsystemKind::receptor) check_distinct({&subsystem.inputs, &subsystem.real}, out);
  if (kind == SubsystemKind::effector) check_distinct({&subsystem.outputs, &subsystem.real}, out);
  subsystem.memory = read_memory(section.find("memory"), {subsystem.inputs, subsystem.outputs, around.types},
                                 around.fleets, out);
  subsystem.parameters = read_parameters(section.find("parameters"), around.types, out);
  check_shadowing(subsystem.parameters, around.parameters, out);
  read_policies(section, subsystem, out);
  if (kind == SubsystemKind::effector) {
    read_limits(section.find("limits"), section.find("safe"), around.types, subsystem, out);
    read_safe(section.find("safe"), around.types, subsystem, out);
  }
  read_stale(section.find("stale"), subsystem, out);
  if (const Entry* behaviours = section.require("behaviours", "for example behaviours: { run: {} }")) {
    const ConditionScope scope{kind,
                               subsystem.inputs,
                               subsystem.outputs,
                               subsystem.real,
                               subsystem.memory,
                               subsystem.parameters,
                               around.parameters,
                               around.types};
    SubsystemDefaults defaults = read_defaults(section, scope, out);
    const std::size_t errors = out.error_count();
    ReadBehaviours read = read_behaviours(*behaviours, scope, defaults, around.fleets, around.groups, out);
    subsystem.behaviours = std::move(read.behaviours);
    check_overtime(section, subsystem, out);
    // A list or name with a mistake may have been meant to use a default.
    if (out.error_count() == errors) check_used(defaults, out);
    read_failures(section, around, subsystem, read.on_error, out);
    subsystem.start = read_start(section.find("start"), subsystem.behaviours, out);
    check_start(subsystem, out);
    check_behaviour_flow(subsystem, out);
    check_counters(subsystem, out);
    check_goals(subsystem, out);
  }
  return subsystem;
}

}  // namespace tessera::spec
