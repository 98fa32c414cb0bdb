// The effect of conditions (design, sections 4, 6 and 7): how a behaviour may end, and
// which entry of `next` follows.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "flat_net.hpp"

namespace oracle {

/// The possible successors when a behaviour has ended in one way.
struct Following {
  std::vector<bool> entries;  // of `next`, which of them may be the first that holds
  bool none = false;          // it may be that none holds
};

/// The entries as they are drawn: `end` is the default. One more leads an error or a failure to the end that no
/// written entry could take: there is no `when: error` that is always possible, and the entry without a condition does
/// not end, or changes memory. A group in which all failures are taken needs none.
std::vector<Entry> next_of(const Subsystem& subsystem, const Behaviour& behaviour);

/// The ways that a behaviour may take at the end of an iteration, each decided alone.
struct Ways {
  bool go_on = false, terminal = false, error = false;  // t4, t5, t6
  Following after_terminal, after_error;
};

/// The ways of a behaviour of the net if facts have these values; a fact without a value is not known.
/// `exceptions`: any transition function may throw at any time. Then a value that came may be invalid, which is not
/// fresh.
Ways ways_of(const FlatNet& net, int behaviour, bool exceptions, const std::map<int, int>& values);

/// The same of a behaviour that is written out, with nothing known.
Ways ways_of(const Subsystem& subsystem, const Behaviour& written_out, bool exceptions);

/// Whether some iteration of the behaviour can end it, whatever the facts are.
bool can_end(const FlatNet& net, int behaviour, bool exceptions);

/// All formulas that the conditions of a behaviour ask.
std::vector<const Asked*> expressions_of(const Behaviour& behaviour);
/// All values of the facts that the list `next` of a behaviour asks for, or the conditions that end its iterations.
/// One without values: it asks for none.
std::vector<std::map<int, int>> values_of_next(const FlatNet& net, int behaviour);
std::vector<std::map<int, int>> values_of_ending(const FlatNet& net, int behaviour);
/// The same of what decides whether an output is skipped.
std::vector<std::map<int, int>> values_of_skip(const FlatNet& net, int behaviour, const Skip& skip);
/// Whether an iteration sends it if facts have these values.
Truth sends(const FlatNet& net, int behaviour, const Skip& skip, bool exceptions,
            const std::map<int, int>& values);
/// ".i0.came.o1.in_time": how names end.
std::string suffix(const FlatNet& net, const std::map<int, int>& values);

/// The net that is judged: without what conditions never let happen, and with a transition where none holds.
FlatNet abstract_net(const FlatNet& flat, bool exceptions);

}  // namespace oracle
