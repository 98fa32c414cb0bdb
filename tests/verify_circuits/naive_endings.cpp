#include "verify_circuits/naive_endings.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <vector>

namespace tessera::test {
namespace {

using spec::Behaviour;
using spec::Condition;
using spec::Ending;
using spec::When;

/// One assignment of values to the expressions.
struct Trial {
  const Behaviour& behaviour;
  std::uint32_t values;  ///< one bit each: errors, terminals, entries of next

  [[nodiscard]] bool bit(std::size_t at) const { return (values >> at & 1U) != 0; }
  [[nodiscard]] bool value(const spec::Expression& expression, std::size_t at) const {
    if (expression.text == "true" || expression.text == "false") return expression.text == "true";
    return bit(at);
  }
  [[nodiscard]] bool error(std::size_t at) const { return value(behaviour.error.expressions[at], at); }
  [[nodiscard]] bool terminal(std::size_t at) const {
    return value(behaviour.terminal.expressions[at], behaviour.error.expressions.size() + at);
  }

  /// nullopt: it goes on.
  [[nodiscard]] std::optional<Ending> ending() const {
    if (behaviour.error.kind == Condition::Kind::always) return Ending::error;
    for (std::size_t at = 0; at < behaviour.error.expressions.size(); ++at)
      if (error(at)) return Ending::error;
    if (behaviour.terminal.kind == Condition::Kind::always) return Ending::terminal;
    for (std::size_t at = 0; at < behaviour.terminal.expressions.size(); ++at)
      if (terminal(at)) return Ending::terminal;
    return std::nullopt;
  }

  /// -1: no entry holds.
  [[nodiscard]] int entry(Ending ending) const {
    for (std::size_t at = 0; at < written(); ++at)
      if (holds(behaviour.next[at].when, ending, at)) return static_cast<int>(at);
    return ending == Ending::terminal ? -1 : end();
  }

  [[nodiscard]] std::size_t written() const {
    return static_cast<std::size_t>(std::ranges::count(behaviour.next, false, &spec::Next::implied));
  }

  /// An ending that nobody has routed ends the subsystem: by an unconditional `end`, or by the entry that is not written.
  [[nodiscard]] int end() const {
    for (std::size_t at = 0; at < written(); ++at) {
      if (behaviour.next[at].when.kind != When::Kind::always) continue;
      return static_cast<int>(behaviour.next[at].behaviour.valid() ? written() : at);
    }
    return static_cast<int>(written());
  }

  [[nodiscard]] bool holds(const When& when, Ending ending, std::size_t at) const {
    switch (when.kind) {
      case When::Kind::always:
        return ending == Ending::terminal;
      case When::Kind::never:
        return false;
      case When::Kind::error:
        return ending != Ending::terminal;
      case When::Kind::terminal:
        return ending == Ending::terminal && terminal(when.expression.value);
      case When::Kind::named_error:
        return ending == Ending::error && error(when.expression.value);
      case When::Kind::expression:
        return ending == Ending::terminal &&
               bit(behaviour.error.expressions.size() + behaviour.terminal.expressions.size() + at);
    }
    return false;
  }
};

class Drawing {
 public:
  explicit Drawing(std::uint64_t seed) : random_(seed) {}

  void draw(Behaviour& behaviour, std::uint32_t others) {
    behaviour.error = between(0, 2) == 0 ? condition("e") : Condition{};
    behaviour.terminal = condition("t");
    behaviour.next.clear();
    for (std::uint32_t left = between(1, 4); left > 0; --left)
      behaviour.next.push_back(
          {between(0, 9) == 0 ? spec::BehaviourId{} : spec::BehaviourId{between(0, others - 1)},
           when(behaviour),
           {}});
    behaviour.next_given = true;
    spec::complete_next(behaviour);
  }
  bool one_in(std::uint32_t count) { return between(1, count) == 1; }

 private:
  std::uint32_t between(std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random_);
  }

  Condition condition(const char* prefix) {
    Condition made;
    const std::uint32_t kind = between(0, 5);
    made.kind = kind == 0   ? Condition::Kind::always
                : kind == 1 ? Condition::Kind::never
                            : Condition::Kind::expressions;
    if (kind < 2) return made;
    constexpr std::array texts{"memory.a", "memory.b", "memory.a", "memory.b", "true", "false"};
    for (std::uint32_t left = between(1, 3); left > 0; --left)
      made.expressions.push_back(
          {prefix + std::to_string(made.expressions.size()), texts.at(between(0, texts.size() - 1)), {}});
    return made;
  }

  When when(const Behaviour& behaviour) {
    When made;
    made.kind = static_cast<When::Kind>(between(0, 5));
    if (made.kind == When::Kind::expression) made.text.text = "memory.c";
    const bool terminal = made.kind == When::Kind::terminal;
    if (!terminal && made.kind != When::Kind::named_error) return made;
    const auto& named = (terminal ? behaviour.terminal : behaviour.error).expressions;
    if (named.empty())
      made.kind = When::Kind::error;
    else
      made.expression = {between(0, static_cast<std::uint32_t>(named.size()) - 1)};
    return made;
  }

  std::mt19937_64 random_;
};

std::vector<Ending> allowed(bool failures) {
  std::vector<Ending> all{Ending::terminal, Ending::error};
  if (failures) all.push_back(Ending::failure);
  return all;
}

bool taken(const NaiveEndings& endings, int entry, bool failures) {
  for (const Ending ending : allowed(failures))
    if (endings.ends(ending) && endings.after(ending).contains(entry)) return true;
  return false;
}

bool possible(const net::Condition& condition, const NaiveEndings& endings, bool failures) {
  switch (condition.kind) {
    case net::Condition::Kind::go_on:
      return endings.goes_on;
    case net::Condition::Kind::terminal:
      return endings.ends(Ending::terminal);
    case net::Condition::Kind::error:
      return failures || endings.ends(Ending::error);
    case net::Condition::Kind::next:
      return taken(endings, static_cast<int>(condition.entry.value()), failures);
    default:
      return true;
  }
}

}  // namespace

NaiveEndings try_endings(const Behaviour& behaviour) {
  NaiveEndings found;
  const std::size_t bits =
      behaviour.error.expressions.size() + behaviour.terminal.expressions.size() + behaviour.next.size();
  const auto note = [&](Ending ending, const Trial& trial) {
    found.possible[static_cast<std::size_t>(ending)] = true;
    found.taken[static_cast<std::size_t>(ending)].insert(trial.entry(ending));
  };
  for (std::uint32_t values = 0; values < (1U << bits); ++values) {
    const Trial trial{behaviour, values};
    note(Ending::failure, trial);
    if (const auto ending = trial.ending())
      note(*ending, trial);
    else
      found.goes_on = true;
  }
  return found;
}

const Behaviour* behaviour_of(const spec::Model& model, const net::Transition& transition) {
  using Kind = net::Condition::Kind;
  const Kind kind = transition.condition.kind;
  if (kind != Kind::go_on && kind != Kind::terminal && kind != Kind::error && kind != Kind::next)
    return nullptr;
  const std::string local = transition.name.substr(model.instance_path(transition.subsystem).size() + 1);
  const std::string name =
      kind == Kind::next ? local.substr(2, local.rfind('_') - 2) : local.substr(0, local.find('.'));
  for (const Behaviour& behaviour : model.subsystem(transition.subsystem).behaviours)
    if (behaviour.name == name) return &behaviour;
  return nullptr;
}

net::Net naively_abstract(const spec::Model& model, const net::Net& flat, bool failures) {
  net::Net made;
  for (const net::Place& place : flat.places()) made.add(place);
  std::map<net::PlaceId, net::Transition> left_by;  // by one of several entries of next
  std::map<const Behaviour*, NaiveEndings> tried;
  std::map<net::PlaceId, bool> none;
  for (std::uint32_t index = 0; index < flat.transitions().size(); ++index) {
    const net::TransitionId id{index};
    net::Transition transition = flat[id];
    if (const Behaviour* behaviour = behaviour_of(model, transition)) {
      const auto [entry, is_new] = tried.try_emplace(behaviour);
      if (is_new) entry->second = try_endings(*behaviour);
      transition.condition.truth = possible(transition.condition, entry->second, failures)
                                       ? net::Condition::Truth::free
                                       : net::Condition::Truth::never;
      if (transition.condition.kind == net::Condition::Kind::next) {
        left_by.emplace(flat.preset(id).front().place, transition);
        none[flat.preset(id).front().place] = taken(entry->second, -1, failures);
      }
    }
    made.add(std::move(transition), flat.preset(id), flat.postset(id));
  }
  for (const auto& [place, is_possible] : none) {
    if (!is_possible) continue;
    net::Place lost = flat[place];
    lost.name += ".none";
    lost.operation = {};
    const net::PlaceId to = made.add(std::move(lost));
    net::Transition transition = left_by.at(place);
    transition.name += " none";
    transition.condition.truth = net::Condition::Truth::free;
    made.add(std::move(transition), std::vector<net::Arc>{{place, 1}}, std::vector<net::Arc>{{to, 1}});
  }
  return made;
}

void draw_endings(Behaviour& behaviour, std::uint32_t others, std::uint64_t seed) {
  Drawing(seed).draw(behaviour, others);
}

void draw_endings(spec::Model& model, std::uint64_t seed) {
  Drawing drawing(seed);
  for (spec::Definition& definition : model.definitions)
    for (spec::Subsystem& subsystem : definition.subsystems)
      for (Behaviour& behaviour : subsystem.behaviours)
        if (drawing.one_in(2))
          drawing.draw(behaviour, static_cast<std::uint32_t>(subsystem.behaviours.size()));
}

}  // namespace tessera::test
