// The effect of conditions (design, sections 4, 6 and 7): how a behaviour may end, and
// which entry of `next` follows.
#pragma once

#include <vector>

#include "flat_net.hpp"

namespace oracle {

/// The possible successors when a behaviour has ended in one way.
struct Following {
  std::vector<bool> entries;  // of `next`, which of them may be the first that holds
  bool none = false;          // it may be that none holds
};

/// The entries as they are drawn: `end` is the default. One more leads an error or a failure to the end that no
/// written entry could take: there is no `when: error`, and the entry without a condition does not end.
std::vector<Entry> next_of(const Behaviour& behaviour);

/// The ways that a behaviour may take at the end of an iteration, each decided alone.
struct Ways {
  bool go_on = false, terminal = false, error = false;  // t4, t5, t6
  Following after_terminal, after_error;
};

/// `exceptions`: its transition function may throw at any time.
Ways ways_of(const Behaviour& behaviour, bool exceptions);

/// The net that is judged: without what conditions never let happen, and with a transition where none holds.
FlatNet abstract_net(const FlatNet& flat, bool exceptions);

}  // namespace oracle
