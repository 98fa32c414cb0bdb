#include "spec/agents/definitions.hpp"

#include <algorithm>
#include <optional>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

void read_group(const Entry* section, SubsystemKind kind, const SystemScope& around, Definition& definition,
                Diagnostics& out) {
  if (section == nullptr) return;
  for (const Entry& entry : entries_of(*section->value, section->span, section->key, out)) {
    const auto& known = definition.subsystems;
    const auto first = std::find_if(known.begin(), known.end(),
                                    [&entry](const Subsystem& one) { return one.name == entry.key; });
    if (entry.key == "control") {
      out.error("E106", entry.span,
                std::string(name_of(kind)) + " name 'control' is reserved for the control subsystem");
    } else if (check_name(entry.key, entry.span, name_of(kind), out) && first != known.end()) {
      out.error("E107", entry.span, "subsystem " + in_quotes(entry.key) + " exists already",
                "the first is on " + out.words(first->span.line));
    }
    definition.subsystems.push_back(read_subsystem(entry, kind, around, out));
  }
}

}  // namespace

Definition read_definition(const Entry& entry, bool is_template, const SystemScope& around,
                           Diagnostics& out) {
  const Section section(*entry.value, entry.span, is_template ? "a template" : "an agent",
                        {"control", "receptors", "effectors", "on_error", "use", "count", "ring"}, out);
  Definition definition{entry.key, {}, is_template, entry.span};
  for (const char* key : {"count", "ring"}) {
    const Entry* misplaced = is_template ? section.find(key) : nullptr;
    if (misplaced != nullptr)
      out.error("E103", misplaced->span, in_quotes(key) + " belongs to an agent, not to a template",
                "under 'agents', write robot: { use: " + entry.key + ", count: 50 }");
  }
  std::optional<OnError> on_error = read_on_error(section, out);
  SystemScope inside = around;
  if (on_error) inside.on_error = &*on_error;
  if (const Entry* control = section.require("control", "every agent has one control subsystem")) {
    definition.subsystems.push_back(read_subsystem(*control, SubsystemKind::control, inside, out));
  }
  read_group(section.find("receptors"), SubsystemKind::receptor, inside, definition, out);
  read_group(section.find("effectors"), SubsystemKind::effector, inside, definition, out);
  if (on_error) check_used(*on_error, out);
  return definition;
}

void Templates::read(const Entry* section, const SystemScope& around, Model& model, Diagnostics& out) {
  groups_ = around.groups;
  if (section == nullptr) return;
  for (const Entry& entry : entries_of(*section->value, section->span, "templates", out)) {
    check_name(entry.key, entry.span, "template", out);
    if (GroupTemplates::is_group(entry)) continue;
    Template one;
    one.entry = &entry;
    const bool alias = std::any_of(entry.value->entries.begin(), entry.value->entries.end(),
                                   [](const Entry& key) { return key.key == "use"; });
    if (alias) {
      const Section keys(*entry.value, entry.span, "a template with 'use'", {"use"}, out);
      const Entry* use = keys.find("use");
      one.alias_of = text_of(*use->value, use->span, "use", out, "name a template");
    } else {
      one.definition = model.definitions.next_id();
      model.definitions.push_back(read_definition(entry, true, around, out));
    }
    order_.push_back(entry.key);
    by_name_.emplace(entry.key, one);
  }
  resolve_aliases(out);
}

void Templates::resolve_aliases(Diagnostics& out) {
  for (const std::string& name : order_) resolve(name, out);
}

/// Follows aliases from `name` to a body, and gives that definition to every template on the way.
void Templates::resolve(const std::string& name, Diagnostics& out) {
  std::vector<std::string> chain;
  DefinitionId definition;
  for (std::string at = name;;) {
    Template& one = by_name_.at(at);
    const auto seen = std::find(chain.begin(), chain.end(), at);
    if (seen != chain.end()) {
      std::string cycle;
      for (auto it = seen; it != chain.end(); ++it) cycle += *it + " -> ";
      out.error("E109", by_name_.at(*seen).entry->span, "templates use each other in a circle: " + cycle + at,
                "one of them must have a body (control, receptors, effectors)");
    }
    if (seen != chain.end() || one.alias_of == nullptr) {
      definition = one.definition;
      break;
    }
    chain.push_back(at);
    const auto next = by_name_.find(one.alias_of->text);
    if (next == by_name_.end()) {
      static_cast<void>(find(*one.alias_of, out));
      break;
    }
    next->second.used = true;
    at = next->first;
  }
  for (const std::string& alias : chain) {
    by_name_.at(alias).definition = definition;
    by_name_.at(alias).alias_of = nullptr;  // neither follow it nor report it again
  }
}

DefinitionId Templates::find(const Node& name, Diagnostics& out) {
  const auto found = by_name_.find(name.text);
  if (found != by_name_.end()) {
    found->second.used = true;
    return found->second.definition;
  }
  one_is_unknown_ = true;
  if (groups_ != nullptr && groups_->contains(name.text)) {
    out.error("E351", name.span,
              "template " + in_quotes(name.text) + " is of a group of behaviours, not of an agent",
              "write use: " + name.text + " in a behaviour");
    return {};
  }
  out.error("E101", name.span, "unknown template " + in_quotes(name.text), did_you_mean(name.text, order_));
  return {};
}

void Templates::complain_about_unused(Diagnostics& out) const {
  if (one_is_unknown_) return;  // the unknown name may mean this template
  for (const std::string& name : order_) {
    const Template& one = by_name_.at(name);
    // A file that several specifications include may have more than one of them needs.
    if (!one.used && out.sources().own_line(one.entry->span.line) > 0)
      out.warning("W319", one.entry->span, "template " + in_quotes(name) + " is used by no agent");
  }
}

}  // namespace tessera::spec
