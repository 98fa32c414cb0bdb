#include "conditions.hpp"

#include <algorithm>
#include <set>

#include "memory.hpp"

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
/// allowed: entries that would take a counter out of its range count as if their condition did not hold.
void follow_terminal(const std::vector<Entry>& next, const std::vector<Truth>& allowed, const Held& held,
                     Following& following) {
  for (std::size_t k = 0; k < next.size(); ++k) {
    if (allowed[k] == Truth::no) continue;
    Truth truth = Truth::yes;
    if (next[k].when == Entry::When::error) truth = Truth::no;
    if (next[k].when == Entry::When::name) truth = held.contains(next[k].name) ? Truth::yes : Truth::no;
    if (next[k].when == Entry::When::expression) truth = next[k].truth;
    if (truth != Truth::no) following.entries[k] = true;
    if (truth == Truth::yes && allowed[k] == Truth::yes) return;
  }
  following.none = true;
}

/// After an error only the entries that name it count; if there is none, the subsystem ends.
/// end: the entry by which it then does.
void follow_error(const std::vector<Entry>& next, const std::vector<Truth>& allowed, const Held& held,
                  std::size_t end, Following& following) {
  for (std::size_t k = 0; k < next.size(); ++k) {
    const bool names = next[k].when == Entry::When::error ||
                       (next[k].when == Entry::When::name && held.contains(next[k].name));
    if (!names || allowed[k] == Truth::no) continue;
    following.entries[k] = true;
    if (allowed[k] == Truth::yes) return;
  }
  if (end < next.size()) following.entries[end] = true;
}

/// Conjunction, with `no` as the weakest: for three truths the smaller one of no < open < yes.
int rank(Truth truth) { return truth == Truth::no ? 0 : truth == Truth::open ? 1 : 2; }

/// The truth of formulas where facts have certain values.
class Knowledge {
 public:
  Knowledge(const FlatNet& net, int behaviour, bool exceptions, const std::map<int, int>& values)
      : net_(net),
        behaviour_(net.behaviours[static_cast<std::size_t>(behaviour)]),
        exceptions_(exceptions),
        values_(values) {}

  Truth of(const Asked& asked) const {
    using Kind = Asked::Kind;
    if (asked.kind == Kind::open) return Truth::open;
    if (asked.kind == Kind::negation) {
      const Truth truth = of(asked.parts[0]);
      return truth == Truth::open ? truth : truth == Truth::yes ? Truth::no : Truth::yes;
    }
    if (asked.kind == Kind::both || asked.kind == Kind::either) {
      const Truth a = of(asked.parts[0]), b = of(asked.parts[1]);
      return (asked.kind == Kind::both) == (rank(a) < rank(b)) ? a : b;
    }
    for (const auto& [fact, value] : values_) {
      const FlatNet::FactInfo& info = net_.facts[static_cast<std::size_t>(fact)];
      if (info.buffer == asked.buffer && info.sends == (asked.kind == Kind::late_output))
        return of(asked, info, value);
    }
    return Truth::open;
  }

 private:
  Truth of(const Asked& asked, const FlatNet::FactInfo& fact, int value) const {
    if (fact.cell >= 0) return asked.holds[static_cast<std::size_t>(value)] ? Truth::yes : Truth::no;
    const bool well = value == 0;
    if (asked.kind == Asked::Kind::fresh) return !well ? Truth::no : exceptions_ ? Truth::open : Truth::yes;
    if (well) return Truth::no;
    if (fact.sends) return Truth::yes;
    if (!fact.blocks) return Truth::no;
    // A behaviour that does not receive it may run before anything was received.
    const auto& received = behaviour_.received;
    return std::find(received.begin(), received.end(), fact.channels[0]) != received.end() ? Truth::yes
                                                                                           : Truth::open;
  }

  const FlatNet& net_;
  const FlatNet::BehaviourInfo& behaviour_;
  bool exceptions_;
  const std::map<int, int>& values_;
};

void resolve(Condition& condition, const Knowledge& knowledge) {
  if (condition.form == Condition::Form::single && condition.single == Truth::open && condition.asks(0))
    condition.single = knowledge.of(*condition.asks(0));
  for (std::size_t k = 0; k < condition.named.size(); ++k)
    if (condition.named[k].second == Truth::open && condition.asks(k))
      condition.named[k].second = knowledge.of(*condition.asks(k));
}

/// The formulas of a condition whose truth is open.
void add_asked(const Condition& condition, std::vector<const Asked*>& all) {
  if (condition.form == Condition::Form::single && condition.single == Truth::open && condition.asks(0))
    all.push_back(condition.asks(0));
  if (condition.form != Condition::Form::named) return;
  for (std::size_t k = 0; k < condition.named.size(); ++k)
    if (condition.named[k].second == Truth::open && condition.asks(k)) all.push_back(condition.asks(k));
}

void find_facts(const FlatNet& net, int subsystem, const Asked& asked, std::vector<int>& facts) {
  for (std::size_t f = 0; f < net.facts.size(); ++f) {
    const FlatNet::FactInfo& fact = net.facts[f];
    const int number = static_cast<int>(f);
    if (fact.subsystem == subsystem && fact.buffer == asked.buffer &&
        fact.sends == (asked.kind == Asked::Kind::late_output) &&
        std::find(facts.begin(), facts.end(), number) == facts.end())
      facts.push_back(number);
  }
  for (const Asked& part : asked.parts) find_facts(net, subsystem, part, facts);
}

/// counters: facts that are asked for after those of the formulas.
/// last: formulas that are asked after these.
std::vector<std::map<int, int>> values_of(const FlatNet& net, int behaviour,
                                          const std::vector<const Asked*>& all,
                                          const std::vector<int>& counters = {},
                                          const std::vector<const Asked*>& last = {}) {
  std::vector<int> facts;
  for (const Asked* asked : all)
    find_facts(net, net.behaviours[static_cast<std::size_t>(behaviour)].subsystem, *asked, facts);
  for (const int fact : counters)
    if (std::find(facts.begin(), facts.end(), fact) == facts.end()) facts.push_back(fact);
  for (const Asked* asked : last)
    find_facts(net, net.behaviours[static_cast<std::size_t>(behaviour)].subsystem, *asked, facts);
  std::vector<std::map<int, int>> values{{}};
  for (const int fact : facts) {
    const std::size_t count = net.facts[static_cast<std::size_t>(fact)].values.size();
    if (values.size() * count > 4096) break;  // those that are asked last stay open
    values = with_all_values(net, fact, values);
  }
  return values;
}

/// behaviour: its conditions are as true as they are known to be.
/// end: the entry by which an error ends the subsystem that none names.
Ways follow(const Behaviour& behaviour, const std::vector<Truth>& allowed, std::size_t end, bool exceptions) {
  Ways ways;
  const bool fails = can_hold(behaviour.error), always_fails = certain(behaviour.error);
  const bool throws = exceptions && behaviour.may_fail;
  ways.error = fails || throws;
  ways.terminal = !always_fails && can_hold(behaviour.terminal);
  ways.go_on = !always_fails && !certain(behaviour.terminal);
  ways.after_terminal.entries.resize(behaviour.next.size());
  ways.after_error.entries.resize(behaviour.next.size());
  if (ways.terminal)
    for (const Held& held : held_sets(behaviour.terminal))
      follow_terminal(behaviour.next, allowed, held, ways.after_terminal);
  if (fails)
    for (const Held& held : held_sets(behaviour.error))
      follow_error(behaviour.next, allowed, held, end, ways.after_error);
  if (throws) follow_error(behaviour.next, allowed, {}, end, ways.after_error);
  return ways;
}

std::vector<const Asked*> asked_at_end(const Behaviour& behaviour) {
  std::vector<const Asked*> all;
  add_asked(behaviour.terminal, all);
  add_asked(behaviour.error, all);
  return all;
}

/// Whether some entry, or that none holds, follows one of the two endings alone, with nothing known.
bool depends_on_ending(const FlatNet& net, int behaviour) {
  const Ways ways = ways_of(net, behaviour, true, {});
  return ways.terminal &&
         (ways.after_terminal.entries != ways.after_error.entries || ways.after_terminal.none);
}

}  // namespace

std::vector<const Asked*> expressions_of(const Behaviour& behaviour) {
  std::vector<const Asked*> all;
  add_asked(behaviour.terminal, all);
  add_asked(behaviour.error, all);
  for (const Entry& entry : behaviour.next)
    if (entry.when == Entry::When::expression && entry.truth == Truth::open && entry.asked)
      all.push_back(&*entry.asked);
  for (const Skip& skip : behaviour.skips)
    if (skip.asked) all.push_back(&*skip.asked);
  if (behaviour.has_until && behaviour.until) all.push_back(&*behaviour.until);
  return all;
}

std::vector<std::map<int, int>> values_of_skip(const FlatNet& net, int behaviour, const Skip& skip) {
  std::vector<const Asked*> all;
  if (skip.asked) all.push_back(&*skip.asked);
  return values_of(net, behaviour, all);
}

Truth sends(const FlatNet& net, int behaviour, const Skip& skip, bool exceptions,
            const std::map<int, int>& values) {
  return skip.asked ? Knowledge(net, behaviour, exceptions, values).of(*skip.asked) : Truth::open;
}

std::vector<std::map<int, int>> values_of_ending(const FlatNet& net, int behaviour) {
  return values_of(net, behaviour, asked_at_end(net.behaviours[static_cast<std::size_t>(behaviour)].whole));
}

std::vector<std::map<int, int>> values_of_next(const FlatNet& net, int behaviour) {
  const Behaviour& of = net.behaviours[static_cast<std::size_t>(behaviour)].whole;
  const auto has = [](const Condition& condition, const std::string& name) {
    return std::any_of(condition.named.begin(), condition.named.end(),
                       [&](const auto& one) { return one.first == name; });
  };
  std::vector<const Asked*> all;
  for (const Entry& entry : of.next) {
    if (entry.when == Entry::When::expression && entry.truth == Truth::open && entry.asked)
      all.push_back(&*entry.asked);
    if (entry.when != Entry::When::name) continue;
    add_asked(has(of.terminal, entry.name) ? of.terminal : of.error, all);
  }
  const int number = net.behaviours[static_cast<std::size_t>(behaviour)].subsystem;
  const Subsystem& subsystem = *net.subsystems[static_cast<std::size_t>(number)].of;
  std::vector<int> counters;
  for (const Entry& entry : of.next) {
    const std::vector<Change> changes = changes_of(subsystem, entry);
    if (!may_be_blocked(subsystem, changes)) continue;
    for (const Change& change : changes)
      if (change.step != 0) counters.push_back(fact_of_cell(net, number, change.cell));
  }
  return values_of(net, behaviour, all, counters,
                   depends_on_ending(net, behaviour) ? asked_at_end(of) : std::vector<const Asked*>());
}

std::string suffix(const FlatNet& net, const std::map<int, int>& values) {
  std::string text;
  for (const auto& [fact, value] : values) {
    const FlatNet::FactInfo& info = net.facts[static_cast<std::size_t>(fact)];
    text += "." + info.buffer + "." + info.values[static_cast<std::size_t>(value)];
  }
  return text;
}

std::vector<Entry> next_of(const Subsystem& subsystem, const Behaviour& behaviour) {
  std::vector<Entry> next = behaviour.next;
  if (next.empty()) next = {{"end", Entry::When::always, "", Truth::open}};
  if (!behaviour.may_fail && !can_hold(behaviour.error)) return next;
  for (const Entry& entry : next)
    if (entry.when == Entry::When::error && !may_be_blocked(subsystem, changes_of(subsystem, entry)))
      return next;
  const std::size_t k = first_unconditional(next);
  if (k == next.size() || next[k].to != "end" || !next[k].sets.empty())
    next.push_back({"end", Entry::When::error, "", Truth::open});
  return next;
}

Ways ways_of(const FlatNet& net, int number, bool exceptions, const std::map<int, int>& values) {
  const Knowledge knowledge(net, number, exceptions, values);
  Behaviour behaviour = net.behaviours[static_cast<std::size_t>(number)].whole;
  const int owner = net.behaviours[static_cast<std::size_t>(number)].subsystem;
  const Subsystem& subsystem = *net.subsystems[static_cast<std::size_t>(owner)].of;
  std::vector<Truth> allowed;
  for (const Entry& entry : behaviour.next) {
    const std::vector<Change> changes = changes_of(subsystem, entry);
    const bool knows_all = std::all_of(changes.begin(), changes.end(), [&](const Change& one) {
      return one.step == 0 || values.contains(fact_of_cell(net, owner, one.cell));
    });
    allowed.push_back(!changed(net, owner, changes, values)              ? Truth::no
                      : knows_all || !may_be_blocked(subsystem, changes) ? Truth::yes
                                                                         : Truth::open);
  }
  const std::size_t end = first_unconditional(behaviour.next);
  resolve(behaviour.terminal, knowledge);
  resolve(behaviour.error, knowledge);
  for (Entry& entry : behaviour.next)
    if (entry.when == Entry::When::expression && entry.truth == Truth::open && entry.asked)
      entry.truth = knowledge.of(*entry.asked);
  return follow(behaviour, allowed, end, exceptions);
}

Ways ways_of(const Subsystem& subsystem, const Behaviour& written_out, bool exceptions) {
  std::vector<Truth> allowed;
  for (const Entry& entry : written_out.next)
    allowed.push_back(may_be_blocked(subsystem, changes_of(subsystem, entry)) ? Truth::open : Truth::yes);
  return follow(written_out, allowed, first_unconditional(written_out.next), exceptions);
}

bool can_end(const FlatNet& net, int behaviour, bool exceptions) {
  const std::vector<std::map<int, int>> all = values_of_ending(net, behaviour);
  return std::any_of(all.begin(), all.end(), [&](const std::map<int, int>& values) {
    const Ways ways = ways_of(net, behaviour, exceptions, values);
    return ways.terminal || ways.error;
  });
}

FlatNet abstract_net(const FlatNet& flat, bool exceptions) {
  FlatNet net = flat;
  std::vector<int> moved(net.transitions.size(), -1);
  std::vector<FlatTransition> kept;
  for (std::size_t t = 0; t < net.transitions.size(); ++t) {
    const FlatTransition& transition = net.transitions[t];
    bool possible = true;
    if (transition.role == Role::sends || transition.role == Role::skips) {
      const Truth truth = sends(flat, transition.behaviour, *transition.skip, exceptions, transition.facts);
      possible = truth != (transition.role == Role::sends ? Truth::no : Truth::yes);
    } else if (transition.role != Role::plain) {
      const Ways of = ways_of(flat, transition.behaviour, exceptions, transition.facts);
      if (transition.role == Role::t4) possible = of.go_on;
      if (transition.role == Role::t5) possible = of.terminal;
      if (transition.role == Role::t6) possible = of.error;
      if (transition.role == Role::next) {
        const auto k = static_cast<std::size_t>(transition.entry);
        possible = (of.after_terminal.entries[k] || of.after_error.entries[k]) &&
                   can_end(flat, transition.behaviour, exceptions);
      }
    }
    if (!possible) continue;
    moved[t] = static_cast<int>(kept.size());
    kept.push_back(transition);
  }
  for (std::size_t b = 0; b < flat.behaviours.size(); ++b)
    for (const std::map<int, int>& values : values_of_next(flat, static_cast<int>(b))) {
      const Ways ways = ways_of(flat, static_cast<int>(b), exceptions, values);
      if (!ways.after_terminal.none && !ways.after_error.none) continue;
      if (!can_end(flat, static_cast<int>(b), exceptions)) continue;
      const auto& behaviour = net.behaviours[b];
      const int none = static_cast<int>(net.places.size());
      net.places.push_back({behaviour.path + ".out.none" + suffix(net, values), false, false});
      net.place_of[net.places.back().name] = none;
      kept.push_back({behaviour.path + ".out none" + suffix(net, values),
                      {behaviour.out},
                      {none},
                      Role::none,
                      behaviour.subsystem,
                      static_cast<int>(b),
                      -1,
                      values});
      for (const auto& [fact, value] : values) {
        const int place = net.facts[static_cast<std::size_t>(fact)].places[static_cast<std::size_t>(value)];
        kept.back().pre.push_back(place);
        kept.back().post.push_back(place);
      }
    }
  net.transitions = kept;
  for (auto& channel : net.channels)
    for (int& read : channel.reads) read = moved[static_cast<std::size_t>(read)];
  return net;
}

}  // namespace oracle
