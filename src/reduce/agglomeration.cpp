#include <algorithm>

#include "reduce/draft.hpp"

namespace tessera::reduce {
namespace {

/// The transitions that fill a place and those that empty it, if each pair can be fired as one.
class Agglomeration {
 public:
  Agglomeration(Work& work, std::uint32_t place)
      : work_(work),
        index_(place),
        fill_(work.draft.places()[place].producers),
        empty_(work.draft.places()[place].consumers) {}

  bool apply() {
    const Draft::Place& place = work_.draft.places()[index_];
    if (place.observed || place.tokens > 0 || !is_small() || !is_simple()) return false;
    const bool after = work_.on.post_agglomeration && can_follow_at_once();
    const bool before = !after && work_.on.pre_agglomeration && can_be_delayed();
    if (!after && !before) return false;
    if (before) work_.delayed.push_back(work_.draft.transitions()[fill_.front()].sequence);
    ++(after ? work_.count.post_agglomeration : work_.count.pre_agglomeration);
    join();
    return true;
  }

 private:
  [[nodiscard]] const Draft::Transition& at(std::uint32_t transition) const {
    return work_.draft.transitions()[transition];
  }

  [[nodiscard]] bool is_small() const {
    if (fill_.empty() || empty_.empty() || fill_.size() > most_arcs || empty_.size() > most_arcs)
      return false;
    const auto small = [&](auto t) { return tessera::reduce::is_small(at(t)); };
    if (!std::ranges::all_of(fill_, small) || !std::ranges::all_of(empty_, small)) return false;
    // The net must not grow.
    return fill_.size() * empty_.size() <= fill_.size() + empty_.size();
  }

  /// Whether each moves one token at a time, and no transition both fills and empties the place.
  [[nodiscard]] bool is_simple() const {
    const auto single = [&](const Arcs& arcs) { return weight_at(arcs, index_) == 1; };
    const auto none = [&](const Arcs& arcs) { return weight_at(arcs, index_) == 0; };
    return std::ranges::all_of(fill_, [&](auto t) { return single(at(t).outputs) && none(at(t).inputs); }) &&
           std::ranges::all_of(empty_, [&](auto t) { return single(at(t).inputs) && none(at(t).outputs); });
  }

  [[nodiscard]] bool can_follow_at_once() const {
    return std::ranges::all_of(
        empty_, [&](auto t) { return at(t).inputs.size() == 1 && !work_.draft.touches_observed(at(t)); });
  }

  [[nodiscard]] bool can_be_delayed() const {
    if (fill_.size() != 1) return false;
    const Draft::Transition& producer = at(fill_.front());
    if (producer.outputs.size() != 1 || producer.inputs.empty() || work_.draft.touches_observed(producer))
      return false;
    if (!work_.what.safe && !producer.sets.empty()) return false;
    return std::ranges::all_of(producer.inputs, [&](const Arc& arc) {
      return work_.draft.places()[arc.place.value].consumers.size() == 1;
    });
  }

  void join() {
    std::vector<Draft::Transition> joined;
    for (const std::uint32_t first : fill_)
      for (const std::uint32_t second : empty_) joined.push_back(one_after_the_other(at(first), at(second)));
    for (const std::uint32_t transition : fill_) work_.draft.remove_transition(transition);
    for (const std::uint32_t transition : empty_) work_.draft.remove_transition(transition);
    work_.draft.remove_place(index_);
    for (Draft::Transition& transition : joined) work_.draft.add(std::move(transition));
  }

  [[nodiscard]] Draft::Transition one_after_the_other(const Draft::Transition& first,
                                                      const Draft::Transition& second) const {
    work_.sequences.push_back({first.sequence, second.sequence});
    return {.inputs = sum(first.inputs, without(second.inputs, index_)),
            .outputs = sum(without(first.outputs, index_), second.outputs),
            .sequence = static_cast<std::uint32_t>(work_.sequences.size() - 1),
            .sets = united(first.sets, second.sets)};
  }

  Work& work_;
  std::uint32_t index_;
  std::vector<std::uint32_t> fill_, empty_;
};

}  // namespace

bool agglomerate(Work& work, std::uint32_t place) { return Agglomeration(work, place).apply(); }

}  // namespace tessera::reduce
