#include <algorithm>

#include "oracle/judge/groups.hpp"
#include "oracle/judge/memory.hpp"
#include "random_specification.hpp"

namespace oracle {
namespace {

Cell random_cell(RandomNumbers& random, const std::string& name) {
  Cell made;
  made.name = name;
  const int count = 2 + (random.percent(35) ? 1 : 0);
  if (random.percent(55)) made.least = random.below(2) * 3;
  for (int value = 0; value < count; ++value)
    made.values.push_back(made.least < 0 ? "v" + std::to_string(value) : std::to_string(made.least + value));
  if (random.percent(30)) made.initial = random.below(count);
  return made;
}

std::vector<Change> random_changes(RandomNumbers& random, const Subsystem& subsystem, int chance) {
  std::vector<Change> all;
  for (std::size_t c = 0; c < subsystem.memory.size(); ++c) {
    if (!random.percent(chance)) continue;
    const Cell& cell = subsystem.memory[c];
    Change change{static_cast<int>(c), 0, random.below(static_cast<int>(cell.values.size()))};
    if (cell.least >= 0 && random.percent(70)) change.step = random.percent(60) ? 1 : -1;
    all.push_back(change);
  }
  return all;
}

int count_of(const Subsystem& subsystem, int cell) {
  return static_cast<int>(subsystem.memory[static_cast<std::size_t>(cell)].values.size());
}

bool allows(const Subsystem& subsystem, const std::vector<Change>& changes, int cell, int value) {
  for (const Change& change : changes) {
    if (change.cell != cell) continue;
    value = change.step == 0 ? change.value : value + change.step;
    if (value < 0 || value >= count_of(subsystem, cell)) return false;
  }
  return true;
}

/// Leaves out changes that no count allows (E267), and those of the first behaviour that the start forbids (E268).
void keep_in_range(Subsystem& subsystem) {
  for (Behaviour& behaviour : subsystem.behaviours)  // several may begin together
    if (behaviour.is_group || !behaviour.group.empty())
      std::erase_if(behaviour.sets, [](const Change& one) { return one.step != 0; });
  const std::string& first = first_in(subsystem, "").name;
  for (Behaviour& behaviour : subsystem.behaviours)
    if (behaviour.name == first)
      std::erase_if(behaviour.sets, [&](const Change& one) {
        const int initial = subsystem.memory[static_cast<std::size_t>(one.cell)].initial;
        return one.step != 0 && !allows(subsystem, {one}, one.cell, initial);
      });
  for (Behaviour& behaviour : subsystem.behaviours)
    for (Entry& entry : behaviour.next) {
      const std::vector<Change> changes = changes_of(subsystem, entry);
      std::erase_if(entry.sets, [&](const Change& one) {
        for (int before = 0; before < count_of(subsystem, one.cell); ++before)
          if (allows(subsystem, changes, one.cell, before)) return false;
        return true;
      });
    }
}

/// "PREFIXmemory.c0 == v1", where it is neither always true nor never.
Asked comparison(RandomNumbers& random, const Cell& cell, const std::string& prefix, bool mirrored) {
  static const std::vector<std::string> marks{"==", "!=", "<", "<=", ">", ">="};
  static const std::vector<std::string> mirrors{"==", "!=", ">", ">=", "<", "<="};
  Asked made{Asked::Kind::memory, "memory." + cell.name, {}, "", {}};
  const int count = static_cast<int>(cell.values.size());
  while (true) {
    const auto mark = static_cast<std::size_t>(random.below(cell.least < 0 ? 2 : 6));
    const int other = random.below(count);
    made.holds.clear();
    for (int value = 0; value < count; ++value) made.holds.push_back(compares(marks[mark], value, other));
    if (std::count(made.holds.begin(), made.holds.end(), true) % count == 0) continue;
    const std::string& constant = cell.values[static_cast<std::size_t>(other)];
    made.text = mirrored ? constant + " " + mirrors[mark] + " " + prefix + made.buffer
                         : prefix + made.buffer + " " + marks[mark] + " " + constant;
    return made;
  }
}

class MemoryFormulas {
 public:
  MemoryFormulas(RandomNumbers& random, const Specification& specification)
      : random_(random), net_(flat_net(specification)) {
    for (const FlatNet::FactInfo& fact : net_.facts)
      if (fact.cell >= 0) cells_.push_back(&fact);
  }

  bool none() const { return cells_.empty(); }

  Formula formula() {
    const FlatNet::FactInfo& fact = *random_.of(cells_);
    const FlatNet::SubsystemInfo& owner = net_.subsystems[static_cast<std::size_t>(fact.subsystem)];
    Formula value;
    const Cell& cell = owner.of->memory[static_cast<std::size_t>(fact.cell)];
    value.path = comparison(random_, cell, owner.path + ".", false).text;
    if (random_.percent(35)) return value;
    Formula runs, both;
    runs.path = net_.behaviours[static_cast<std::size_t>(random_.of(owner.behaviours))].path;
    both.kind = random_.percent(65) ? Formula::Kind::all_of : Formula::Kind::any_of;
    both.parts = {runs, value};
    return both;
  }

 private:
  RandomNumbers& random_;
  FlatNet net_;
  std::vector<const FlatNet::FactInfo*> cells_;
};

}  // namespace

void add_memory(RandomNumbers& random, Subsystem& subsystem) {
  const int cells = random.percent(75) ? 1 : 2;
  for (int c = 0; c < cells; ++c) subsystem.memory.push_back(random_cell(random, "c" + std::to_string(c)));
  for (Behaviour& behaviour : subsystem.behaviours)
    if (behaviour.each.empty()) behaviour.sets = random_changes(random, subsystem, 30);
  for (Behaviour& behaviour : subsystem.behaviours)
    for (Entry& entry : behaviour.next)  // what is written once for all members is the same
      if (behaviour.each.empty() && !entry.to.ends_with("]"))
        entry.sets = random_changes(random, subsystem, 40);
  keep_in_range(subsystem);
}

void add_goal(RandomNumbers& random, Subsystem& subsystem) {
  const auto alone = [](std::vector<std::string> buffers) {
    std::erase_if(buffers, [](const std::string& one) { return one.ends_with("]"); });
    return buffers;
  };
  const std::vector<std::string> inputs = alone(subsystem.inputs), outputs = alone(subsystem.outputs);
  if (inputs.empty() || outputs.empty()) return;
  Cell cell;
  cell.name = "goal";
  cell.values = goal_states();
  cell.goal = random.of(outputs);
  cell.progress = random.of(inputs);
  const Change order{static_cast<int>(subsystem.memory.size()), 0, static_cast<int>(cell.values.size()) - 1};
  const auto has = [](const std::optional<std::vector<std::string>>& list, const std::string& buffer) {
    return !list || std::find(list->begin(), list->end(), buffer) != list->end();
  };
  for (Behaviour& behaviour : subsystem.behaviours) {
    if (behaviour.is_group || !behaviour.each.empty() || !random.percent(60)) continue;
    if (!has(behaviour.send, cell.goal) || !has(behaviour.receive, cell.progress)) continue;
    behaviour.sets.push_back(order);
    behaviour.cancels = random.percent(50);
  }
  subsystem.memory.push_back(cell);
}

Asked random_question(RandomNumbers& random, const Cell& cell) {
  if (cell.least != 0 || !random.percent(10)) return comparison(random, cell, "", random.percent(25));
  Asked made{Asked::Kind::memory, "memory." + cell.name, {}, "memory." + cell.name, {}};  // it is not zero
  for (std::size_t value = 0; value < cell.values.size(); ++value) made.holds.push_back(value != 0);
  return made;
}

std::vector<Property> properties_of_memory(RandomNumbers& random, const Specification& specification) {
  MemoryFormulas formulas(random, specification);
  std::vector<Property> properties;
  const int number = formulas.none() ? 0 : 1 + random.below(3);
  for (int p = 0; p < number; ++p) {
    Property property;
    property.kind = static_cast<Property::Kind>(random.below(5));
    property.name = "m" + std::to_string(p);
    property.first = formulas.formula();
    property.second = formulas.formula();
    property.arrow = random.percent(50);
    properties.push_back(property);
  }
  return properties;
}

}  // namespace oracle
