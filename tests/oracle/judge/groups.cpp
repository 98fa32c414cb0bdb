#include "groups.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "conditions.hpp"
#include "memory.hpp"

namespace oracle {
namespace {

constexpr const char* own = "(own)";   // the terminal condition of a behaviour that has no named ones
constexpr const char* left = "(end)";  // a behaviour in the group has led to `end`

std::string until_of(const Behaviour& group) { return "until " + group.name; }

/// The groups around a behaviour, the outermost first.
std::vector<const Behaviour*> around(const Subsystem& subsystem, const Behaviour& behaviour) {
  std::vector<const Behaviour*> all;
  for (std::string name = behaviour.group; !name.empty();) {
    const Behaviour& group = behaviour_named(subsystem, name);
    all.insert(all.begin(), &group);
    name = group.group;
  }
  return all;
}

Behaviour without_next(Behaviour behaviour) {
  behaviour.next.clear();
  return behaviour;
}

Condition named(const Condition& condition) {
  Condition made = condition;
  if (condition.form == Condition::Form::absent) made.asked.clear();
  if (condition.form == Condition::Form::single) made.named = {{own, condition.single}};
  made.form = Condition::Form::named;
  made.asked.resize(made.named.size());
  return made;
}

void add(Condition& condition, const std::string& name, const std::optional<Asked>& asked) {
  condition.named.insert(condition.named.begin(), {name, Truth::open});
  condition.asked.insert(condition.asked.begin(), asked);
}

bool names_error(const Behaviour& behaviour, const Entry& entry) {
  return entry.when == Entry::When::error ||
         (entry.when == Entry::When::name &&
          std::any_of(behaviour.error.named.begin(), behaviour.error.named.end(),
                      [&](const auto& one) { return one.first == entry.name; }));
}

/// Whether some entry always takes an error or a failure.
bool takes_all_errors(const Subsystem& subsystem, const std::vector<Entry>& next) {
  return std::any_of(next.begin(), next.end(), [&](const Entry& entry) {
    return entry.when == Entry::When::error && !may_be_blocked(subsystem, changes_of(subsystem, entry));
  });
}

/// A group has failures only if something in it can fail, and nothing in it takes that.
bool has_failures(const Behaviour& written_out) {
  return written_out.may_fail || written_out.error.form != Condition::Form::absent;
}

/// A failure takes the entry of its behaviour that names it, then `on_error` around it, else it leaves the group.
/// These two stand behind the last entry that names an error.
void add_failures(const Subsystem& subsystem, const Behaviour& behaviour, std::vector<Entry>& next) {
  std::size_t at = 0;
  for (std::size_t k = 0; k < next.size(); ++k)
    if (names_error(behaviour, next[k])) at = k + 1;
  const auto insert = [&](const std::string& to) {
    Entry made{to, Entry::When::error, "", Truth::open};
    made.leaves = to == "end";
    next.insert(next.begin() + static_cast<std::ptrdiff_t>(at++), made);
  };
  const std::string& on_error =
      behaviour.group.empty() ? subsystem.on_error : behaviour_named(subsystem, behaviour.group).on_error;
  if (!has_failures(behaviour)) return;
  if (!on_error.empty() && on_error != behaviour.name && !takes_all_errors(subsystem, next)) insert(on_error);
  if (!behaviour.group.empty() && !takes_all_errors(subsystem, next)) insert("end");
}

/// How the behaviours of a group leave it, with all questions free.
struct Exits {
  bool by_end = false, by_error = false, by_failure = false;
};

Exits exits_of(const Subsystem& subsystem, const Behaviour& group) {
  Exits exits;
  for (const Behaviour& one : subsystem.behaviours) {
    if (one.group != group.name) continue;
    const Behaviour all = written_out(subsystem, one);
    const Ways ways = ways_of(subsystem, all, false);
    Behaviour without_errors = all;
    without_errors.error = {};
    const Ways failing = ways_of(subsystem, without_errors, true);
    for (std::size_t k = 0; k < all.next.size(); ++k) {
      const std::string& name = all.next[k].name;
      const bool until_around = name.starts_with("until ") && !name.ends_with(" here");
      if (all.next[k].to != "end" || until_around) continue;
      // `end` for an error leaves as a failure does.
      if (names_error(all, all.next[k])) {
        exits.by_error = exits.by_error || ways.after_error.entries[k];
        exits.by_failure = exits.by_failure || failing.after_error.entries[k];
      } else
        exits.by_end = exits.by_end || ways.after_terminal.entries[k];
    }
  }
  return exits;
}

}  // namespace

Behaviour written_out(const Subsystem& subsystem, const Behaviour& behaviour) {
  Behaviour made = behaviour;
  for (Entry& entry : made.next)
    if (entry.when == Entry::When::until) {
      entry.when = Entry::When::name;
      entry.name = until_of(behaviour) + " here";
    }
  const std::vector<const Behaviour*> groups = around(subsystem, behaviour);
  if (!groups.empty() || behaviour.is_group) made.terminal = named(behaviour.terminal);
  if (behaviour.is_group) {
    const Exits exits = exits_of(subsystem, behaviour);
    if (exits.by_end) add(made.terminal, left, std::nullopt);
    if (behaviour.has_until) add(made.terminal, until_of(behaviour) + " here", std::nullopt);
    made.may_fail = exits.by_failure;
    if (exits.by_error) made.error = {Condition::Form::single, Truth::open, {}, {}};
  }
  for (std::size_t g = groups.size(); g-- > 0;) {
    if (!groups[g]->has_until) continue;
    add(made.terminal, until_of(*groups[g]), behaviour.is_group ? std::nullopt : groups[g]->until);
    made.next.insert(made.next.begin(), Entry{"end", Entry::When::name, until_of(*groups[g]), Truth::open});
  }
  // The default entry `end` is for an ending of its own.
  const bool has_until_around =
      std::any_of(groups.begin(), groups.end(), [](const Behaviour* one) { return one->has_until; });
  const bool never_given =
      behaviour.terminal.form == Condition::Form::absent ||
      (behaviour.terminal.form == Condition::Form::single && behaviour.terminal.single == Truth::no);
  const bool ends_alone = ways_of(subsystem, without_next(made), false).terminal &&
                          (!has_until_around || behaviour.is_group || !never_given);
  const bool led =
      has_failures(made) &&
      (!behaviour.group.empty() || (!subsystem.on_error.empty() && subsystem.on_error != behaviour.name));
  if (behaviour.next.empty() && (ends_alone || !led))
    made.next.push_back({"end", Entry::When::always, "", Truth::open});
  add_failures(subsystem, made, made.next);
  if (behaviour.group.empty()) made.next = next_of(subsystem, made);
  return made;
}

const Behaviour& behaviour_named(const Subsystem& subsystem, const std::string& name) {
  for (const Behaviour& one : subsystem.behaviours)
    if (one.name == name) return one;
  throw std::logic_error("no behaviour " + name);
}

std::string path_in(const Subsystem& subsystem, const Behaviour& behaviour) {
  std::string path;
  for (const Behaviour* group : around(subsystem, behaviour)) path += group->name + ".";
  return path + behaviour.name;
}

const Behaviour& first_in(const Subsystem& subsystem, const std::string& group) {
  const std::string& start = group.empty() ? subsystem.start : behaviour_named(subsystem, group).start;
  if (!start.empty()) return behaviour_named(subsystem, start);
  for (const Behaviour& one : subsystem.behaviours)
    if (one.group == group) return one;
  throw std::logic_error("nothing in " + group);
}

}  // namespace oracle
