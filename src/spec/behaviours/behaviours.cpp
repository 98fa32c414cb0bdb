#include "spec/behaviours/behaviours.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/behaviours/conditions.hpp"
#include "spec/behaviours/groups.hpp"
#include "spec/behaviours/neighbours.hpp"
#include "spec/behaviours/sending.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/memory/few_values.hpp"
#include "spec/memory/goals.hpp"
#include "spec/values/takes.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* next_hint = "write a behaviour, or a list such as [{ to: search, when: error }, end]";

/// Reads the behaviours of one subsystem. They may refer to behaviours that follow later in the file.
class BehaviourReader {
 public:
  BehaviourReader(const std::vector<Entry>& entries, const ConditionScope& scope, SubsystemDefaults& defaults,
                  const FleetSizes* fleets, Diagnostics& out)
      : slots_(slots_of(entries, out)), scope_(scope), defaults_(defaults), out_(&out) {
    for (std::size_t number = 0; number < slots_.size(); ++number) {
      const Slot& slot = slots_[number];
      static_cast<void>(check_behaviour_name(slot.entry->key, slot.entry->span, *out_));
      Written written{&slot, {count_}, std::nullopt, std::nullopt, {}, {}};
      if (const Entry* each = entry_in(*slot.entry, "for"))
        if (may_be_for(slot, *each)) written.each = read_for(*each, fleets);
      count_ += written.each ? written.each->count : 1;
      by_name_.emplace(std::pair(slot.parent, slot.entry->key), number);
      written_.push_back(std::move(written));
    }
  }

  ReadBehaviours read() {
    for (Written& one : written_) {
      const Entry& entry = *one.slot->entry;
      if (!one.slot->is_group) one.orders = read_order(entry, scope_.memory, *out_);
      each_member(one, [&](const Member* member) {
        one.sets.push_back(read_changes(entry_in(entry, "sets"), scope_.memory, member, *out_));
        if (one.orders) one.sets.back().push_back(one.orders->change());
      });
    }
    // Groups stand before what is in them.
    for (std::size_t number = written_.size(); number-- > 0;) begin_group(number);
    read_.behaviours.reserve(count_);
    for (const Written& one : written_)
      each_member(one, [&](const Member* member) { read_one(one, member); });
    return std::move(read_);
  }

 private:
  /// A behaviour as the file has it.
  struct Written {
    const Slot* slot;
    BehaviourId first;               ///< of its members
    std::optional<EachMember> each;  ///< `for: each robot`
    std::optional<Order> orders;
    std::vector<std::vector<Change>> sets;  ///< per member
    BehaviourId start;                      ///< of a group
  };

  bool may_be_for(const Slot& slot, const Entry& each) {
    if (!slot.is_group && !slot.parent.valid()) return true;
    out_->error("E349", each.span,
                slot.is_group ? "a group is not 'for' each member" : "'for' does not stand in a group",
                "write the behaviour outside of groups");
    return false;
  }

  [[nodiscard]] BehaviourId group_around(const Slot& slot) const {
    return slot.parent.valid() ? written_[slot.parent.value].first : BehaviourId{};
  }

  EachMember read_for(const Entry& entry, const FleetSizes* fleets) {
    const Node* text = text_of(*entry.value, entry.span, "for", *out_, "for example for: each robot");
    const auto each = text == nullptr ? std::nullopt : read_each(*text, 0, text->text.size(), fleets, *out_);
    return each.value_or(EachMember{});  // without a fleet: nothing more is said about indices
  }

  /// Calls `read` for every member of a behaviour, or once with null. Mistakes are those of the first member.
  template <class Read>
  void each_member(const Written& one, Read read) {
    if (!one.each) {
      read(nullptr);
      return;
    }
    Diagnostics* const all = out_;
    Diagnostics ignored = all->of_same_source();
    for (std::uint32_t number = 0; number < one.each->count; ++number) {
      const Member member = one.each->member(one.slot->entry->key, number);
      if (number == 1) out_ = &ignored;
      read(&member);
    }
    out_ = all;
  }

  [[nodiscard]] ConditionScope scope_for(const Member* member) const {
    ConditionScope scope = scope_;
    scope.member = member;
    return scope;
  }

  /// Finds where a group begins. A behaviour that begins there begins with the group, and changes memory then.
  void begin_group(std::size_t number) {
    Written& group = written_[number];
    if (!group.slot->is_group) return;
    const SlotId id{static_cast<std::uint32_t>(number)};
    const Written* start = &written_[number + 1];
    if (const Entry* entry = entry_in(*group.slot->entry, "start"))
      if (const Node* text =
              text_of(*entry->value, entry->span, "start", *out_, "name a behaviour of the group"))
        if (const Written* named = find(text->text, *text, id, /*or_end=*/false); named != nullptr)
          start = named;
    group.start = start->first;
    group.sets.front().insert(group.sets.front().end(), start->sets.front().begin(),
                              start->sets.front().end());
  }

  void read_one(const Written& written, const Member* member) {
    const Slot& slot = *written.slot;
    const Entry& entry = *slot.entry;
    Behaviour behaviour;
    behaviour.name = member == nullptr ? slot.name : name_of_member(entry.key, member->number);
    behaviour.parent = group_around(slot);
    if (member != nullptr) behaviour.member = *member;
    behaviour.span = entry.span;
    behaviour.sets = written.sets[member == nullptr ? 0 : member->number];
    behaviour.orders = written.orders;
    const ConditionScope scope = scope_for(member);
    const Section section(*entry.value, entry.span, slot.is_group ? "a group" : "a behaviour",
                          keys_of(slot, *out_), *out_);
    std::optional<OnError> on_error;
    if (slot.is_group) {
      read_group(section, scope, written, behaviour);
      on_error = read_on_error(section, *out_);
    } else {
      read_plain(section, scope, slot, behaviour);
    }
    std::vector<const Expression*> untils;
    for (const SlotId around : groups_around(slots_, slot.parent)) {
      const std::optional<Group>& group = read_.behaviours[written_[around.value].first.value].group;
      if (group && group->until) untils.push_back(&*group->until);
    }
    add_untils(behaviour, untils);
    read_.behaviours.push_back(std::move(behaviour));
    read_.on_error.push_back(std::move(on_error));
  }

  void read_plain(const Section& section, const ConditionScope& scope, const Slot& slot,
                  Behaviour& behaviour) {
    const Member* member = scope.member;
    behaviour.terminal = read_condition(section.find("terminal"), scope, defaults_.conditions, *out_);
    if (entry_in(*slot.entry, "behaviours") != nullptr) {  // an error was found; it may end in any way
      behaviour.terminal.kind = Condition::Kind::expressions;
      behaviour.terminal.expressions.push_back({{}, {}, behaviour.span});
    }
    behaviour.error = read_condition(section.find("error"), scope, defaults_.conditions, *out_);
    check_distinct_names(behaviour);
    read_next(section.find("next"), scope, behaviour, slot.parent);
    behaviour.send =
        read_list(section.find("send"), {scope_.outputs, scope_.inputs, "output", member}, defaults_.send);
    behaviour.skippable = read_skippable(std::exchange(options_, {}), scope, defaults_.conditions, *out_);
    behaviour.receive = read_list(section.find("receive"), {scope_.inputs, scope_.outputs, "input", member},
                                  defaults_.receive);
    behaviour.transfer = read_transfer(section.find("transfer"));
    if (const Entry* takes = section.find("takes"))
      behaviour.takes =
          read_takes(*takes->value, takes->span, *out_).value_or(Takes{Duration{1}, Duration{1}});
    behaviour.uses = read_uses(section.find("uses"), *out_);
  }

  void read_group(const Section& section, const ConditionScope& scope, const Written& written,
                  Behaviour& group) {
    group.group.emplace();
    group.group->start = written.start;
    group.send.emplace();
    group.receive.emplace();
    if (const Entry* entry = section.find("until")) read_until(*entry, written.first, group);
    read_next(section.find("next"), scope, group, written.slot->parent);
    for (const Next& next : group.next) refuse_elapsed(next.when.text);
  }

  void read_until(const Entry& entry, BehaviourId id, Behaviour& group) {
    Condition until = read_condition(&entry, scope_, defaults_.conditions, *out_);
    const bool constant = until.kind != Condition::Kind::expressions;
    if (constant || until.expressions.size() > 1)
      out_->error("E347", until.span, "'until' is one condition, which may hold or not",
                  constant
                      ? "for example until: in.wish.pause; without 'until' only its behaviours end the group"
                      : "join them by ||");
    if (constant) until.expressions.push_back({{}, {}, until.span});
    Expression& one = until.expressions.front();
    refuse_elapsed(one);
    one.until_of = id;
    group.terminal.kind = Condition::Kind::expressions;
    group.terminal.span = one.span;
    group.terminal.expressions.push_back(held_until(one, "until"));
    group.group->until = std::move(one);
  }

  void refuse_elapsed(const Expression& expression) {
    for (const Reference& one : expression.references)
      if (one.kind == Reference::Kind::elapsed)
        out_->error("E348", one.span, "a group has no 'elapsed'",
                    "it is the time in a behaviour: ask it in 'terminal' or 'next' of a behaviour");
  }

  void check_distinct_names(const Behaviour& behaviour) {
    for (const Expression& error : behaviour.error.expressions) {
      for (const Expression& terminal : behaviour.terminal.expressions) {
        if (error.name.empty() || error.name != terminal.name) continue;
        const bool shared = error.span == terminal.span;  // one condition of the subsystem
        out_->error("E107", shared ? behaviour.error.span : error.span,
                    "condition " + in_quotes(error.name) + " is both terminal and error",
                    "'when: " + error.name + "' could mean either; " +
                        (shared ? "name it under one of the two" : "rename one"));
      }
    }
  }

  void read_next(const Entry* entry, const ConditionScope& scope, Behaviour& behaviour, SlotId parent) {
    if (entry == nullptr) {
      behaviour.next.push_back({{}, {}, behaviour.span});
      return;
    }
    behaviour.next_given = true;
    neighbours_.clear();
    if (!entry->value->is_sequence()) {
      read_step(*entry->value, entry->span, scope, behaviour, parent);
    } else if (entry->value->items.empty())
      out_->error("E104", entry->span, "'next' lists nothing", next_hint);
    for (const Node* item : entry->value->items)
      read_step(*item, item->is_null() ? entry->span : item->span, scope, behaviour, parent);
    choose_neighbours(neighbours_, behaviour, *out_);
  }

  /// One item of `next`. It is an entry for each member if it leads to lend[i] from outside.
  void read_step(const Node& node, Span at, const ConditionScope& scope, Behaviour& behaviour,
                 SlotId parent) {
    if (!node.is_map()) {
      const auto target = read_target(node, at, parent);
      add_step(target, nullptr, nullptr, scope, behaviour);
      return;
    }
    const Section section(node, at, "an entry of 'next'", {"to", "when", "sets"}, *out_);
    const Entry* to = section.require("to", next_hint);
    Target target{at, nullptr, {}};
    if (to != nullptr) target = read_target(*to->value, to->span, parent);
    const bool fans_out = target.written != nullptr && target.written->each && scope.member == nullptr &&
                          target.name.index == IndexedName::Index::variable && !target.name.is_neighbour();
    if (!fans_out) {
      add_step(target, section.find("when"), section.find("sets"), scope, behaviour);
      return;
    }
    const std::size_t errors = out_->error_count();
    const NextId first = behaviour.next.next_id();
    each_member(*target.written, [&](const Member* member) {
      add_step(target, section.find("when"), section.find("sets"), scope_for(member), behaviour);
      behaviour.next.back().member = *member;
    });
    if (out_->error_count() == errors && behaviour.next[first].when.kind != When::Kind::expression)
      out_->error("E291", target.span,
                  "the entry is for each member of the fleet, but the same for all of them",
                  "say for which it is taken: when: in.request[i].fresh; or name one: to: " +
                      name_of_member(target.name.name, 0));
  }

  /// The end of an entry.
  struct Target {
    Span span;
    const Written* written = nullptr;  ///< null: `end`, or unknown
    IndexedName name;
  };

  void add_step(const Target& target, const Entry* when, const Entry* sets, const ConditionScope& scope,
                Behaviour& behaviour) {
    Next step{{}, {}, target.span};
    step.behaviour = behaviour_of(target, scope.member, behaviour.next.next_id());
    if (when != nullptr) step.when = read_when(*when, behaviour, scope, defaults_.conditions, *out_);
    step.sets = read_changes(sets, scope_.memory, scope.member, *out_);
    if (step.behaviour.valid()) {
      const std::vector<Change>& then =
          target.written->sets[step.behaviour.value - target.written->first.value];
      step.sets.insert(step.sets.end(), then.begin(), then.end());
    }
    step.may_be_blocked = check_entry(step, scope_.memory, *out_);
    behaviour.next.push_back(std::move(step));
  }

  Target read_target(const Node& node, Span at, SlotId parent) {
    const Node* text = text_of(node, at, "an entry of 'next'", *out_, next_hint);
    if (text == nullptr) return {at, nullptr, {}};
    Target target{text->span, nullptr, {}};
    if (text->text == "end") return target;
    const auto name = read_indexed(*text, 0, *out_);
    if (!name) return target;
    target.name = *name;
    target.written = find(name->name, *text, parent, /*or_end=*/true);
    return target;
  }

  /// The behaviour of that name in the group, or in the subsystem itself; null after an error.
  const Written* find(const std::string& name, const Node& text, SlotId parent, bool or_end) {
    if (const auto found = by_name_.find(std::pair(parent, name)); found != by_name_.end())
      return &written_[found->second];
    if (complain_about_place(text, parent, slots_, *out_)) return nullptr;
    std::vector<std::string> names;
    if (or_end) names.emplace_back("end");
    for (const auto& [known, index] : by_name_)
      if (known.first == parent) names.push_back(known.second);
    std::sort(names.begin(), names.end());
    Span span = text.span;
    if (name != text.text) span.length = static_cast<std::uint32_t>(name.size());
    out_->error("E101", span, "unknown behaviour " + in_quotes(name), did_you_mean(name, names));
    return nullptr;
  }

  /// The behaviour to which an entry leads; none: `end`, or an error.
  BehaviourId behaviour_of(const Target& target, const Member* member, NextId entry) {
    if (target.written == nullptr) return {};
    const Written& to = *target.written;
    if (!to.each) return check_single(target.name, "behaviour", *out_) ? to.first : BehaviourId{};
    IndexedName own = target.name;
    const std::int64_t offset = std::exchange(own.offset, 0);
    auto number = number_of(own, to.each->member(to.slot->entry->key, 0), member, "behaviour", *out_);
    if (number && offset != 0 && !to.each->fleet.empty()) {
      number = to.each->neighbour(*number, offset);
      if (!to.each->ring) neighbours_.push_back({entry.value, target.name, *to.each, number.has_value()});
    }
    return number ? BehaviourId{to.first.value + *number} : BehaviourId{};
  }

  BufferList read_list(const Entry* entry, const ListScope& scope, ListDefault& around) {
    if (entry == nullptr) {
      around.used = true;
      return around.list;
    }
    const Node& value = *entry->value;
    if (entry->key == "receive" && value.is_scalar() && (value.text == "first" || value.text == "last")) {
      out_->error("E110", value.span, "'receive: " + value.text + "' belongs to a subsystem",
                  "write it beside 'rate'; 'receive' of a behaviour lists its inputs");
      return std::nullopt;
    }
    return read_buffer_list(value, *entry, scope, around, *out_, &options_);
  }

  Transfer read_transfer(const Entry* entry) {
    if (entry == nullptr) return Transfer::sequential;
    const Node* text = text_of(*entry->value, entry->span, "transfer", *out_, "write sequential or parallel");
    if (text == nullptr || text->text == "sequential") return Transfer::sequential;
    if (text->text != "parallel") {
      out_->error("E104", text->span, "transfer must be sequential or parallel, not " + in_quotes(text->text),
                  did_you_mean(text->text, {"sequential", "parallel"}));
    }
    return Transfer::parallel;
  }

  std::vector<Slot> slots_;
  const ConditionScope& scope_;
  SubsystemDefaults& defaults_;
  Diagnostics* out_;
  std::vector<Written> written_;                                   // as slots_
  std::map<std::pair<SlotId, std::string>, std::size_t> by_name_;  // in each group; into written_
  std::uint32_t count_ = 0;                                        // behaviours of the subsystem
  ReadBehaviours read_;
  std::vector<ListedOption> options_;       // of the list that was read last
  std::vector<NeighbourEntry> neighbours_;  // of the list `next` that is read
};

}  // namespace

ReadBehaviours read_behaviours(const Entry& entry, const ConditionScope& scope, SubsystemDefaults& defaults,
                               const FleetSizes* fleets, GroupTemplates* groups, Diagnostics& out) {
  const std::vector<Entry>& written = entries_of(*entry.value, entry.span, "behaviours", out);
  const std::vector<Entry>& entries = groups == nullptr ? written : groups->expanded(written, out);
  if (entries.empty() && (entry.value->is_map() || entry.value->is_null())) {
    out.error("E103", entry.span, "a subsystem needs at least one behaviour",
              "for example behaviours: { run: {} }");
  }
  if (groups == nullptr || groups->replacements().empty())
    return BehaviourReader(entries, scope, defaults, fleets, out).read();
  Diagnostics found = out.of_same_source();
  ReadBehaviours read = BehaviourReader(entries, scope, defaults, fleets, found).read();
  place(groups->replacements(), found, out);
  return read;
}

}  // namespace tessera::spec
