#include "spec/agents/behaviours.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "diagnostics/utf8.hpp"
#include "spec/agents/conditions.hpp"
#include "spec/agents/few_values.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// Names that the generated code uses beside the transition functions.
constexpr std::array generated =
    std::to_array<std::string_view>({"Context", "Inputs", "Outputs", "Memory", "Parameters", "Real"});

constexpr const char* next_hint = "write a behaviour, or a list such as [{ to: search, when: error }, end]";

const Entry* entry_of(const Entry& behaviour, std::string_view key) {
  const std::vector<Entry>& entries = behaviour.value->entries;
  const auto found = std::ranges::find(entries, key, &Entry::key);
  return found == entries.end() ? nullptr : &*found;
}

/// Reads the behaviours of one subsystem. They may refer to behaviours that follow later in the file.
class BehaviourReader {
 public:
  BehaviourReader(const std::vector<Entry>& entries, const ConditionScope& scope, SubsystemDefaults& defaults,
                  Diagnostics& out)
      : entries_(entries), scope_(scope), defaults_(defaults), out_(out) {
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
      check(entries_[i]);
      by_name_.emplace(entries_[i].key, BehaviourId{i});
    }
  }

  std::vector<Behaviour> read() {
    for (const Entry& entry : entries_)
      sets_.push_back(read_changes(entry_of(entry, "sets"), scope_.memory, out_));
    std::vector<Behaviour> behaviours;
    behaviours.reserve(entries_.size());
    for (const Entry& entry : entries_) behaviours.push_back(read_one(entry));
    return behaviours;
  }

 private:
  void check(const Entry& entry) {
    if (entry.key == "end") {
      out_.error("E106", entry.span, "behaviour name 'end' is reserved", "'next: end' ends the subsystem");
    } else if (std::find(generated.begin(), generated.end(), entry.key) != generated.end()) {
      out_.error("E106", entry.span,
                 "behaviour name " + in_quotes(entry.key) + " is taken by the generated code");
    } else {
      check_name(entry.key, entry.span, "behaviour", out_);
    }
  }

  Behaviour read_one(const Entry& entry) {
    const Section section(*entry.value, entry.span, "a behaviour",
                          {"terminal", "error", "next", "send", "receive", "transfer", "takes", "sets"},
                          out_);
    Behaviour behaviour;
    behaviour.name = entry.key;
    behaviour.span = entry.span;
    behaviour.terminal = read_condition(section.find("terminal"), scope_, defaults_.conditions, out_);
    behaviour.error = read_condition(section.find("error"), scope_, defaults_.conditions, out_);
    check_distinct_names(behaviour);
    read_next(section.find("next"), behaviour);
    behaviour.sets = sets_[static_cast<std::size_t>(&entry - entries_.data())];
    behaviour.send =
        read_list(section.find("send"), {scope_.outputs, scope_.inputs, "output"}, defaults_.send);
    behaviour.receive =
        read_list(section.find("receive"), {scope_.inputs, scope_.outputs, "input"}, defaults_.receive);
    behaviour.transfer = read_transfer(section.find("transfer"));
    if (const Entry* takes = section.find("takes")) {
      behaviour.takes = read_duration(*takes->value, takes->span, "takes", out_).value_or(Duration{1});
    }
    return behaviour;
  }

  void check_distinct_names(const Behaviour& behaviour) {
    for (const Expression& error : behaviour.error.expressions) {
      for (const Expression& terminal : behaviour.terminal.expressions) {
        if (error.name.empty() || error.name != terminal.name) continue;
        const bool shared = error.span == terminal.span;  // one condition of the subsystem
        out_.error("E107", shared ? behaviour.error.span : error.span,
                   "condition " + in_quotes(error.name) + " is both terminal and error",
                   "'when: " + error.name + "' could mean either; " +
                       (shared ? "name it under one of the two" : "rename one"));
      }
    }
  }

  void read_next(const Entry* entry, Behaviour& behaviour) {
    if (entry == nullptr) {
      behaviour.next.push_back({{}, {}, behaviour.span});
      return;
    }
    behaviour.next_given = true;
    if (!entry->value->is_sequence()) {
      read_step(*entry->value, entry->span, behaviour);
      return;
    }
    if (entry->value->items.empty()) out_.error("E104", entry->span, "'next' lists nothing", next_hint);
    for (const Node* item : entry->value->items)
      read_step(*item, item->is_null() ? entry->span : item->span, behaviour);
  }

  void read_step(const Node& node, Span at, Behaviour& behaviour) {
    Next step{{}, {}, at};
    if (node.is_map()) {
      const Section section(node, at, "an entry of 'next'", {"to", "when", "sets"}, out_);
      const Entry* to = section.require("to", next_hint);
      if (to != nullptr) read_target(*to->value, to->span, step);
      if (const Entry* when = section.find("when"))
        step.when = read_when(*when, behaviour, scope_, defaults_.conditions, out_);
      step.sets = read_changes(section.find("sets"), scope_.memory, out_);
    } else {
      read_target(node, at, step);
    }
    if (step.behaviour.valid()) {
      const std::vector<Change>& then = sets_[step.behaviour.value];
      step.sets.insert(step.sets.end(), then.begin(), then.end());
    }
    step.may_be_blocked = check_entry(step, scope_.memory, out_);
    behaviour.next.push_back(std::move(step));
  }

  void read_target(const Node& node, Span at, Next& step) {
    const Node* text = text_of(node, at, "an entry of 'next'", out_, next_hint);
    if (text == nullptr) return;
    step.span = text->span;
    if (text->text == "end") return;
    const auto found = by_name_.find(text->text);
    if (found != by_name_.end()) {
      step.behaviour = found->second;
      return;
    }
    std::vector<std::string> names{"end"};
    for (const auto& [name, index] : by_name_) names.push_back(name);
    std::sort(names.begin(), names.end());
    out_.error("E101", text->span, "unknown behaviour " + in_quotes(text->text),
               did_you_mean(text->text, names));
  }

  BufferList read_list(const Entry* entry, const ListScope& scope, ListDefault& around) {
    if (entry == nullptr) {
      around.used = true;
      return around.list;
    }
    const Node& value = *entry->value;
    if (entry->key == "receive" && value.is_scalar() && (value.text == "first" || value.text == "last")) {
      out_.error("E110", value.span, "'receive: " + value.text + "' belongs to a subsystem",
                 "write it beside 'rate'; 'receive' of a behaviour lists its inputs");
      return std::nullopt;
    }
    return read_buffer_list(value, *entry, scope, around, out_);
  }

  Transfer read_transfer(const Entry* entry) {
    if (entry == nullptr) return Transfer::sequential;
    const Node* text = text_of(*entry->value, entry->span, "transfer", out_, "write sequential or parallel");
    if (text == nullptr || text->text == "sequential") return Transfer::sequential;
    if (text->text != "parallel") {
      out_.error("E104", text->span, "transfer must be sequential or parallel, not " + in_quotes(text->text),
                 did_you_mean(text->text, {"sequential", "parallel"}));
    }
    return Transfer::parallel;
  }

  const std::vector<Entry>& entries_;
  const ConditionScope& scope_;
  SubsystemDefaults& defaults_;
  Diagnostics& out_;
  std::unordered_map<std::string, BehaviourId> by_name_;
  std::vector<std::vector<Change>> sets_;  // per behaviour
};

}  // namespace

std::vector<Behaviour> read_behaviours(const Entry& entry, const ConditionScope& scope,
                                       SubsystemDefaults& defaults, Diagnostics& out) {
  const std::vector<Entry>& entries = entries_of(*entry.value, entry.span, "behaviours", out);
  if (entries.empty() && (entry.value->is_map() || entry.value->is_null())) {
    out.error("E103", entry.span, "a subsystem needs at least one behaviour",
              "for example behaviours: { run: {} }");
  }
  return BehaviourReader(entries, scope, defaults, out).read();
}

}  // namespace tessera::spec
