#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <unordered_map>
#include <utility>

#include "explore/firing_table.hpp"
#include "explore/marking_set.hpp"
#include "explore/packed_formula.hpp"
#include "explore/state_graph.hpp"

namespace tessera::explore {

/// StateGraph on packed markings of W words. Firings are collected in batches, so that the cache
/// misses of a whole batch overlap.
template <std::size_t W, bool Counters>
class PackedGraph final : public StateGraph {
 public:
  PackedGraph(const PtNet& net, const Encoding& encoding) : net_(net), encoding_(encoding) {}

  End explore(const Formula& goal, Watch& watch) override {
    forward();
    const PackedFormula is_goal(goal, encoding_, *forward_);
    if (!insert(net_.initial())) return End::outgrown;
    if (is_goal(set_[0])) return End::goal;
    End end = End::complete;
    std::size_t level_end = 1;
    for (std::size_t at = 0; end == End::complete; ++at) {
      if (at == level_end) {
        end = flush(is_goal, watch);
        if (end != End::complete || at == set_.size()) break;
        level_starts_.push_back(static_cast<Index>(level_end));
        level_end = set_.size();
      }
      end = expand(static_cast<Index>(at), is_goal, watch);
    }
    if (set_.size() > level_end) level_starts_.push_back(static_cast<Index>(level_end));
    return end;
  }

  std::optional<Insertion> insert(const Marking& marking) override {
    Packed<W> words{};
    if (const auto outgrown = encoding_.encode(marking, words)) {
      outgrown_ = *outgrown;
      return std::nullopt;
    }
    set_.reserve(1);
    const auto [index, fresh] = set_.insert(words, Set::hash(words));
    return Insertion{index, fresh};
  }

  [[nodiscard]] std::size_t size() const override { return set_.size(); }
  [[nodiscard]] std::uint64_t edges() const override { return edges_; }
  [[nodiscard]] std::size_t bytes() const override { return set_.bytes() + sizeof(Batch); }
  [[nodiscard]] std::uint32_t outgrown() const override { return outgrown_; }

  [[nodiscard]] Marking marking(Index index) const override {
    Marking marking(net_.places());
    encoding_.decode(set_[index], marking);
    return marking;
  }

  [[nodiscard]] Tokens most_tokens() const override {
    Tokens most = 0;
    for (std::uint32_t place = 0; place < net_.places(); ++place) most = std::max(most, most_in(place, most));
    return most;
  }

  [[nodiscard]] Bits where(const Formula& formula, Watch& watch) const override {
    constexpr std::size_t between_checks = 4096;
    forward();
    const PackedFormula holds(formula, encoding_, *forward_);
    Bits bits(set_.size());
    for (std::size_t index = 0; index < set_.size(); ++index) {
      if (index % between_checks == 0 && !watch.go_on(set_.size(), bytes() + bits.bytes())) break;
      if (holds(set_[static_cast<Index>(index)])) bits.set(index);
    }
    return bits;
  }

  bool close_backward(Bits& reached, const Bits* within, Watch& watch) const override {
    backward();
    const Bits seeds = reached;
    std::vector<Index> open;
    auto batch = std::make_unique<Batch>();
    const auto look_up = [&] {
      lookups(*batch, [&](const Packed<W>& words, std::uint64_t hash) {
        const std::optional<Index> before = set_.find(words, hash);
        if (!before || reached[*before] || (within != nullptr && !(*within)[*before])) return;
        reached.set(*before);
        open.push_back(*before);
      });
      return watch.go_on(set_.size(), bytes() + 2 * seeds.bytes() + open.capacity() * sizeof(Index));
    };
    const auto retreat = [&](Index index) {
      bool goes_on = true;
      static_cast<void>(backward_->for_each_enabled(set_[index], [&](std::uint32_t, const Packed<W>& before) {
        batch->add(before);
        if (batch->full()) goes_on = look_up() && goes_on;
      }));
      return goes_on;
    };
    std::optional<Index> seed = seeds.next(0);
    while (true) {
      if (open.empty() && !seed) {
        if (!look_up()) return false;
        if (open.empty()) return true;
      }
      Index index = 0;
      if (seed) {
        index = *seed;
        seed = seeds.next(std::size_t{index} + 1);
      } else {
        index = open.back();
        open.pop_back();
      }
      if (!retreat(index)) return false;
    }
  }

  [[nodiscard]] std::vector<TransitionId> run_to(Index index) const override {
    backward();
    std::vector<TransitionId> run;
    for (auto level = std::prev(std::ranges::upper_bound(level_starts_, index));
         level != level_starts_.begin(); --level) {
      // All markings before the first one of the level are nearer to the initial one.
      std::optional<std::pair<TransitionId, Index>> step;
      static_cast<void>(
          backward_->for_each_enabled(set_[index], [&](std::uint32_t firing, const Packed<W>& words) {
            if (step) return;
            const std::optional<Index> before = set_.find(words, Set::hash(words));
            if (before && *before < *level) step.emplace(backward_->transition(firing), *before);
          }));
      run.push_back(step->first);
      index = step->second;
    }
    std::ranges::reverse(run);
    return run;
  }

  [[nodiscard]] Run run_into(Index from, const Bits& target, const Bits* within,
                             Watch& watch) const override {
    forward();
    struct Step {
      Index before;
      TransitionId transition;
    };
    std::unordered_map<Index, Step> steps{{from, {from, {}}}};
    std::deque<Index> queue{from};
    std::optional<Index> end;
    if (target[from]) end = from;
    while (!end && !queue.empty()) {
      if (!watch.go_on(set_.size(), bytes() + steps.size() * sizeof(Step) * 4)) break;
      const Index index = queue.front();
      queue.pop_front();
      static_cast<void>(
          forward_->for_each_enabled(set_[index], [&](std::uint32_t firing, const Packed<W>& words) {
            const std::optional<Index> next = set_.find(words, Set::hash(words));
            if (end || !next || !steps.try_emplace(*next, Step{index, forward_->transition(firing)}).second)
              return;
            if (target[*next]) end = *next;
            if (within == nullptr || (*within)[*next]) queue.push_back(*next);
          }));
    }
    Run run{{}, end.value_or(from)};
    for (Index at = run.end; at != from; at = steps.at(at).before)
      run.firings.push_back(steps.at(at).transition);
    std::ranges::reverse(run.firings);
    return run;
  }

 private:
  using Set = MarkingSet<W>;
  using Table = FiringTable<W, Counters>;

  /// Markings that are looked up together.
  struct Batch {
    static constexpr std::size_t capacity = W <= 4 ? 256 : 32;
    std::array<Packed<W>, capacity> words;
    std::array<std::uint64_t, capacity> hashes;
    std::size_t size = 0;

    void add(const Packed<W>& marking) {
      words[size] = marking;
      hashes[size++] = Set::hash(marking);
    }
    [[nodiscard]] bool full() const { return size == capacity; }
  };

  template <class LookUp>
  void lookups(Batch& batch, LookUp look_up) const {
    for (std::size_t at = 0; at < batch.size; ++at) set_.prefetch_slot(batch.hashes[at]);
    for (std::size_t at = 0; at < batch.size; ++at) set_.prefetch_marking(batch.hashes[at]);
    for (std::size_t at = 0; at < batch.size; ++at) look_up(batch.words[at], batch.hashes[at]);
    batch.size = 0;
  }

  template <class Goal>
  End expand(Index index, const Goal& is_goal, Watch& watch) {
    const Packed<W> marking = set_[index];  // a copy, because a flush may move the set
    End end = End::complete;
    const auto outgrown = forward_->for_each_enabled(marking, [&](std::uint32_t, const Packed<W>& next) {
      if (end != End::complete) return;
      ++edges_;
      batch_.add(next);
      if (batch_.full()) end = flush(is_goal, watch);
    });
    if (end != End::complete || !outgrown) return end;
    note_outgrown(marking, forward_->transition(*outgrown));
    return End::outgrown;
  }

  /// Inserts the markings of the batch in their order.
  template <class Goal>
  End flush(const Goal& is_goal, Watch& watch) {
    if (set_.size() + Batch::capacity > most_markings)
      watch.give_up("there are more than 4 billion markings");
    if (!watch.go_on(set_.size(), set_.bytes_after(batch_.size) + sizeof(Batch))) return End::limit;
    set_.reserve(batch_.size);
    End end = End::complete;
    lookups(batch_, [&](const Packed<W>& words, std::uint64_t hash) {
      if (end == End::goal) return;
      const auto inserted = set_.insert(words, hash);
      if (inserted.fresh && is_goal(words)) end = End::goal;
    });
    return end;
  }

  void note_outgrown(const Packed<W>& before, TransitionId transition) {
    Marking marking(net_.places());
    encoding_.decode(before, marking);
    net_.fire(transition.value, marking);
    Packed<W> words{};
    outgrown_ = encoding_.encode(marking, words).value_or(0);
  }

  [[nodiscard]] Tokens most_in(std::uint32_t place, Tokens known) const {
    const bool counted = encoding_.of(place).kind == Encoding::Kind::counter;
    Tokens most = known;
    for (std::size_t index = 0; index < set_.size() && (counted || most == 0); ++index)
      most = std::max(most, encoding_.tokens(place, set_[static_cast<Index>(index)]));
    return most;
  }

  // Made when it is first needed: a search with an order of its own does not need it.
  void forward() const {
    if (!forward_) forward_ = std::make_unique<Table>(net_, encoding_, Direction::forward);
  }
  void backward() const {
    if (!backward_) backward_ = std::make_unique<Table>(net_, encoding_, Direction::backward);
  }

  const PtNet& net_;
  const Encoding& encoding_;
  mutable std::unique_ptr<Table> forward_, backward_;
  Set set_;
  std::vector<Index> level_starts_{0};
  Batch batch_;
  std::uint64_t edges_ = 0;
  std::uint32_t outgrown_ = 0;
};

}  // namespace tessera::explore
