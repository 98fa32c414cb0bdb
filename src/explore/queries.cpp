#include <utility>

#include "explore/explore.hpp"
#include "explore/state_graph.hpp"

namespace tessera::explore {
namespace {

using End = StateGraph::End;

/// Visits all reachable markings, for questions that need all of them.
End explore_all(GrowingGraph& graph, Watch& watch) {
  return graph.run([&](StateGraph& one) { return one.explore(Formula::never(), watch); }, watch);
}

Answer unknown(const Watch& watch) {
  Answer answer;
  answer.why = watch.why();
  return answer;
}

Answer shown_by(const StateGraph& graph, Answer::Kind kind, Index index) {
  Answer answer;
  answer.kind = kind;
  answer.trace = {graph.run_to(index), graph.marking(index)};
  answer.shortest = true;
  return answer;
}

/// Whether `goal` can be reached from every marking of the graph.
Answer reachable_from_all(const StateGraph& graph, const Formula& goal, Watch& watch) {
  Bits reached = graph.where(goal, watch);
  if (!graph.close_backward(reached, nullptr, watch)) return unknown(watch);
  const std::optional<Index> stranded = reached.complement().next(0);
  if (stranded) return shown_by(graph, Answer::Kind::no, *stranded);
  Answer answer;
  answer.kind = Answer::Kind::yes;
  return answer;
}

Answer leads_to(const StateGraph& graph, const Formula& p, const Formula& q, Watch& watch) {
  Bits to_q = graph.where(q, watch);
  const Bits without_q = to_q.complement();
  if (!graph.close_backward(to_q, nullptr, watch)) return unknown(watch);
  const Bits lost = to_q.complement();
  Bits may_be_lost = lost;
  if (!graph.close_backward(may_be_lost, &without_q, watch)) return unknown(watch);
  const Bits starts = graph.where(p, watch);
  if (!watch.why().empty()) return unknown(watch);
  Answer answer;
  answer.kind = Answer::Kind::yes;
  for (auto at = may_be_lost.next(0); at; at = may_be_lost.next(std::size_t{*at} + 1)) {
    if (!starts[*at]) continue;
    answer = shown_by(graph, Answer::Kind::no, *at);
    answer.turn = answer.trace.firings.size();
    const StateGraph::Run rest = graph.run_into(*at, lost, &without_q, watch);
    if (!watch.why().empty()) return unknown(watch);
    answer.trace.firings.insert(answer.trace.firings.end(), rest.firings.begin(), rest.firings.end());
    answer.trace.end = graph.marking(rest.end);
    answer.shortest = rest.firings.empty();
    break;
  }
  return answer;
}

}  // namespace

Count count(const PtNet& net, const Limits& limits) {
  Watch watch(limits);
  GrowingGraph graph(net);
  Count count;
  count.complete = explore_all(graph, watch) == End::complete;
  count.why = watch.why();
  if (graph.has_graph()) {
    count.markings = graph.graph().size();
    count.edges = graph.graph().edges();
    count.most_tokens = graph.graph().most_tokens();
  }
  count.effort = watch.effort();
  return count;
}

Answer find(const PtNet& net, const Formula& goal, const Limits& limits) {
  Watch watch(limits);
  GrowingGraph graph(net);
  Answer answer;
  switch (graph.run([&](StateGraph& one) { return one.explore(goal, watch); }, watch)) {
    case End::goal:
      answer = shown_by(graph.graph(), Answer::Kind::yes, static_cast<Index>(graph.graph().size() - 1));
      break;
    case End::complete:
      answer.kind = Answer::Kind::no;
      break;
    default:
      answer = unknown(watch);
  }
  answer.effort = watch.effort();
  return answer;
}

Answer always_reachable(const PtNet& net, const Formula& goal, const Limits& limits) {
  Watch watch(limits);
  GrowingGraph graph(net);
  const bool complete = explore_all(graph, watch) == End::complete;
  Answer answer = complete ? reachable_from_all(graph.graph(), goal, watch) : unknown(watch);
  answer.effort = watch.effort();
  return answer;
}

Answer leads_to(const PtNet& net, const Formula& p, const Formula& q, const Limits& limits) {
  Watch watch(limits);
  GrowingGraph graph(net);
  const bool complete = explore_all(graph, watch) == End::complete;
  Answer answer = complete ? leads_to(graph.graph(), p, q, watch) : unknown(watch);
  answer.effort = watch.effort();
  return answer;
}

std::vector<Answer> can_always_fire(const PtNet& net, const std::vector<Obligation>& obligations,
                                    const Limits& limits) {
  Watch watch(limits);
  GrowingGraph graph(net);
  const bool complete = explore_all(graph, watch) == End::complete;
  std::vector<Answer> answers;
  for (const Obligation& obligation : obligations) {
    std::vector<Formula> goal{obligation.unless};
    for (const TransitionId transition : obligation.any_of) goal.push_back(Formula::enabled(transition));
    const bool goes_on = complete && watch.why().empty();
    answers.push_back(goes_on ? reachable_from_all(graph.graph(), Formula::any(std::move(goal)), watch)
                              : unknown(watch));
    answers.back().effort = watch.effort();
  }
  return answers;
}

std::optional<Marking> replay(const PtNet& net, const std::vector<TransitionId>& firings) {
  Marking marking = net.initial();
  for (const TransitionId transition : firings) {
    if (transition.value >= net.transitions() || !net.enabled(transition.value, marking)) return std::nullopt;
    net.fire(transition.value, marking);
  }
  return marking;
}

}  // namespace tessera::explore
