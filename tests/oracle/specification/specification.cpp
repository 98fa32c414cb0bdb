#include "specification.hpp"

#include <sstream>
#include <stdexcept>

namespace oracle {
namespace {

/// A flow list or map of texts.
std::string joined(const std::vector<std::string>& parts, const char* open, const char* close) {
  std::string text = open;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i == 0 ? "" : ", ") + parts[i];
  return text + close;
}
std::string list(const std::vector<std::string>& parts) { return joined(parts, "[", "]"); }
/// Brackets need quotes in a flow list or map.
std::string flow_text(const std::string& text) {
  return text.find('[') == std::string::npos || text.front() == '{' ? text : "\"" + text + "\"";
}
std::string names(std::vector<std::string> all) {
  for (std::string& one : all) one = flow_text(one);
  return list(all);
}
std::string with_i(std::string text);
/// An entry that leads to "v[0]" stands for those to all members.
std::string with_i(std::string text, const std::string& to) {
  return to.ends_with("[0]") ? with_i(std::move(text)) : text;
}
std::string with_i(std::string text) {
  for (std::size_t at = text.find("[0]"); at != std::string::npos; at = text.find("[0]"))
    text.replace(at, 3, "[i]");
  return text;
}
/// "v[1]": the text of "v[0]" is that of all members.
bool is_other_member(const std::string& name) { return name.ends_with("]") && !name.ends_with("[0]"); }
std::string map(const std::vector<std::string>& parts) { return joined(parts, "{ ", " }"); }

/// Different expressions of the subsystem's dice, so that runs take every way.
class Expressions {
 public:
  std::string next(Truth truth) {
    if (truth == Truth::yes) return "true";
    if (truth == Truth::no) return "false";
    ++number_;
    return "memory.dice / " + std::to_string(number_ * 7 + 1) + " % 3 == " + std::to_string(number_ % 3);
  }
  std::string next(Truth truth, const Asked* asked) {
    return truth == Truth::open && asked != nullptr ? formula(*asked) : next(truth);
  }
  std::string formula(const Asked& asked) {
    using Kind = Asked::Kind;
    if (asked.kind == Kind::open) return next(Truth::open);
    if (asked.kind == Kind::fresh) return "in." + asked.buffer + ".fresh";
    if (asked.kind == Kind::late_input) return "in." + asked.buffer + ".timed_out";
    if (asked.kind == Kind::late_output) return "out." + asked.buffer + ".timed_out";
    if (asked.kind == Kind::memory) return asked.text;
    if (!asked.text.empty()) return asked.text;
    if (asked.kind == Kind::negation) return "not (" + formula(asked.parts[0]) + ")";
    const std::string first = "(" + formula(asked.parts[0]) + ")";
    return first + (asked.kind == Kind::both ? " && (" : " || (") + formula(asked.parts[1]) + ")";
  }

 private:
  int number_ = 0;
};

std::string condition(const Condition& of, Expressions& expressions) {
  if (of.form == Condition::Form::single) return flow_text(expressions.next(of.single, of.asks(0)));
  std::vector<std::string> parts;
  for (const auto& [name, truth] : of.named)
    parts.push_back(name + ": " + flow_text(expressions.next(truth, of.asks(parts.size()))));
  return map(parts);
}

/// ", sets: { c0: v1, c1: +1 }"
std::string changes(const std::vector<Change>& sets, const Subsystem& owner) {
  std::vector<std::string> parts;
  for (const Change& change : sets) {
    const Cell& cell = owner.memory[static_cast<std::size_t>(change.cell)];
    if (!cell.goal.empty()) continue;
    const std::string to = change.step > 0   ? "+1"
                           : change.step < 0 ? "-1"
                                             : cell.values[static_cast<std::size_t>(change.value)];
    parts.push_back(cell.name + ": " + to);
  }
  return "sets: " + map(parts);
}

std::string entry(const Entry& of, const Subsystem& owner, Expressions& expressions) {
  const std::string sets = of.sets.empty() ? "" : ", " + changes(of.sets, owner);
  if (of.when == Entry::When::always) return sets.empty() ? of.to : "{ to: " + of.to + sets + " }";
  std::string when = of.name;
  if (of.when == Entry::When::error) when = "error";
  if (of.when == Entry::When::until) when = "until";
  if (of.when == Entry::When::expression) when = expressions.next(of.truth, of.asked ? &*of.asked : nullptr);
  return "{ to: " + flow_text(of.to) + ", when: " + flow_text(when) + sets + " }";
}

/// The map form of `send`, in which outputs say when they are sent.
std::string sent(const Behaviour& of, Expressions& expressions) {
  if (of.skips.empty()) return names(*of.send);
  std::vector<std::string> keys;
  for (const std::string& output : *of.send) {
    keys.push_back(flow_text(output));
    for (const Skip& skip : of.skips)
      if (skip.output == output)
        keys.back() +=
            skip.by_function
                ? ": { skip: allowed }"
                : ": { when: " +
                      flow_text(expressions.next(Truth::open, skip.asked ? &*skip.asked : nullptr)) + " }";
  }
  return map(keys);
}

std::string behaviour(const Behaviour& of, const Subsystem& owner, Expressions& expressions) {
  std::vector<std::string> keys;
  if (of.has_until)
    keys.push_back("until: " + flow_text(expressions.next(Truth::open, of.until ? &*of.until : nullptr)));
  if (!of.on_error.empty()) keys.push_back("on_error: " + of.on_error);
  if (!of.start.empty()) keys.push_back("start: " + of.start);
  if (of.terminal.form != Condition::Form::absent)
    keys.push_back("terminal: " + condition(of.terminal, expressions));
  if (of.error.form != Condition::Form::absent) keys.push_back("error: " + condition(of.error, expressions));
  if (of.next.size() == 1) keys.push_back("next: " + entry(of.next[0], owner, expressions));
  if (of.next.size() > 1) {
    std::vector<std::string> entries;
    for (const Entry& one : of.next)
      if (!is_other_member(one.to) || !of.each.empty()) {
        entries.push_back(entry(one, owner, expressions));
        if (of.each.empty()) entries.back() = with_i(entries.back(), one.to);
      }
    keys.push_back("next: " + list(entries));
  }
  if (of.send) keys.push_back("send: " + sent(of, expressions));
  if (of.receive) keys.push_back("receive: " + names(*of.receive));
  if (of.parallel) keys.push_back("transfer: parallel");
  if (of.takes) keys.push_back("takes: 3 ms");
  if (!of.sets.empty()) keys.push_back(changes(of.sets, owner));
  for (const Change& change : of.sets)
    if (const Cell& cell = owner.memory[static_cast<std::size_t>(change.cell)]; !cell.goal.empty())
      keys.push_back("orders: " + cell.name + (of.cancels ? ", cancel: on_leave" : ""));
  if (of.is_group) {
    std::vector<std::string> inside;
    for (const Behaviour& one : owner.behaviours)
      if (one.group == of.name) inside.push_back(behaviour(one, owner, expressions));
    keys.push_back("behaviours: " + map(inside));
  }
  if (of.each.empty()) return of.name + ": " + map(keys);
  keys.push_back("for: each " + of.each);
  return of.name.substr(0, of.name.find('[')) + ": " + with_i(map(keys));
}

void buffers(std::ostream& out, const std::string& indent, const char* key,
             const std::vector<std::string>& names, const std::string& each) {
  std::vector<std::string> parts;
  for (const std::string& name : names)
    if (!is_other_member(name))
      parts.push_back(name.ends_with("]") ? name.substr(0, name.find('[')) + ": \"V[each " + each + "]\""
                                          : name + ": V");
  if (!parts.empty()) out << indent << key << ": " << map(parts) << "\n";
}

void subsystem(std::ostream& out, const std::string& indent, const Subsystem& of) {
  const std::string inner = indent + "  ";
  Expressions expressions;
  out << indent << of.name << ":\n";
  if (of.rate) out << inner << "rate: 50 Hz\n";
  buffers(out, inner, "inputs", of.inputs, of.each);
  buffers(out, inner, "outputs", of.outputs, of.each);
  std::vector<std::string> cells{"dice: uint32"};
  for (const Cell& cell : of.memory)
    cells.push_back(
        cell.name +
        (!cell.goal.empty() ? ": { goal: out." + cell.goal + ", progress: in." + cell.progress
         : cell.least < 0   ? ": { values: " + list(cell.values)
                            : ": { counts: " + cell.values.front() + ".." + cell.values.back()) +
        (cell.initial == 0 ? "" : ", initial: " + cell.values[static_cast<std::size_t>(cell.initial)]) +
        " }");
  out << inner << "memory: " << map(cells) << "\n";
  if (!of.start.empty()) out << inner << "start: " << of.start << "\n";
  if (!of.on_error.empty()) out << inner << "on_error: " << of.on_error << "\n";
  out << inner << "behaviours:\n";
  for (const Behaviour& one : of.behaviours)
    if (one.group.empty() && !is_other_member(one.name))
      out << inner << "  " << behaviour(one, of, expressions) << "\n";
}

void body(std::ostream& out, const std::string& indent, const Agent& of) {
  for (const Subsystem& one : of.subsystems)
    if (one.kind == Subsystem::Kind::control) subsystem(out, indent, one);
  for (const auto& [kind, key] :
       {std::pair{Subsystem::Kind::receptor, "receptors"}, {Subsystem::Kind::effector, "effectors"}}) {
    bool first = true;
    for (const Subsystem& one : of.subsystems) {
      if (one.kind != kind) continue;
      if (first) out << indent << key << ":\n";
      first = false;
      subsystem(out, indent + "  ", one);
    }
  }
}

void agent(std::ostream& out, const Agent& of) {
  out << "  " << of.name << ":\n";
  if (!of.use.empty()) out << "    use: " << of.use << "\n";
  if (of.count > 0) out << "    count: " << of.count << "\n";
  if (of.ring) out << "    ring: true\n";
  body(out, "    ", of);
}

std::string model_side(const ModelSide& of, const char* operation, const std::string& indent) {
  std::vector<std::string> places;
  for (const auto& place : of.places)
    places.push_back(place.slot == 0
                         ? place.name
                         : place.name + ": { " + operation + ": " + std::to_string(place.slot) + " }");
  std::string text = indent + "places: " + map(places) + "\n" + indent + "transitions:\n";
  for (const auto& t : of.transitions)
    text += indent + "  " + t.name + ": { from: " + list(t.from) + ", to: " + list(t.to) +
            (t.elapsed ? ", when: elapsed" : "") + " }\n";
  return text;
}

void model(std::ostream& out, const Model& of) {
  std::vector<std::string> shared;
  for (const auto& [name, tokens] : of.shared) shared.push_back(name + ": " + std::to_string(tokens));
  out << "  " << of.name << ":\n    slots: " << of.slots << "\n    shared: " << map(shared) << "\n";
  out << "    send:\n" << model_side(of.send, "write", "      ");
  out << "    receive:\n" << model_side(of.receive, "read", "      ");
}

std::string channel(const Channel& of) {
  const bool plain = !of.send_blocking && !of.receive_blocking && of.model.empty() && !of.send_timeout &&
                     !of.receive_timeout;
  if (plain) return "\"" + written(of.from) + " -> " + written(of.to) + "\"";
  std::vector<std::string> keys{"from: \"" + written(of.from) + "\"", "to: \"" + written(of.to) + "\""};
  if (!of.model.empty()) keys.push_back("model: " + of.model);
  if (of.send_blocking) keys.push_back("send: blocking");
  if (of.receive_blocking) keys.push_back("receive: blocking");
  if (of.send_timeout && of.receive_timeout)
    keys.push_back("timeout: 30 ms");
  else if (of.send_timeout)
    keys.push_back("send_timeout: 70 ms");
  else if (of.receive_timeout)
    keys.push_back("receive_timeout: 45 ms");
  return map(keys);
}

std::string property(const Property& of) {
  std::vector<std::string> keys;
  if (!of.name.empty()) keys.push_back("name: " + of.name);
  std::string value = "\"" + written(of.first) + "\"";
  if (of.kind == Property::Kind::leads_to)
    value = of.arrow ? "\"" + written(of.first) + " => " + written(of.second) + "\""
                     : "[\"" + written(of.first) + "\", \"" + written(of.second) + "\"]";
  keys.push_back(kind_name(of.kind) + ": " + value);
  return map(keys);
}

}  // namespace

const std::vector<Subsystem>& subsystems_of(const Specification& specification, const Agent& agent) {
  if (agent.use.empty()) return agent.subsystems;
  for (const Agent& one : specification.templates)
    if (one.name == agent.use) return subsystems_of(specification, one);
  throw std::logic_error("no template " + agent.use);
}

const std::vector<std::string>& goal_states() {
  static const std::vector<std::string> states{"none",     "accepted", "executing", "canceling", "succeeded",
                                               "canceled", "aborted",  "rejected",  "gone",      "ordered"};
  return states;
}

bool compares(const std::string& comparison, int left, int right) {
  if (comparison == "==") return left == right;
  if (comparison == "!=") return left != right;
  if (comparison == "<") return left < right;
  if (comparison == "<=") return left <= right;
  return comparison == ">" ? left > right : left >= right;
}

std::string written(const End& end) {
  return end.agent + (end.index.empty() ? "" : "[" + end.index + "]") + "." + end.subsystem + "." +
         end.buffer;
}

std::string written(const Formula& formula) {
  const auto part = [](const Formula& of) {
    const bool brackets = of.kind == Formula::Kind::all_of || of.kind == Formula::Kind::any_of;
    return brackets ? "(" + written(of) + ")" : written(of);
  };
  switch (formula.kind) {
    case Formula::Kind::path:
      return formula.path;
    case Formula::Kind::any:
      return "any(" + formula.path + ")";
    case Formula::Kind::all:
      return "all(" + formula.path + ")";
    case Formula::Kind::negation:
      return "not " + part(formula.parts[0]);
    case Formula::Kind::all_of:
      return part(formula.parts[0]) + " and " + part(formula.parts[1]);
    case Formula::Kind::any_of:
      return part(formula.parts[0]) + " or " + part(formula.parts[1]);
  }
  return {};
}

std::string kind_name(Property::Kind kind) {
  switch (kind) {
    case Property::Kind::never:
      return "never";
    case Property::Kind::always:
      return "always";
    case Property::Kind::reachable:
      return "reachable";
    case Property::Kind::always_reachable:
      return "always_reachable";
    case Property::Kind::leads_to:
      return "leads_to";
  }
  return {};
}

std::string to_yaml(const Specification& specification) {
  std::ostringstream out;
  out << "tessera: 1\nsystem: s\ntypes: { V: { v: float64, call: uint32, cancel: bool, state: uint8 } }\n";
  if (!specification.models.empty()) out << "models:\n";
  for (const Model& one : specification.models) model(out, one);
  if (!specification.templates.empty()) out << "templates:\n";
  for (const Agent& one : specification.templates) agent(out, one);
  out << "agents:\n";
  for (const Agent& one : specification.agents) agent(out, one);
  if (!specification.channels.empty()) out << "channels:\n";
  for (const Channel& one : specification.channels) out << "  - " << channel(one) << "\n";
  if (!specification.properties.empty()) out << "properties:\n";
  for (const Property& one : specification.properties) out << "  - " << property(one) << "\n";
  return out.str();
}

}  // namespace oracle
