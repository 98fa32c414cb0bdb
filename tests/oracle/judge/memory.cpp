#include "memory.hpp"

#include "groups.hpp"

namespace oracle {

std::vector<std::map<int, int>> with_all_values(const FlatNet& net, int fact,
                                                const std::vector<std::map<int, int>>& all) {
  std::vector<std::map<int, int>> more;
  for (const std::map<int, int>& one : all)
    for (std::size_t value = 0; value < net.facts[static_cast<std::size_t>(fact)].values.size(); ++value) {
      more.push_back(one);
      more.back()[fact] = static_cast<int>(value);
    }
  return more;
}

bool may_be_blocked(const Subsystem& subsystem, const std::vector<Change>& changes) {
  for (const Change& of : changes) {
    const Cell& cell = subsystem.memory[static_cast<std::size_t>(of.cell)];
    for (int before = 0; before < static_cast<int>(cell.values.size()); ++before) {
      int now = before;
      for (const Change& change : changes) {
        if (change.cell != of.cell) continue;
        now = change.step == 0 ? change.value : now + change.step;
        if (now < 0 || now >= static_cast<int>(cell.values.size())) return true;
      }
    }
  }
  return false;
}

std::vector<Change> changes_of(const Subsystem& subsystem, const Entry& entry) {
  std::vector<Change> all = entry.sets;
  if (entry.to == "end") return all;
  for (const Behaviour* to = &behaviour_named(subsystem, entry.to);; to = &first_in(subsystem, to->name)) {
    all.insert(all.end(), to->sets.begin(), to->sets.end());
    if (!to->is_group) return all;
  }
}

int fact_of_cell(const FlatNet& net, int subsystem, int cell) {
  for (std::size_t f = 0; f < net.facts.size(); ++f)
    if (net.facts[f].subsystem == subsystem && net.facts[f].cell == cell) return static_cast<int>(f);
  return -1;
}

std::vector<std::map<int, int>> with_changed(const FlatNet& net, int subsystem,
                                             const std::vector<Change>& changes,
                                             const std::map<int, int>& values) {
  std::vector<std::map<int, int>> all{values};
  for (const Change& change : changes)
    if (const int fact = fact_of_cell(net, subsystem, change.cell); !all.front().contains(fact))
      all = with_all_values(net, fact, all);
  return all;
}

std::optional<std::map<int, int>> changed(const FlatNet& net, int subsystem,
                                          const std::vector<Change>& changes, std::map<int, int> values) {
  for (const Change& change : changes) {
    const int fact = fact_of_cell(net, subsystem, change.cell);
    const auto found = values.find(fact);
    if (found == values.end()) continue;
    found->second = change.step == 0 ? change.value : found->second + change.step;
    const int count = static_cast<int>(net.facts[static_cast<std::size_t>(fact)].values.size());
    if (found->second < 0 || found->second >= count) return std::nullopt;
  }
  return values;
}

}  // namespace oracle
