#include "explore/units.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

namespace tessera::explore {
namespace {

/// Whether a firing may remove a token from a unit.
enum class Losses : std::uint8_t { forbidden, allowed };

/// Looks for a set of places whose number of tokens no firing increases: every transition that gives to
/// the set takes from it, one token each (and vice versa, unless losses are allowed). Places are decided
/// one by one, consequences follow, and wrong guesses are undone (the trail). A set is kept if it has
/// at most one initial token.
class UnitSearch {
 public:
  UnitSearch(const PtNet& net, const std::vector<char>& covered)
      : net_(net), covered_(covered), state_(net.places(), State::open) {
    for (std::uint32_t place = 0; place < net.places(); ++place) {
      const bool heavy = std::ranges::any_of(
          net.of_place(place), [](const Touch& touch) { return touch.consumes > 1 || touch.produces > 1; });
      if (heavy || net.initial()[place] > 1) state_[place] = State::never;
    }
  }

  /// The set that contains `place`; empty: none was found.
  std::vector<std::uint32_t> around(std::uint32_t place, Losses losses) {
    losses_ = losses;
    guesses_left_ = guesses_per_place;
    std::vector<std::uint32_t> unit;
    if (state_[place] == State::open && decide(place, State::in) && complete())
      std::ranges::copy_if(trail_, std::back_inserter(unit),
                           [&](std::uint32_t member) { return state_[member] == State::in; });
    take_back(0);
    return unit;
  }

 private:
  enum class State : std::uint8_t { open, in, out, never };
  static constexpr int guesses_per_place = 256;
  static constexpr std::size_t most_steps = 20'000'000;  // rather than time: the same units on every machine

  /// Whether the place may still be added: with the token of the unit in it, no other
  /// place with a token may be.
  [[nodiscard]] bool is_open(std::uint32_t place) const {
    return state_[place] == State::open && (!token_at_ || net_.initial()[place] == 0);
  }

  bool decide(std::uint32_t place, State state) {
    if (state_[place] != State::open) return (state_[place] == State::in) == (state == State::in);
    if (state == State::in && net_.initial()[place] == 1) {
      if (token_at_) return false;
      token_at_ = place;
    }
    state_[place] = state;
    trail_.push_back(place);
    return true;
  }

  void take_back(std::size_t length) {
    for (; trail_.size() > length; trail_.pop_back()) {
      state_[trail_.back()] = State::open;
      if (token_at_ == trail_.back()) token_at_.reset();
    }
    settled_ = std::min(settled_, length);
  }

  /// Draws the consequences of all decisions that are not settled yet. false: they contradict each other.
  bool settle() {
    while (settled_ < trail_.size()) {
      if (steps_left_ == 0) return false;
      const std::uint32_t place = trail_[settled_++];
      const bool in = state_[place] == State::in;
      for (const Touch& touch : net_.of_place(place)) {
        if (in && !keep_rivals_out(touch, place)) return false;
        if (!balance(touch.node)) return false;
      }
    }
    return true;
  }

  bool keep_rivals_out(const Touch& touch, std::uint32_t place) {
    return std::ranges::all_of(net_.of_transition(touch.node), [&](const Touch& other) {
      const bool rival =
          (other.consumes > 0 && touch.consumes > 0) || (other.produces > 0 && touch.produces > 0);
      return other.node == place || !rival || decide(other.node, State::out);
    });
  }

  struct Sides {
    bool takes = false, gives = false;   // from, to a place in the set
    unsigned takers = 0, givers = 0;     // open places that could take or give
    std::uint32_t taker = 0, giver = 0;  // the last of them
  };
  [[nodiscard]] bool uneven(const Sides& sides) const {
    return losses_ == Losses::allowed ? sides.gives && !sides.takes : sides.takes != sides.gives;
  }
  [[nodiscard]] Sides sides(std::uint32_t transition) {
    Sides sides;
    const std::size_t steps = net_.of_transition(transition).size();
    steps_left_ -= std::min(steps, steps_left_);
    for (const Touch& touch : net_.of_transition(transition)) {
      const State state = state_[touch.node];
      sides.takes |= state == State::in && touch.consumes > 0;
      sides.gives |= state == State::in && touch.produces > 0;
      if (!is_open(touch.node)) continue;
      if (touch.consumes > 0) ++sides.takers, sides.taker = touch.node;
      if (touch.produces > 0) ++sides.givers, sides.giver = touch.node;
    }
    return sides;
  }

  bool balance(std::uint32_t transition) {
    const Sides now = sides(transition);
    if (!uneven(now)) return true;
    const unsigned choices = now.takes ? now.givers : now.takers;
    if (choices == 0) return false;
    if (choices == 1) return decide(now.takes ? now.giver : now.taker, State::in);
    return true;
  }

  /// A guess that can be replaced by its next candidate.
  struct Guess {
    std::size_t trail;                      // its length before
    std::size_t even;                       // the members before this one of the trail touch nothing uneven
    std::vector<std::uint32_t> candidates;  // the next one last
  };

  bool complete() {
    std::vector<Guess> guesses;
    bool consistent = settle();
    std::size_t even = 0;
    while (true) {
      if (consistent) {
        std::optional<Guess> next = next_guess(even);
        if (!next) return true;
        guesses.push_back(std::move(*next));
      }
      while (!guesses.empty() && guesses.back().candidates.empty()) guesses.pop_back();
      if (guesses.empty() || steps_left_ == 0 || (!consistent && --guesses_left_ < 0)) return false;
      Guess& guess = guesses.back();
      take_back(guess.trail);
      even = guess.even;
      const std::uint32_t place = guess.candidates.back();
      guess.candidates.pop_back();
      consistent = decide(place, State::in) && settle();
    }
  }

  /// The ways to balance the first unbalanced transition; nullopt: all are balanced. Places that are in
  /// no unit yet are tried first.
  std::optional<Guess> next_guess(std::size_t even) {
    for (; even < trail_.size(); ++even) {
      if (state_[trail_[even]] != State::in) continue;
      for (const Touch& touch : net_.of_place(trail_[even])) {
        const Sides now = sides(touch.node);
        if (uneven(now)) return Guess{trail_.size(), even, candidates(touch.node, now.takes)};
      }
    }
    return std::nullopt;
  }

  std::vector<std::uint32_t> candidates(std::uint32_t transition, bool giving) const {
    std::vector<std::uint32_t> open;
    for (const Touch& touch : net_.of_transition(transition))
      if (is_open(touch.node) && (giving ? touch.produces : touch.consumes) > 0) open.push_back(touch.node);
    std::ranges::stable_sort(open,
                             [&](std::uint32_t a, std::uint32_t b) { return covered_[a] > covered_[b]; });
    return open;
  }

  const PtNet& net_;
  const std::vector<char>& covered_;
  std::vector<State> state_;
  std::optional<std::uint32_t> token_at_;  // the place in the set that is marked initially
  std::vector<std::uint32_t> trail_;
  std::size_t settled_ = 0;
  Losses losses_ = Losses::forbidden;
  int guesses_left_ = 0;
  std::size_t steps_left_ = most_steps;  // arcs that are looked at, for all places together
};

}  // namespace

std::vector<Unit> find_units(const PtNet& net) {
  std::vector<Unit> units;
  std::vector<char> covered(net.places(), 0);
  const auto has_token = [&](std::uint32_t place) { return net.initial()[place] > 0; };
  UnitSearch search(net, covered);
  // Units without losses come first, because they are larger.
  for (const Losses losses : {Losses::forbidden, Losses::allowed})
    for (std::uint32_t place = 0; place < net.places(); ++place) {
      if (covered[place] != 0) continue;
      Unit unit{search.around(place, losses)};
      const std::size_t whole = unit.places.size();
      unit.always_one = losses == Losses::forbidden && std::ranges::any_of(unit.places, has_token);
      std::erase_if(unit.places, [&](std::uint32_t member) { return covered[member] != 0; });
      if (unit.places.size() < whole) unit.always_one = false;
      for (const std::uint32_t member : unit.places) covered[member] = 1;
      if (!unit.places.empty()) units.push_back(std::move(unit));
    }
  return units;
}

bool units_cover(const PtNet& net) {
  std::size_t covered = 0;
  for (const Unit& unit : find_units(net)) covered += unit.places.size();
  return covered == net.places();
}

}  // namespace tessera::explore
