#include "conditions.hpp"

#include <set>

namespace oracle {
namespace {

using Held = std::set<std::string>;

std::vector<Truth> truths(const Condition& condition) {
  if (condition.form == Condition::Form::absent) return {Truth::no};
  if (condition.form == Condition::Form::single) return {condition.single};
  std::vector<Truth> all;
  for (const auto& [name, truth] : condition.named) all.push_back(truth);
  return all;
}
bool can_hold(const Condition& condition) {
  for (const Truth truth : truths(condition))
    if (truth != Truth::no) return true;
  return false;
}
bool certain(const Condition& condition) {
  for (const Truth truth : truths(condition))
    if (truth == Truth::yes) return true;
  return false;
}

/// Every set of named expressions that may have held when the condition as a whole did.
std::vector<Held> held_sets(const Condition& condition) {
  if (condition.form != Condition::Form::named) return {{}};
  std::vector<Held> sets{{}};
  for (const auto& [name, truth] : condition.named) {
    std::vector<Held> grown;
    for (const Held& set : sets) {
      if (truth != Truth::yes) grown.push_back(set);
      if (truth != Truth::no) {
        grown.push_back(set);
        grown.back().insert(name);
      }
    }
    sets = grown;
  }
  std::erase_if(sets, [](const Held& set) { return set.empty(); });
  return sets;
}

bool unconditional(const Entry& entry) {
  return entry.when == Entry::When::always ||
         (entry.when == Entry::When::expression && entry.truth == Truth::yes);
}

/// The first entry without a condition; none: the size.
std::size_t first_unconditional(const std::vector<Entry>& next) {
  std::size_t k = 0;
  while (k < next.size() && !unconditional(next[k])) ++k;
  return k;
}

/// Walks `next` in order after a terminal ending: the first entry that holds is taken.
void follow_terminal(const std::vector<Entry>& next, const Held& held, Following& following) {
  for (std::size_t k = 0; k < next.size(); ++k) {
    Truth truth = Truth::yes;
    if (next[k].when == Entry::When::error) truth = Truth::no;
    if (next[k].when == Entry::When::name) truth = held.contains(next[k].name) ? Truth::yes : Truth::no;
    if (next[k].when == Entry::When::expression) truth = next[k].truth;
    if (truth != Truth::no) following.entries[k] = true;
    if (truth == Truth::yes) return;
  }
  following.none = true;
}

/// After an error only the entries that name it count; if there is none, the subsystem ends.
void follow_error(const std::vector<Entry>& next, const Held& held, Following& following) {
  for (std::size_t k = 0; k < next.size(); ++k) {
    const bool names = next[k].when == Entry::When::error ||
                       (next[k].when == Entry::When::name && held.contains(next[k].name));
    if (!names) continue;
    following.entries[k] = true;
    return;
  }
  following.entries[first_unconditional(next)] = true;
}

}  // namespace

std::vector<Entry> next_of(const Behaviour& behaviour) {
  std::vector<Entry> next = behaviour.next;
  if (next.empty()) next = {{"end", Entry::When::always, "", Truth::open}};
  for (const Entry& entry : next)
    if (entry.when == Entry::When::error) return next;
  const std::size_t k = first_unconditional(next);
  if (k == next.size() || next[k].to != "end") next.push_back({"end", Entry::When::error, "", Truth::open});
  return next;
}

Ways ways_of(const Behaviour& behaviour, bool exceptions) {
  const std::vector<Entry> next = next_of(behaviour);
  Ways ways;
  const bool fails = can_hold(behaviour.error), always_fails = certain(behaviour.error);
  ways.error = fails || exceptions;
  ways.terminal = !always_fails && can_hold(behaviour.terminal);
  ways.go_on = !always_fails && !certain(behaviour.terminal);
  ways.after_terminal.entries.resize(next.size());
  ways.after_error.entries.resize(next.size());
  if (ways.terminal)
    for (const Held& held : held_sets(behaviour.terminal)) follow_terminal(next, held, ways.after_terminal);
  if (fails)
    for (const Held& held : held_sets(behaviour.error)) follow_error(next, held, ways.after_error);
  if (exceptions) follow_error(next, {}, ways.after_error);
  return ways;
}

FlatNet abstract_net(const FlatNet& flat, bool exceptions) {
  FlatNet net = flat;
  std::vector<Ways> ways;
  for (const auto& behaviour : net.behaviours) ways.push_back(ways_of(*behaviour.of, exceptions));
  std::vector<int> moved(net.transitions.size(), -1);
  std::vector<FlatTransition> kept;
  for (std::size_t t = 0; t < net.transitions.size(); ++t) {
    const FlatTransition& transition = net.transitions[t];
    bool possible = true;
    if (transition.role != Role::plain) {
      const Ways& of = ways[static_cast<std::size_t>(transition.behaviour)];
      if (transition.role == Role::t4) possible = of.go_on;
      if (transition.role == Role::t5) possible = of.terminal;
      if (transition.role == Role::t6) possible = of.error;
      if (transition.role == Role::next) {
        const auto k = static_cast<std::size_t>(transition.entry);
        possible = of.after_terminal.entries[k] || of.after_error.entries[k];
      }
    }
    if (!possible) continue;
    moved[t] = static_cast<int>(kept.size());
    kept.push_back(transition);
  }
  for (std::size_t b = 0; b < ways.size(); ++b) {
    if (!ways[b].after_terminal.none && !ways[b].after_error.none) continue;
    const auto& behaviour = net.behaviours[b];
    const int none = static_cast<int>(net.places.size());
    net.places.push_back({behaviour.path + ".out.none", false, false});
    net.place_of[net.places.back().name] = none;
    kept.push_back({behaviour.path + ".out none",
                    {behaviour.out},
                    {none},
                    Role::none,
                    behaviour.subsystem,
                    static_cast<int>(b),
                    -1});
  }
  net.transitions = kept;
  for (auto& channel : net.channels)
    for (int& read : channel.reads) read = moved[static_cast<std::size_t>(read)];
  return net;
}

}  // namespace oracle
