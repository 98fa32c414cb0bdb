#include "spec/behaviours/groups.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/model/endings.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

using Keys = std::initializer_list<std::string_view>;
const Keys keys_of_behaviour = {"terminal", "error", "next", "send",   "receive", "transfer",
                                "takes",    "uses",  "sets", "orders", "cancel",  "for"};
const Keys keys_of_group = {"behaviours", "start", "next", "on_error", "until", "sets"};
/// If there is an error about keys already.
const Keys all_keys = {"terminal", "error", "next",   "send",  "receive",    "transfer",
                       "takes",    "uses",  "sets",   "for",   "behaviours", "start",
                       "on_error", "until", "orders", "cancel"};

/// A key that only behaviours or only groups have.
struct OwnKey {
  std::string_view name;
  bool of_groups;
  const char* hint;
};
constexpr std::array own_keys = {
    OwnKey{"until", true, "a behaviour has 'terminal' instead; a group has 'behaviours'"},
    OwnKey{"start", true, "a behaviour has no parts; 'start' belongs to a subsystem or a group"},
    OwnKey{"on_error", true,
           "write { to: NAME, when: error } in its 'next'; 'on_error' is for all of a group"},
    OwnKey{"terminal", false,
           "a group ends when a behaviour in it leads to end; 'until: CONDITION' ends all of it"},
    OwnKey{"error", false, "a group fails by the behaviours in it; write 'error' there"},
    OwnKey{"send", false, "only the behaviours in it communicate; write 'send' there"},
    OwnKey{"receive", false, "only the behaviours in it communicate; write 'receive' there"},
    OwnKey{"transfer", false, "only the behaviours in it communicate; write 'transfer' there"},
    OwnKey{"takes", false, "only the behaviours in it take time; write 'takes' there"},
    OwnKey{"uses", false, "only the behaviours in it use something; write 'uses' there"},
    OwnKey{"orders", false, "write 'orders' in the behaviour that sends the goal"},
    OwnKey{"cancel", false, "write 'cancel' beside 'orders' in a behaviour; leaving the group leaves it"}};

class SlotFinder {
 public:
  explicit SlotFinder(Diagnostics& out) : out_(out) {}

  void add(const std::vector<Entry>& entries, SlotId parent, const std::string& around, std::size_t depth) {
    for (const Entry& entry : entries) {
      const Entry* inside = entry.value->is_map() ? entry_in(entry, "behaviours") : nullptr;
      const SlotId id{static_cast<std::uint32_t>(slots.size())};
      slots.push_back({&entry, parent, around + entry.key, inside != nullptr});
      check_identifier(slots.back());
      if (inside == nullptr) continue;
      if (depth == most_nested_groups) {
        out_.error("E341", entry.span,
                   "group " + in_quotes(entry.key) + " stands in " + std::to_string(most_nested_groups) +
                       " groups already",
                   "let the group that it is in name its behaviours");
        slots.back().is_group = false;
        continue;
      }
      const std::size_t errors = out_.error_count();
      const std::vector<Entry>& members = entries_of(*inside->value, inside->span, "behaviours", out_);
      if (members.empty() && out_.error_count() == errors)
        out_.error("E342", inside->span, "group " + in_quotes(entry.key) + " has no behaviour",
                   "for example behaviours: { run: {} }");
      const std::string name = slots[id.value].name + ".";
      slots[id.value].is_group = !members.empty();
      add(members, id, name, depth + 1);
    }
  }

  std::vector<Slot> slots;

 private:
  void check_identifier(const Slot& slot) {
    std::string identifier = slot.name;
    std::ranges::replace(identifier, '.', '_');
    if (slot.parent.valid()) check_name(identifier, slot.entry->span, "behaviour", out_);
    const auto [first, added] = lines_.emplace(identifier, std::pair(slot.name, slot.entry->span.line));
    if (added || first->second.first == slot.name) return;
    out_.error("E343", slot.entry->span,
               in_quotes(slot.name) + " and " + in_quotes(first->second.first) + " on " +
                   out_.words(first->second.second) + " have the same name in C++: " + identifier,
               "rename one of them");
  }

  Diagnostics& out_;
  std::map<std::string, std::pair<std::string, std::uint32_t>> lines_;  // per name in C++
};

/// The entry of `next` that leaves the group around a behaviour as a failure.
Next leaving_as_failure(Span at) {
  Next entry{.behaviour = {}, .when = {}, .span = at, .inherited = true};
  entry.when.kind = When::Kind::error;
  entry.when.text.span = at;
  return entry;
}

bool leaves_as_terminal(const Behaviour& behaviour) {
  const Endings endings(behaviour);
  for (const NextId id : behaviour.next.ids()) {
    const Next& entry = behaviour.next[id];
    const bool by_until = entry.inherited && entry.when.kind == When::Kind::terminal;
    if (!entry.behaviour.valid() && !names_error(entry) && !by_until && endings.can_be_taken(id)) return true;
  }
  return false;
}

/// ending: an error or a failure.
bool leaves_after(Ending ending, const Behaviour& behaviour) {
  const Endings endings(behaviour);
  for (const NextId id : behaviour.next.ids()) {
    const Next& entry = behaviour.next[id];
    if (!entry.behaviour.valid() && names_error(entry) && endings.taken(id, ending) != Truth::never)
      return true;
  }
  return false;
}

Expression placeholder(Span at) { return {{}, {}, at}; }

class Completion {
 public:
  Completion(Subsystem& subsystem, std::vector<std::optional<OnError>>& on_error, Diagnostics& out)
      : subsystem_(subsystem), on_error_(on_error), out_(out) {}

  void complete(BehaviourId id) {
    std::vector<BehaviourId> members;
    for (const BehaviourId one : subsystem_.behaviours.ids())
      if (subsystem_.behaviours[one].parent == id) members.push_back(one);
    if (on_error_[id.value]) lead(id, *on_error_[id.value], members);
    Behaviour& group = subsystem_.behaviours[id];
    const Next leaving = leaving_as_failure(group.span);
    bool terminal = false, error = false, failure = false;
    for (const BehaviourId one : members) {
      Behaviour& member = subsystem_.behaviours[one];
      lead_failures(member, leaving);
      terminal = terminal || leaves_as_terminal(member);
      error = error || leaves_after(Ending::error, member);
      failure = failure || leaves_after(Ending::failure, member);
    }
    group.group->may_fail = failure;
    using Kind = Condition::Kind;
    if (group.terminal.kind == Kind::expressions && terminal)
      group.terminal.expressions.push_back(placeholder(group.span));
    else if (group.terminal.kind != Kind::expressions)
      group.terminal.kind = terminal ? Kind::always : Kind::never;
    if (error) {
      group.error.kind = Kind::expressions;
      group.error.span = group.span;
      group.error.expressions.push_back(placeholder(group.span));
    }
  }

 private:
  void lead(BehaviourId id, OnError& on_error, const std::vector<BehaviourId>& members) {
    if (on_error.behaviour.empty()) {
      if (!on_error.used)
        out_.error("E346", on_error.span, "a group has no 'on_error: stop'",
                   "leave it out: a failure then leaves the group, and the group's 'next' may name it");
      return;
    }
    const BehaviourId to = resolve_on_error(on_error, id, /*own=*/true, subsystem_, out_);
    if (to.valid()) {
      const Next entry = entry_for_errors(to, on_error.span, subsystem_, out_);
      for (const BehaviourId from : members)
        if (from != to && lead_failures(subsystem_.behaviours[from], entry)) on_error.used = true;
      if (members.size() == 1) on_error.used = false;
    }
    check_used(on_error, out_);
  }

  Subsystem& subsystem_;
  std::vector<std::optional<OnError>>& on_error_;
  Diagnostics& out_;
};

}  // namespace

std::vector<Slot> slots_of(const std::vector<Entry>& entries, Diagnostics& out) {
  SlotFinder finder(out);
  finder.add(entries, {}, {}, 0);
  return std::move(finder.slots);
}

std::initializer_list<std::string_view> keys_of(const Slot& slot, Diagnostics& out) {
  // A group that cannot be read, and `for` that does not belong there, have their own errors.
  bool fit = slot.is_group ? entry_in(*slot.entry, "for") == nullptr
                           : entry_in(*slot.entry, "behaviours") == nullptr;
  for (const OwnKey& key : own_keys) {
    const Entry* entry = entry_in(*slot.entry, key.name);
    if (entry == nullptr || key.of_groups == slot.is_group) continue;
    fit = false;
    out.error("E344", entry->span,
              in_quotes(key.name) + (key.of_groups ? " belongs to a group; " : " belongs to a behaviour; ") +
                  in_quotes(slot.entry->key) + " is a " + (slot.is_group ? "group" : "behaviour"),
              key.hint);
  }
  return !fit ? all_keys : slot.is_group ? keys_of_group : keys_of_behaviour;
}

std::initializer_list<std::string_view> known_keys(bool of_group) {
  return of_group ? keys_of_group : keys_of_behaviour;
}

std::vector<SlotId> groups_around(const std::vector<Slot>& slots, SlotId innermost) {
  std::vector<SlotId> groups;
  for (SlotId at = innermost; at.valid(); at = slots[at.value].parent) groups.push_back(at);
  std::ranges::reverse(groups);
  return groups;
}

bool complain_about_place(const Node& name, SlotId parent, const std::vector<Slot>& slots, Diagnostics& out) {
  // "ask" or "charge.ask"
  const auto is_meant = [&](const Slot& slot) {
    return slot.name == name.text || slot.entry->key == name.text;
  };
  const auto found = std::ranges::find_if(slots, is_meant);
  if (found == slots.end()) return false;
  const auto group = [&](SlotId id) { return "group " + in_quotes(slots[id.value].name); };
  std::vector<SlotId> around;  // the groups of the place that names it
  for (SlotId at = parent; at.valid(); at = slots[at.value].parent) around.push_back(at);
  // The outermost group around what is meant that is not around the place: only its beginning can be entered.
  SlotId closed;
  for (SlotId at = found->parent; at.valid(); at = slots[at.value].parent)
    if (std::ranges::find(around, at) == around.end()) closed = at;
  if (closed.valid() && slots[closed.value].parent == parent)
    out.error("E345", name.span, in_quotes(name.text) + " is in " + group(closed),
              "a group is entered at its beginning: write " + slots[closed.value].entry->key +
                  ", and 'start' in the group");
  else if (std::ranges::any_of(around, [&](SlotId id) { return &slots[id.value] == &*found; }))
    out.error("E345", name.span, in_quotes(name.text) + " is the group around this",
              "write end, which leaves the group; the group's 'next' may lead to it again");
  else
    out.error("E345", name.span,
              in_quotes(name.text) + " is outside of " + (parent.valid() ? group(parent) : "this list"),
              "write end, which leaves the group; the group's 'next' leads on");
  return true;
}

Expression held_until(const Expression& until, std::string name) {
  Expression held{std::move(name), {}, until.span};
  held.until_of = until.until_of;
  return held;
}

void add_untils(Behaviour& behaviour, const std::vector<const Expression*>& untils) {
  if (untils.empty()) return;
  Condition& terminal = behaviour.terminal;
  if (!behaviour.is_group()) {
    const bool never = terminal.kind == Condition::Kind::never;
    // Its default entry `end` is for an ending of its own.
    if (never && !behaviour.next_given) behaviour.next.clear();
    if (terminal.kind == Condition::Kind::always) terminal.expressions.push_back({{}, "true", terminal.span});
    if (never) terminal.span = untils.front()->span;
  }
  if (terminal.kind != Condition::Kind::expressions && behaviour.is_group())
    terminal.span = untils.front()->span;
  terminal.kind = Condition::Kind::expressions;
  std::vector<Next> leaving;
  for (const Expression* until : untils) {
    Next entry{.behaviour = {}, .when = {}, .span = until->span, .inherited = true};
    entry.when.kind = When::Kind::terminal;
    entry.when.expression = {static_cast<std::uint32_t>(terminal.expressions.size())};
    entry.when.text.span = until->span;
    terminal.expressions.push_back(behaviour.is_group() ? held_until(*until, {}) : *until);
    terminal.expressions[entry.when.expression].name.clear();
    leaving.push_back(std::move(entry));
  }
  behaviour.next.insert(behaviour.next.begin(), leaving.begin(), leaving.end());
}

void complete_groups(Subsystem& subsystem, std::vector<std::optional<OnError>>& on_error, Diagnostics& out) {
  Completion completion(subsystem, on_error, out);
  // Groups stand before what is in them.
  for (auto number = static_cast<std::uint32_t>(subsystem.behaviours.size()); number-- > 0;)
    if (subsystem.behaviours[BehaviourId{number}].is_group()) completion.complete({number});
}

}  // namespace tessera::spec
