// The changes of memory cells with few values.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "flat_net.hpp"

namespace oracle {

/// The changes of memory when an entry is taken: its own, then those of the behaviour that it leads to. If that is a
/// group, its own come before those of the behaviour with which it begins.
std::vector<Change> changes_of(const Subsystem& subsystem, const Entry& entry);
int fact_of_cell(const FlatNet& net, int subsystem, int cell);
/// All values of the cells that are changed, together with these.
std::vector<std::map<int, int>> with_changed(const FlatNet& net, int subsystem,
                                             const std::vector<Change>& changes,
                                             const std::map<int, int>& values);
/// The values after changes of cells among them; nothing: a counter would leave its range.
std::optional<std::map<int, int>> changed(const FlatNet& net, int subsystem,
                                          const std::vector<Change>& changes, std::map<int, int> values);

/// These values with every value of one more fact.
std::vector<std::map<int, int>> with_all_values(const FlatNet& net, int fact,
                                                const std::vector<std::map<int, int>>& all);
/// Whether some value of a cell does not allow the changes of an entry.
bool may_be_blocked(const Subsystem& subsystem, const std::vector<Change>& changes);

}  // namespace oracle
