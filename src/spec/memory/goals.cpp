#include "spec/memory/goals.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "diagnostics/utf8.hpp"
#include "tessera/goal_life.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* goal_hint = "for example { goal: out.goal, progress: in.progress }";

/// A field that a buffer of a goal has.
struct GoalField {
  std::string_view name;
  Scalar scalar;
  std::string_view type;
};
constexpr GoalField call_field{"call", Scalar::uint32, "uint32"};
constexpr GoalField cancel_field{"cancel", Scalar::boolean, "bool"};
constexpr GoalField state_field{"state", Scalar::uint8, "uint8"};

enum class HasField : std::uint8_t { no, yes, other_type };

HasField has_field(const Field& buffer, const GoalField& wanted, const Types& types) {
  if (buffer.type.kind != Type::Kind::structure || buffer.type.extent != 0) return HasField::no;
  const std::vector<Field>& fields = types.fields_of(buffer.type);
  const auto found = std::ranges::find(fields, wanted.name, &Field::name);
  if (found == fields.end()) return HasField::no;
  const Type& type = found->type;
  const bool fits = type.kind == Type::Kind::scalar && type.scalar == wanted.scalar && type.extent == 0;
  return fits ? HasField::yes : HasField::other_type;
}

/// One of the two buffers: "out.goal" under `goal`, "in.progress" under `progress`.
struct BufferKey {
  std::string_view key, owner;
  const Numbered<BufferId, Field>& buffers;
};

BufferId read_buffer(const Entry* entry, const BufferKey& wanted, Diagnostics& out) {
  if (entry == nullptr) return {};
  const Node* text = text_of(*entry->value, entry->span, wanted.key, out, goal_hint);
  if (text == nullptr) return {};
  const std::string prefix = std::string(wanted.owner) + ".";
  if (!text->text.starts_with(prefix)) {
    out.error("E362", text->span,
              in_quotes(wanted.key) + " is an " + (wanted.owner == "out" ? "output" : "input") + ", not " +
                  in_quotes(text->text),
              "write " + prefix + "NAME; " + goal_hint);
    return {};
  }
  const std::string name = text->text.substr(prefix.size());
  std::vector<std::string> names;
  for (const BufferId id : wanted.buffers.ids()) {
    const Field& buffer = wanted.buffers[id];
    if (buffer.name == name && !buffer.member) return id;
    if (buffer.member && name.substr(0, name.find('[')) == buffer.member->family) {
      out.error("E362", text->span,
                in_quotes(text->text) + " is one of the buffers of a fleet, one for each member",
                "a goal has an output and an input of its own");
      return {};
    }
    names.push_back(buffer.name);
  }
  out.error("E101", text->span,
            "unknown " + std::string(wanted.owner == "out" ? "output" : "input") + " " + in_quotes(name),
            did_you_mean(name, names));
  return {};
}

void check_field(const Field& buffer, Span at, const GoalField& wanted, const Types& types,
                 Diagnostics& out) {
  if (Types::is_unknown(buffer.type)) return;
  const HasField has = has_field(buffer, wanted, types);
  if (has == HasField::yes) return;
  out.error("E363", at,
            in_quotes(buffer.name) + " needs a field " + in_quotes(wanted.name) + " of type " +
                std::string(wanted.type) +
                (has == HasField::other_type ? ", and has one of another type" : ""),
            "its type is " + types.spelled(buffer.type) + "; add " + std::string(wanted.name) + ": " +
                std::string(wanted.type) + " under 'types'");
}

/// The behaviours that may begin when that one is left.
class Followers {
 public:
  Followers(const Subsystem& subsystem, BehaviourId from) : subsystem_(subsystem) { leave(from); }

  [[nodiscard]] const std::vector<BehaviourId>& all() const { return all_; }

 private:
  void leave(BehaviourId id) {
    for (const Next& next : subsystem_.behaviours[id].next) {
      const BehaviourId group = subsystem_.behaviours[id].parent;
      if (!next.behaviour.valid()) {
        if (group.valid() && group.value < id.value) leave(group);
        continue;
      }
      BehaviourId first = next.behaviour;
      while (subsystem_.behaviours[first].is_group()) first = subsystem_.behaviours[first].group->start;
      if (std::ranges::find(all_, first) == all_.end()) all_.push_back(first);
    }
  }

  const Subsystem& subsystem_;
  std::vector<BehaviourId> all_;
};

bool lists(const std::optional<std::vector<BufferId>>& list, BufferId buffer) {
  return !list || std::ranges::find(*list, buffer) != list->end();
}

/// The place of the first part of the expressions that asks for the cell; nullptr: there is none.
const Span* asks(const Condition& condition, std::uint32_t cell) {
  for (const Expression& expression : condition.expressions) {
    if (expression.until_of.valid()) continue;
    for (const Reference& one : expression.references)
      if (one.kind == Reference::Kind::memory && one.target == cell) return &one.span;
  }
  return nullptr;
}

class GoalCheck {
 public:
  GoalCheck(const Subsystem& subsystem, Diagnostics& out) : subsystem_(subsystem), out_(out) {}

  void check(std::uint32_t cell) {
    const Field& field = subsystem_.memory[cell];
    const GoalBuffers& buffers = *field.few->goal;
    check_shared(cell);
    if (!buffers.goal.valid() || !buffers.progress.valid()) return;
    bool ordered_once = false;
    for (const BehaviourId id : subsystem_.behaviours.ids()) {
      const Behaviour& behaviour = subsystem_.behaviours[id];
      if (behaviour.is_group()) continue;
      const bool orders = behaviour.orders && behaviour.orders->cell == cell;
      ordered_once = ordered_once || orders;
      if (orders) check_order(id, buffers);
      if (orders || lists(behaviour.receive, buffers.progress)) continue;
      for (const Condition* condition : {&behaviour.terminal, &behaviour.error})
        if (const Span* at = asks(*condition, cell)) {
          out_.warning("W395", *at,
                       "behaviour " + in_quotes(behaviour.name) + " asks for " +
                           in_quotes("memory." + field.name) + ", which does not change in it",
                       "add " + name_of(subsystem_.inputs, buffers.progress) + " to its 'receive'");
          break;
        }
    }
    if (!ordered_once)
      out_.warning("W397", field.span,
                   "no behaviour orders " + in_quotes("memory." + field.name) + ": it is always none",
                   "write orders: " + field.name + " in the behaviour whose beginning orders it");
  }

 private:
  static const std::string& name_of(const Numbered<BufferId, Field>& buffers, BufferId id) {
    return buffers[id].name;
  }

  void check_shared(std::uint32_t cell) {
    const GoalBuffers& mine = *subsystem_.memory[cell].few->goal;
    for (std::uint32_t other = 0; other < cell; ++other) {
      const Field& earlier = subsystem_.memory[other];
      if (!earlier.few || !earlier.few->goal) continue;
      const bool goal = mine.goal.valid() && earlier.few->goal->goal == mine.goal;
      const bool progress = mine.progress.valid() && earlier.few->goal->progress == mine.progress;
      if (!goal && !progress) continue;
      out_.error("E364", subsystem_.memory[cell].span,
                 in_quotes(goal ? "out." + name_of(subsystem_.outputs, mine.goal)
                                : "in." + name_of(subsystem_.inputs, mine.progress)) +
                     " belongs to " + in_quotes("memory." + earlier.name) + " already",
                 "each goal has an output and an input of its own");
      return;
    }
  }

  void check_order(BehaviourId id, const GoalBuffers& buffers) {
    const Behaviour& behaviour = subsystem_.behaviours[id];
    const std::string& goal = name_of(subsystem_.outputs, buffers.goal);
    const std::string& progress = name_of(subsystem_.inputs, buffers.progress);
    if (!lists(behaviour.send, buffers.goal))
      out_.error(
          "E368", behaviour.orders->span,
          "behaviour " + in_quotes(behaviour.name) + " orders a goal and does not send " + in_quotes(goal),
          "add " + goal + " to its 'send'");
    if (!lists(behaviour.receive, buffers.progress))
      out_.error("E369", behaviour.orders->span,
                 "behaviour " + in_quotes(behaviour.name) + " orders a goal and does not receive " +
                     in_quotes(progress) + ": it is never told of it",
                 "add " + progress + " to its 'receive'");
    if (!behaviour.orders->cancel_on_leave) return;
    const Followers followers(subsystem_, id);
    for (const BehaviourId next : followers.all()) {
      const Behaviour& follower = subsystem_.behaviours[next];
      if (lists(follower.send, buffers.goal)) continue;
      out_.warning("W396", follower.span,
                   "behaviour " + in_quotes(follower.name) + " may follow " + in_quotes(behaviour.name) +
                       ", which cancels its goal when it is left, and does not send " + in_quotes(goal),
                   "the goal goes on until a behaviour sends it; add " + goal + " to its 'send'");
    }
  }

  const Subsystem& subsystem_;
  Diagnostics& out_;
};

}  // namespace

FewValues read_goal(const Section& cell, const GoalScope& buffers, Diagnostics& out) {
  FewValues few;
  few.names.assign(goal_state_names.begin(), goal_state_names.end());
  few.goal.emplace();
  for (const std::string_view key : {"type", "initial", "values", "counts"})
    if (const Entry* other = cell.find(key))
      out.error("E362", other->span,
                "a memory cell with a goal has no " + in_quotes(key) + ": it has the states of the goal",
                "remove it");
  const Entry* goal = cell.require("goal", goal_hint);
  const Entry* progress = cell.require("progress", goal_hint);
  few.goal->goal = read_buffer(goal, {"goal", "out", buffers.outputs}, out);
  few.goal->progress = read_buffer(progress, {"progress", "in", buffers.inputs}, out);
  if (few.goal->goal.valid()) {
    const Field& output = buffers.outputs[few.goal->goal];
    check_field(output, goal->value->span, call_field, buffers.types, out);
    const HasField has = has_field(output, cancel_field, buffers.types);
    few.goal->cancels = has == HasField::yes;
    if (has == HasField::other_type) check_field(output, goal->value->span, cancel_field, buffers.types, out);
  }
  if (few.goal->progress.valid())
    for (const GoalField& field : {call_field, state_field})
      check_field(buffers.inputs[few.goal->progress], progress->value->span, field, buffers.types, out);
  return few;
}

std::optional<Order> read_order(const Entry& behaviour, const std::vector<Field>& memory, Diagnostics& out) {
  const Entry* orders = entry_in(behaviour, "orders");
  const Entry* cancel = entry_in(behaviour, "cancel");
  bool on_leave = false;
  if (cancel != nullptr) {
    const Node* text = text_of(*cancel->value, cancel->span, "cancel", out, "write cancel: on_leave");
    on_leave = text != nullptr && text->text == "on_leave";
    if (text != nullptr && !on_leave)
      out.error("E366", text->span, "cancel must be on_leave, not " + in_quotes(text->text),
                "write cancel: on_leave");
    if (orders == nullptr)
      out.error("E366", cancel->span, "'cancel' needs 'orders': it cancels the goal of this behaviour",
                "write orders: NAME, a memory cell with a goal, or remove 'cancel'");
  }
  if (orders == nullptr) return std::nullopt;
  const Node* text = text_of(*orders->value, orders->span, "orders", out, "name a memory cell with a goal");
  if (text == nullptr) return std::nullopt;
  std::vector<std::string> goals;
  for (const Field& cell : memory)
    if (cell.few && cell.few->goal) goals.push_back(cell.name);
  const auto found = std::ranges::find(memory, text->text, &Field::name);
  if (found == memory.end()) {
    Hint hint = did_you_mean(text->text, goals);
    if (goals.empty())
      hint = "declare it: memory: { " + text->text + ": { goal: out.goal, progress: in.progress } }";
    out.error("E101", text->span, "unknown memory " + in_quotes(text->text), std::move(hint));
    return std::nullopt;
  }
  if (!found->few || !found->few->goal) {
    out.error("E365", text->span, in_quotes("memory." + text->text) + " holds no goal, so it is not ordered",
              found->few ? "change it by 'sets', or declare it as { goal: out.NAME, progress: in.NAME }"
                         : "declare it as { goal: out.NAME, progress: in.NAME }");
    return std::nullopt;
  }
  if (on_leave && found->few->goal->goal.valid() && !found->few->goal->cancels)
    out.error("E366", cancel->span,
              "the output of " + in_quotes("memory." + text->text) + " has no field 'cancel'",
              "add cancel: bool to its type, or remove 'cancel'");
  return Order{static_cast<std::uint32_t>(found - memory.begin()), on_leave, text->span};
}

void check_goals(const Subsystem& subsystem, Diagnostics& out) {
  GoalCheck check(subsystem, out);
  for (std::uint32_t cell = 0; cell < subsystem.memory.size(); ++cell)
    if (subsystem.memory[cell].few && subsystem.memory[cell].few->goal) check.check(cell);
}

}  // namespace tessera::spec
