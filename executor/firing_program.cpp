#include "executor/firing_program.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace tessera {
namespace {

using Arc = ExecutableNet::Arc;

/// Lists of numbers in one array, filled by counting first.
struct Rows {
  std::vector<std::uint32_t> first, items;
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t row) const {
    return std::span(items).subspan(first[row], first[row + 1] - first[row]);
  }
};

/// Sorts the arcs by place and merges arcs of one place. false: an unknown place, or a weight out of range.
[[nodiscard]] bool tidy(std::vector<Arc>& arcs, std::size_t places, std::uint32_t bound) {
  std::ranges::sort(arcs, {}, &Arc::place);
  std::size_t kept = 0;
  for (const Arc& arc : arcs) {
    if (arc.place >= places || arc.weight == 0 || arc.weight > bound) return false;
    if (kept > 0 && arcs[kept - 1].place == arc.place) {
      if (arcs[kept - 1].weight > bound - arc.weight) return false;
      arcs[kept - 1].weight += arc.weight;
    } else {
      arcs[kept++] = arc;
    }
  }
  arcs.resize(kept);
  return true;
}

[[nodiscard]] std::uint32_t weight_from(const std::vector<Arc>& arcs, std::uint32_t place) {
  const auto found = std::ranges::lower_bound(arcs, place, {}, &Arc::place);
  return found != arcs.end() && found->place == place ? found->weight : 0;
}

class FiringCompilation {
 public:
  FiringCompilation(const ExecutableNet& net, std::uint32_t bound, std::string& error)
      : net_(net), bound_(bound), error_(error) {}

  std::optional<FiringProgram> result() {
    error_.clear();
    read_arcs();
    if (!error_.empty()) return std::nullopt;
    find_consumers();
    number_as_tokens_walk();
    rank_priorities();
    for (const std::uint32_t place : program_.original_place) add_place(place);
    for (const std::uint32_t transition : program_.original_transition) add_transition(transition);
    for (std::uint32_t t = 0; t < program_.hops.size(); ++t) classify_direct(t);
    return std::move(program_);
  }

 private:
  void read_arcs() {
    for (const ExecutableNet::Place& place : net_.places)
      if (place.tokens > bound_)
        error_ = fmt::format("place '{}' holds more than {} tokens", place.name, bound_);
    for (const ExecutableNet::Transition& transition : net_.transitions) {
      inputs_.push_back(transition.inputs);
      outputs_.push_back(transition.outputs);
      if (!tidy(inputs_.back(), net_.places.size(), bound_) ||
          !tidy(outputs_.back(), net_.places.size(), bound_))
        error_ =
            fmt::format("transition '{}' has an arc to no place, or of a weight that is not from 1 to {}",
                        transition.name, bound_);
    }
  }

  void find_consumers() {
    consumers_.first.assign(net_.places.size() + 1, 0);
    for (const auto& arcs : inputs_)
      for (const Arc& arc : arcs) ++consumers_.first[arc.place + 1];
    std::partial_sum(consumers_.first.begin(), consumers_.first.end(), consumers_.first.begin());
    consumers_.items.resize(consumers_.first.back());
    std::vector<std::uint32_t> next(consumers_.first);
    for (std::uint32_t t = 0; t < inputs_.size(); ++t)
      for (const Arc& arc : inputs_[t]) consumers_.items[next[arc.place]++] = t;
  }

  /// Depth first along the arcs, from the transitions that are enabled at the start.
  void number_as_tokens_walk() {
    program_.number_of_place.resize(net_.places.size());
    program_.number_of_transition.resize(net_.transitions.size());
    place_is_numbered_.assign(net_.places.size(), false);
    transition_is_numbered_.assign(net_.transitions.size(), false);
    walked_.assign(net_.places.size(), false);
    for (const bool only_enabled : {true, false})
      for (std::uint32_t t = 0; t < net_.transitions.size(); ++t)
        if (!only_enabled || initially_enabled(t)) walk_from(t);
    for (std::uint32_t p = 0; p < net_.places.size(); ++p) number_place(p);
  }

  [[nodiscard]] bool initially_enabled(std::uint32_t transition) const {
    return std::ranges::all_of(inputs_[transition],
                               [&](const Arc& arc) { return net_.places[arc.place].tokens >= arc.weight; });
  }

  void walk_from(std::uint32_t start) {
    std::vector<std::uint32_t> open{start};
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      if (transition_is_numbered_[t]) continue;
      transition_is_numbered_[t] = true;
      program_.number_of_transition[t] = static_cast<std::uint32_t>(program_.original_transition.size());
      program_.original_transition.push_back(t);
      for (const Arc& arc : inputs_[t]) number_place(arc.place);
      for (const Arc& arc : outputs_[t]) {
        number_place(arc.place);
        if (walked_[arc.place]) continue;  // visits a place with many producers and consumers only once
        walked_[arc.place] = true;
        const auto next = consumers_[arc.place];
        open.insert(open.end(), next.begin(), next.end());
      }
    }
  }

  void number_place(std::uint32_t place) {
    if (place_is_numbered_[place]) return;
    place_is_numbered_[place] = true;
    program_.number_of_place[place] = static_cast<std::uint32_t>(program_.original_place.size());
    program_.original_place.push_back(place);
  }

  void rank_priorities() {
    std::vector<std::int32_t> priorities{0};
    if (!net_.transitions.empty()) priorities.clear();
    for (const ExecutableNet::Transition& transition : net_.transitions)
      priorities.push_back(transition.priority);
    std::ranges::sort(priorities, std::greater<>());
    priorities.erase(std::unique(priorities.begin(), priorities.end()), priorities.end());
    program_.ranks = static_cast<std::uint32_t>(priorities.size());
    for (const std::uint32_t t : program_.original_transition)
      program_.rank.push_back(static_cast<std::uint32_t>(
          std::ranges::lower_bound(priorities, net_.transitions[t].priority, std::greater<>()) -
          priorities.begin()));
  }

  [[nodiscard]] bool is_sole(std::uint32_t transition) const {
    if (net_.transitions[transition].condition || inputs_[transition].size() != 1) return false;
    const Arc& input = inputs_[transition].front();
    return input.weight == 1 && consumers_[input.place].size() == 1 &&
           weight_from(outputs_[transition], input.place) == 0;
  }

  void add_place(std::uint32_t place) {
    FiringProgram::PlaceRecord record;
    record.operates = static_cast<bool>(net_.places[place].operation);
    record.first = static_cast<std::uint32_t>(program_.consumers.size());
    for (const std::uint32_t t : consumers_[place]) {
      if (is_sole(t)) record.sole = {program_.number_of_transition[t]};
      program_.consumers.push_back({program_.number_of_transition[t], weight_from(inputs_[t], place)});
    }
    record.last = static_cast<std::uint32_t>(program_.consumers.size());
    program_.places.push_back(record);
  }

  void add_transition(std::uint32_t transition) {
    FiringProgram::Arcs arcs;
    arcs.takes = static_cast<std::uint32_t>(program_.takes.size());
    for (const Arc& arc : inputs_[transition])
      program_.takes.push_back({program_.number_of_place[arc.place], arc.weight});
    arcs.takes_end = static_cast<std::uint32_t>(program_.takes.size());
    arcs.gives = static_cast<std::uint32_t>(program_.gives.size());
    for (const Arc& arc : outputs_[transition])
      program_.gives.push_back(
          {program_.number_of_place[arc.place], arc.weight, weight_from(inputs_[transition], arc.place)});
    arcs.gives_end = static_cast<std::uint32_t>(program_.gives.size());
    if (net_.transitions[transition].condition) arcs.condition = {transition};
    arcs.operates = std::ranges::any_of(outputs_[transition], [this](const Arc& arc) {
      return static_cast<bool>(net_.places[arc.place].operation);
    });
    program_.arcs.push_back(arcs);
    FiringProgram::Hop hop;
    if (is_sole(transition)) {
      hop.kind = FiringProgram::Hop::Kind::sole;
      hop.from = program_.number_of_place[inputs_[transition].front().place];
    }
    program_.hops.push_back(hop);
  }

  void classify_direct(std::uint32_t transition) {
    FiringProgram::Hop& hop = program_.hops[transition];
    const FiringProgram::Arcs& arcs = program_.arcs[transition];
    if (hop.kind != FiringProgram::Hop::Kind::sole || arcs.gives_end - arcs.gives != 1) return;
    const FiringProgram::Give& give = program_.gives[arcs.gives];
    const FiringProgram::PlaceRecord& place = program_.places[give.place];
    if (give.weight != 1 || place.operates || !place.sole.valid()) return;
    hop = {FiringProgram::Hop::Kind::direct, hop.from, give.place, place.sole.value};
  }

  const ExecutableNet& net_;
  std::uint32_t bound_;
  std::string& error_;
  std::vector<std::vector<Arc>> inputs_, outputs_;  // tidy
  Rows consumers_;                                  // per place: transitions that take from it
  std::vector<bool> walked_;                        // per place
  std::vector<bool> place_is_numbered_, transition_is_numbered_;
  FiringProgram program_;
};

}  // namespace

std::optional<FiringProgram> compile(const ExecutableNet& net, std::uint32_t bound, std::string& error) {
  return FiringCompilation(net, bound, error).result();
}

}  // namespace tessera
