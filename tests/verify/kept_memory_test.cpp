// Memory with few values: random subsystems, by a naive reading of the rule and by their nets.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "net/token_game.hpp"
#include "proved.hpp"
#include "verify/communication/abstraction.hpp"

namespace tessera::kept_memory {
namespace {

using Values = std::vector<int>;  // per cell, positions
using Choices = std::vector<bool>;

struct Cell {
  std::string name;
  std::vector<std::string> values;
  bool counts = false;
  std::optional<std::size_t> initial{};  // position
};

/// A condition: a comparison of a cell, something that the net does not know, or a combination.
struct Formula {
  enum class Kind : std::uint8_t { compare, unknown, negation, both, either } kind = Kind::unknown;
  std::size_t cell = 0;
  std::string mark;
  int position = 0;
  bool flipped = false;
  std::size_t number = 0;  // of an unknown, in its list of conditions
  std::vector<Formula> parts;

  [[nodiscard]] bool holds(const Values& values, const Choices& choices) const {
    const auto compared = [&](int a, int b) {
      if (mark == "==") return a == b;
      if (mark == "!=") return a != b;
      if (mark == "<") return a < b;
      if (mark == "<=") return a <= b;
      return mark == ">" ? a > b : a >= b;
    };
    switch (kind) {
      case Kind::compare:
        return flipped ? compared(position, values[cell]) : compared(values[cell], position);
      case Kind::unknown:
        return choices[number];
      case Kind::negation:
        return !parts[0].holds(values, choices);
      case Kind::both:
        return parts[0].holds(values, choices) && parts[1].holds(values, choices);
      case Kind::either:
        return parts[0].holds(values, choices) || parts[1].holds(values, choices);
    }
    return false;
  }

  [[nodiscard]] std::string text(const std::vector<Cell>& cells) const {
    switch (kind) {
      case Kind::compare: {
        const std::string memory = "memory." + cells[cell].name, &value = cells[cell].values[position];
        return flipped ? value + " " + mark + " " + memory : memory + " " + mark + " " + value;
      }
      case Kind::unknown:
        return "elapsed > " + std::to_string(number + 1) + " s";
      case Kind::negation:
        return "!(" + parts[0].text(cells) + ")";
      case Kind::both:
        return "(" + parts[0].text(cells) + ") && (" + parts[1].text(cells) + ")";
      case Kind::either:
        return "(" + parts[0].text(cells) + ") || (" + parts[1].text(cells) + ")";
    }
    return {};
  }
};

struct Change {
  std::size_t cell = 0;
  int step = 0, position = 0;
};
using Changes = std::vector<Change>;

struct Entry {
  std::optional<std::size_t> to;  // none: end
  enum class When : std::uint8_t { always, error, formula } when = When::always;
  Formula formula;
  Changes sets;
};

struct Behaviour {
  std::optional<Formula> error;
  Formula terminal;
  std::size_t unknowns_of_ending = 0, unknowns_of_next = 0;
  std::vector<Entry> next;
  Changes sets;
};

struct Subsystem {
  std::vector<Cell> cells;
  std::vector<Behaviour> behaviours;

  [[nodiscard]] static std::string name(std::size_t behaviour) {
    return std::string(1, static_cast<char>('a' + behaviour)) + "_is";
  }

  [[nodiscard]] std::string text(const Changes& sets) const {
    std::string all;
    for (const Change& change : sets)
      all += (all.empty() ? "" : ", ") + cells[change.cell].name + ": " +
             (change.step > 0   ? "+1"
              : change.step < 0 ? "-1"
                                : cells[change.cell].values[change.position]);
    return all.empty() ? all : ", sets: { " + all + " }";
  }

  [[nodiscard]] std::string text() const {
    std::string all =
        "tessera: 1\nsystem: drawn\nagents:\n  robot:\n    control:\n      rate: 10 Hz\n      memory:\n";
    for (const Cell& cell : cells) {
      all += "        " + cell.name + ": ";
      const std::string end = (cell.initial ? ", initial: " + cell.values[*cell.initial] : "") + " }\n";
      if (cell.counts) {
        all += "{ counts: " + cell.values.front() + ".." + cell.values.back() + end;
        continue;
      }
      std::string values;
      for (const std::string& value : cell.values) values += (values.empty() ? "" : ", ") + value;
      all += "{ values: [" + values + "]" + end;
    }
    all += "      behaviours:\n";
    for (std::size_t number = 0; number < behaviours.size(); ++number) {
      const Behaviour& behaviour = behaviours[number];
      all +=
          "        " + name(number) + ":\n          terminal: \"" + behaviour.terminal.text(cells) + "\"\n";
      if (behaviour.error) all += "          error: \"" + behaviour.error->text(cells) + "\"\n";
      if (!behaviour.sets.empty()) all += "          " + text(behaviour.sets).substr(2) + "\n";
      all += "          next:\n";
      for (const Entry& entry : behaviour.next) {
        all += "            - { to: " + (entry.to ? name(*entry.to) : "end");
        if (entry.when == Entry::When::error) all += ", when: error";
        if (entry.when == Entry::When::formula) all += ", when: \"" + entry.formula.text(cells) + "\"";
        all += text(entry.sets) + " }\n";
      }
    }
    return all;
  }
};

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  Subsystem subsystem() {
    Subsystem made;
    for (std::size_t number = 0, count = 1 + below(3); number < count; ++number) {
      Cell cell{"cell_" + std::to_string(number), {}, chance(2)};
      const std::size_t least = below(2);
      for (std::size_t value = 0, values = 2 + below(3); value < values; ++value)
        cell.values.push_back(cell.counts ? std::to_string(least + value)
                                          : std::string(1, static_cast<char>('p' + value)));
      if (chance(2)) cell.initial = below(cell.values.size());
      made.cells.push_back(std::move(cell));
    }
    const std::size_t count = 1 + below(4);
    for (std::size_t number = 0; number < count; ++number) {
      Behaviour behaviour;
      unknowns_ = 0;
      behaviour.terminal = formula(made.cells, 2);
      if (chance(4)) behaviour.error = formula(made.cells, 1);
      behaviour.unknowns_of_ending = std::exchange(unknowns_, 0);
      for (std::size_t entry = 0, entries = 1 + below(4); entry < entries; ++entry) {
        Entry one;
        if (!chance(8)) one.to = below(count);
        const bool last = entry + 1 == entries;
        one.when = chance(6) ? Entry::When::error
                   : last    ? (chance(4) ? Entry::When::formula : Entry::When::always)
                             : Entry::When::formula;
        if (one.when == Entry::When::formula) one.formula = formula(made.cells, 2);
        if (chance(2)) one.sets = changes(made.cells);
        behaviour.next.push_back(std::move(one));
      }
      behaviour.unknowns_of_next = std::exchange(unknowns_, 0);
      if (chance(3)) behaviour.sets = changes(made.cells);
      made.behaviours.push_back(std::move(behaviour));
    }
    return made;
  }

 private:
  std::size_t below(std::size_t count) { return engine_() % count; }
  bool chance(std::size_t one_in) { return below(one_in) == 0; }

  Formula formula(const std::vector<Cell>& cells, int depth) {
    Formula made;
    const std::size_t kind = below(depth > 0 ? 7 : 4);
    if (kind < 3) {
      made.kind = Formula::Kind::compare;
      made.cell = below(cells.size());
      made.position = static_cast<int>(below(cells[made.cell].values.size()));
      made.flipped = chance(3);
      const std::vector<std::string> marks{"==", "!=", "<", "<=", ">", ">="};
      made.mark = marks[below(cells[made.cell].counts ? marks.size() : 2)];
      // A comparison that no count fits is refused (E264).
      const int last = static_cast<int>(cells[made.cell].values.size()) - 1;
      const std::string before_first = made.flipped ? ">" : "<", behind_last = made.flipped ? "<" : ">";
      if (made.position == 0 && made.mark == before_first) made.mark += "=";
      if (made.position == last && made.mark == behind_last) made.mark += "=";
    } else if (kind == 3) {
      made.number = unknowns_++;
    } else {
      made.kind = kind == 4   ? Formula::Kind::negation
                  : kind == 5 ? Formula::Kind::both
                              : Formula::Kind::either;
      for (int part = 0; part < (kind == 4 ? 1 : 2); ++part) made.parts.push_back(formula(cells, depth - 1));
    }
    return made;
  }

  Changes changes(const std::vector<Cell>& cells) {
    Changes made;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      if (!chance(2)) continue;
      Change change{cell, 0, static_cast<int>(below(cells[cell].values.size()))};
      if (cells[cell].counts && !chance(3)) change.step = chance(2) ? 1 : -1;
      made.push_back(change);
    }
    return made;
  }

  std::mt19937_64 engine_;
  std::size_t unknowns_ = 0;
};

/// Pairs of neighbours in time: "a_is p 0" -> "b_is q 1", "end", "none".
using Steps = std::set<std::pair<std::string, std::string>>;

/// The rule, as docs/reference/specification.md states it, tried with everything that is not known.
class Naive {
 public:
  /// forgets: `next` does not know whether an error or a terminal condition has ended the behaviour.
  Naive(const Subsystem& subsystem, bool forgets) : subsystem_(subsystem), forgets_(forgets) {}

  Steps steps() {
    Values first;
    for (const Cell& cell : subsystem_.cells) first.push_back(static_cast<int>(cell.initial.value_or(0)));
    if (!apply(subsystem_.behaviours[0].sets, first)) throw std::logic_error("it cannot start");
    visit(0, first);
    return std::move(steps_);
  }

 private:
  bool apply(const Changes& changes, Values& values) const {
    for (const Change& change : changes) {
      int& value = values[change.cell];
      value = change.step == 0 ? change.position : value + change.step;
      if (value < 0 || value >= static_cast<int>(subsystem_.cells[change.cell].values.size())) return false;
    }
    return true;
  }

  [[nodiscard]] std::string state(std::size_t behaviour, const Values& values) const {
    std::string text = Subsystem::name(behaviour);
    for (std::size_t cell = 0; cell < values.size(); ++cell)
      text += " " + subsystem_.cells[cell].values[static_cast<std::size_t>(values[cell])];
    return text;
  }

  template <class Try>
  static void for_all(std::size_t count, Try attempt) {
    for (std::size_t bits = 0; bits < (std::size_t{1} << count); ++bits) {
      Choices choices(count);
      for (std::size_t bit = 0; bit < count; ++bit) choices[bit] = (bits >> bit & 1U) != 0;
      attempt(choices);
    }
  }

  void visit(std::size_t number, const Values& values) {
    if (!seen_.insert(state(number, values)).second) return;
    const Behaviour& behaviour = subsystem_.behaviours[number];
    for_all(behaviour.unknowns_of_ending, [&](const Choices& choices) {
      const bool error = behaviour.error && behaviour.error->holds(values, choices);
      const bool terminal = behaviour.terminal.holds(values, choices);
      if (!error && !terminal) {
        steps_.emplace(state(number, values), state(number, values));
        return;
      }
      if (error || (forgets_ && behaviour.error)) leave(number, values, true);
      if (!error || forgets_) leave(number, values, false);
    });
  }

  void leave(std::size_t number, const Values& values, bool by_error) {
    const Behaviour& behaviour = subsystem_.behaviours[number];
    for_all(behaviour.unknowns_of_next, [&](const Choices& choices) {
      for (const Entry& entry : behaviour.next) {
        if ((entry.when == Entry::When::error) != by_error) continue;
        if (entry.when == Entry::When::formula && !entry.formula.holds(values, choices)) continue;
        Values after = values;
        if (!apply(entry.sets, after)) continue;
        if (entry.to && !apply(subsystem_.behaviours[*entry.to].sets, after)) continue;
        steps_.emplace(state(number, values), entry.to ? state(*entry.to, after) : "end");
        if (entry.to) visit(*entry.to, after);
        return;
      }
      steps_.emplace(state(number, values), by_error ? "end" : "none");
    });
  }

  const Subsystem& subsystem_;
  bool forgets_;
  std::set<std::string> seen_;
  Steps steps_;
};

/// The same, read off the markings of the net.
class OfNet {
 public:
  OfNet(const net::Net& net, const Subsystem& subsystem) : net_(net), subsystem_(subsystem) {}

  Steps steps() {
    visit(net::initial_marking(net_), "");
    return std::move(steps_);
  }

 private:
  [[nodiscard]] std::string state(const net::Marking& marking) const {
    std::string at;
    std::map<std::string, std::string> values;
    for (std::uint32_t place = 0; place < marking.size(); ++place) {
      const net::Place& one = net_.places()[place];
      if (marking[place] == 0) continue;
      if (one.fact.valid()) values[net_.parts()[one.fact].name] = net_.parts()[one.fact].values[one.value];
      if (one.role == PlaceRole::no_successor) return "none";
      if (one.is(net::Layer::subsystem, PlaceRole::output)) return "end";
      if (one.is(net::Layer::behaviour, PlaceRole::input)) at = Subsystem::name(one.behaviour.value);
    }
    if (at.empty()) return at;
    for (const Cell& cell : subsystem_.cells) at += " " + values.at("memory." + cell.name);
    return at;
  }

  void visit(const net::Marking& marking, const std::string& from) {
    if (!seen_.emplace(marking, from).second) return;
    std::string here = state(marking);
    if (!here.empty() && !from.empty()) steps_.emplace(from, here);
    if (here == "end" || here == "none") return;
    if (!here.empty() && !from.empty()) return visit(marking, "");
    if (here.empty()) here = from;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index) {
      if (!verify::possible(net_, {index}) || !net::enabled(net_, {index}, marking)) continue;
      net::Marking next = marking;
      net::fire(net_, {index}, next);
      visit(next, here);
    }
  }

  const net::Net& net_;
  const Subsystem& subsystem_;
  std::set<std::pair<net::Marking, std::string>> seen_;
  Steps steps_;
};

TEST(KeptMemory, FollowsTheRuleInRandomSubsystems) {
  int compared = 0, exact = 0, changing = 0, ending = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Subsystem subsystem = Random(seed).subsystem();
    std::optional<net::Net> net;
    try {
      net = verify::flattened(subsystem.text());
    } catch (const std::runtime_error& refused) {  // changes that are refused
      ASSERT_TRUE(std::string(refused.what()).find(" error E26") != std::string::npos) << refused.what();
      continue;
    }
    const Steps expected = Naive(subsystem, false).steps(), most = Naive(subsystem, true).steps();
    const Steps found = OfNet(verify::abstract_net(*net), subsystem).steps();
    const bool has_errors =
        std::ranges::any_of(subsystem.behaviours, [](const Behaviour& one) { return one.error.has_value(); });
    // The net does not know how a behaviour has ended.
    if (!has_errors) {
      ASSERT_EQ(found, expected) << seed << '\n' << subsystem.text();
    }
    ASSERT_TRUE(std::ranges::includes(found, expected)) << seed << '\n' << subsystem.text();
    ASSERT_TRUE(std::ranges::includes(most, found)) << seed << '\n' << subsystem.text();
    exact += has_errors ? 0 : 1;
    ++compared;
    for (const auto& [from, to] : expected) {
      changing += from.substr(from.find(' ') + 1) != to.substr(to.find(' ') + 1) ? 1 : 0;
      ending += to == "end" || to == "none" ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 150);
  EXPECT_GT(exact, 50);
  EXPECT_GT(changing, 50);
  EXPECT_GT(ending, 50);
}

}  // namespace
}  // namespace tessera::kept_memory
