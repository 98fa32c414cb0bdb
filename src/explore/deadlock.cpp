#include <algorithm>
#include <optional>
#include <utility>

#include "explore/budget.hpp"
#include "explore/explore.hpp"
#include "explore/state_graph.hpp"
#include "explore/stubborn.hpp"

namespace tessera::explore {
namespace {

using End = StateGraph::End;

/// Depth-first search for an unwanted dead marking through the stubborn sets. Depth first, because such
/// markings are deep, and in the reduced graph often near the first run.
class DeadlockSearch {
 public:
  DeadlockSearch(const PtNet& net, const Formula& is_final, Watch& watch)
      : net_(net), is_final_(is_final), watch_(watch), stubborn_(net) {}

  End run(StateGraph& graph) {
    marking_ = net_.initial();
    path_.clear();
    frames_.clear();
    pending_.clear();
    if (!graph.insert(marking_)) return End::outgrown;
    if (open_frame()) return End::goal;
    while (!frames_.empty()) {
      if (pending_.size() == frames_.back()) {
        leave_frame();
        continue;
      }
      const std::uint32_t transition = pending_.back();
      pending_.pop_back();
      net_.fire(transition, marking_);
      const auto inserted = graph.insert(marking_);
      if (!inserted) return End::outgrown;
      if (inserted->fresh) {
        path_.push_back(TransitionId{transition});
        if (open_frame()) return End::goal;
      } else {
        unfire(transition);
      }
      if (!watch_.go_on(graph.size(), graph.bytes() + own_bytes())) return End::limit;
    }
    return End::complete;
  }

  [[nodiscard]] std::vector<TransitionId> take_path() { return std::move(path_); }

 private:
  /// true: the marking is dead and not final.
  bool open_frame() {
    const auto firings = stubborn_.choose(marking_);
    if (firings.empty() && !holds(is_final_, net_, marking_)) return true;
    frames_.push_back(pending_.size());
    pending_.insert(pending_.end(), firings.rbegin(), firings.rend());
    return false;
  }

  void leave_frame() {
    frames_.pop_back();
    if (path_.empty()) return;
    unfire(path_.back().value);
    path_.pop_back();
  }

  void unfire(std::uint32_t transition) {
    for (const Touch& touch : net_.of_transition(transition))
      marking_[touch.node] = marking_[touch.node] - touch.produces + touch.consumes;
  }

  [[nodiscard]] std::size_t own_bytes() const {
    return pending_.capacity() * sizeof(std::uint32_t) + frames_.capacity() * sizeof(std::size_t) +
           path_.capacity() * sizeof(TransitionId);
  }

  const PtNet& net_;
  const Formula& is_final_;
  Watch& watch_;
  StubbornSets stubborn_;
  Marking marking_;
  std::vector<TransitionId> path_;      // the firings that lead to marking_
  std::vector<std::size_t> frames_;     // per marking of the path: where its pending firings begin
  std::vector<std::uint32_t> pending_;  // firings that have not been tried yet, of all markings of the path
};

/// The rest of a run without the firings [begin, end) and without those that can then no longer fire.
std::vector<TransitionId> run_without(const PtNet& net, const std::vector<TransitionId>& run,
                                      std::size_t begin, std::size_t end, Marking& marking) {
  std::vector<TransitionId> rest;
  marking = net.initial();
  for (std::size_t at = 0; at < run.size(); ++at) {
    if ((at >= begin && at < end) || !net.enabled(run[at].value, marking)) continue;
    net.fire(run[at].value, marking);
    rest.push_back(run[at]);
  }
  return rest;
}

/// Leaves out firings, in ever smaller pieces, as long as the run still ends in an unwanted dead marking.
/// nullopt: the time is over.
std::optional<std::vector<TransitionId>> shortened(const PtNet& net, const Formula& goal,
                                                   std::vector<TransitionId> run, const Budget& budget) {
  // Firings, and transitions that are looked at in the end: the same run on every machine.
  std::size_t effort_left = 10'000'000;
  Marking marking;
  for (std::size_t piece = run.size() / 2; piece > 0; piece /= 2)
    for (std::size_t begin = 0; begin < run.size();) {
      const std::size_t effort = run.size() + net.transitions();
      if (effort_left < effort) return run;
      effort_left -= effort;
      if (budget.spent()) return std::nullopt;
      std::vector<TransitionId> rest = run_without(net, run, begin, begin + piece, marking);
      if (holds(goal, net, marking))
        run = std::move(rest);
      else
        begin += piece;
    }
  return run;
}

}  // namespace

Answer find_deadlock(const PtNet& net, const Formula& is_final, const Limits& limits) {
  const Budget budget(limits);
  Watch watch(limits);
  Answer answer;
  GrowingGraph graph(net);
  DeadlockSearch search(net, is_final, watch);
  const End end = graph.run([&](StateGraph& one) { return search.run(one); }, watch);
  if (end == End::complete) answer.kind = Answer::Kind::no;
  if (end == End::limit) answer.why = watch.why();
  if (end == End::goal) {
    const Formula unwanted = Formula::all({Formula::dead(), Formula::negation(is_final)});
    // A search near the initial marking costs little and often finds the shortest run.
    Limits near = budget.left();
    near.markings = 20'000;
    near.progress = nullptr;
    answer = find(net, unwanted, near);
    if (answer.kind != Answer::Kind::yes) {
      answer = {};
      answer.kind = Answer::Kind::yes;
      const std::vector<TransitionId> path = search.take_path();
      const auto shorter = budget.spent() ? std::nullopt : shortened(net, unwanted, path, budget);
      answer.cut_short = !shorter;
      answer.trace.firings = shorter.value_or(path);
      answer.trace.end = *replay(net, answer.trace.firings);
    }
  }
  answer.effort = watch.effort();
  return answer;
}

}  // namespace tessera::explore
