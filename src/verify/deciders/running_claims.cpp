#include "verify/deciders/running_claims.hpp"

#include <algorithm>
#include <optional>

#include "verify/communication/behaviour_graph.hpp"

namespace tessera::verify {
namespace {

/// A subsystem, and whether it is known to go on as long as it has not ended.
struct Known {
  const SubsystemFlow* flow = nullptr;
  bool goes_on = false;
};

Known known(const NetUnderAssumption& given, net::SubsystemId id) {
  const std::vector<SubsystemFlow>& all = given.communication.structure->subsystems;
  const auto flow = std::ranges::find(all, id, &SubsystemFlow::id);
  if (flow == all.end()) return {};
  const SubsystemFlowId number{static_cast<std::uint32_t>(flow - all.begin())};
  for (const CircuitGroup& group : given.circuits->groups)
    if (std::ranges::count(group.subsystems, number) > 0)
      return {&*flow, group.applies() && std::ranges::count(group.stuck, number) == 0};
  return {&*flow, false};
}

std::string names(const Running& running) {
  std::string text;
  for (const std::string& name : running.behaviours) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

/// From all of `from`, a goal can be reached; else no, with the first from which none can.
RunningVerdict all_reach(const BehaviourGraph& graph, const BehaviourGraph::Nodes& from,
                         const BehaviourGraph::Nodes& goal, const std::string& goal_name) {
  const BehaviourGraph::Nodes reach = graph.that_reach(goal);
  for (std::size_t node = 0; node < graph.size(); ++node)
    if (from[node] && !reach[node])
      return {Answer::no, goal_name + " cannot follow any more after " + graph.name(node)};
  return {Answer::yes, {}};
}

RunningVerdict judge_one(const NetUnderAssumption& given, const net::HierarchicalNet& pages,
                         net::Property::Kind kind, const net::Claim& claim) {
  const std::optional<Running> what = running(pages, claim.what);
  if (!what) return {};
  const Known subsystem = known(given, what->subsystem);
  if (subsystem.flow == nullptr) return {};
  const BehaviourGraph graph(*subsystem.flow);
  const BehaviourGraph::Nodes nodes = graph.nodes(what->behaviours);
  const BehaviourGraph::Nodes nowhere(graph.size(), false);
  if (!BehaviourGraph::any(nodes)) {
    const bool fine = kind == net::Property::Kind::never || kind == net::Property::Kind::leads_to;
    return {fine ? Answer::yes : Answer::no, fine ? "" : names(*what) + " follows no behaviour that can run"};
  }
  if (!subsystem.goes_on) return {};
  switch (kind) {
    case net::Property::Kind::never:
      return {Answer::no, names(*what) + " can run"};
    case net::Property::Kind::reachable:
      return {Answer::yes, {}};
    case net::Property::Kind::always_reachable: {
      BehaviourGraph::Nodes start = nowhere;
      start[0] = true;
      return all_reach(graph, graph.reached(start, nowhere), nodes, names(*what));
    }
    case net::Property::Kind::leads_to: {
      const std::optional<Running> then = running(pages, claim.then);
      if (!then || then->subsystem != what->subsystem) return {};
      const BehaviourGraph::Nodes goal = graph.nodes(then->behaviours);
      return all_reach(graph, graph.reached(nodes, goal), goal, names(*then));
    }
    case net::Property::Kind::always:
      break;
  }
  return {};
}

/// The verdict on a claim of several parts, each of which alone settles it by the answer `settles`. If all
/// parts have the opposite answer, so has the claim.
RunningVerdict first_of(const NetUnderAssumption& given, const net::HierarchicalNet& pages,
                        net::Property::Kind kind, const net::Claim& claim, Answer settles) {
  RunningVerdict last;
  bool open = claim.what.parts.empty();
  for (const net::Statement& part : claim.what.parts) {
    RunningVerdict verdict = judge_running(given, pages, kind, {claim.about, part, claim.then});
    if (verdict.answer == settles) return verdict;
    open = open || verdict.answer == Answer::unknown;
    last = std::move(verdict);
  }
  return open ? RunningVerdict{} : last;
}

}  // namespace

RunningVerdict judge_running(const NetUnderAssumption& given, const net::HierarchicalNet& pages,
                             net::Property::Kind kind, const net::Claim& claim) {
  RunningVerdict verdict = judge_one(given, pages, kind, claim);
  if (verdict.answer != Answer::unknown) return verdict;
  const bool either = claim.what.kind == net::Statement::Kind::any;
  switch (kind) {
    case net::Property::Kind::reachable:
      if (either) return first_of(given, pages, kind, claim, Answer::yes);
      return verdict;
    case net::Property::Kind::never:
    case net::Property::Kind::leads_to:
      if (either) return first_of(given, pages, kind, claim, Answer::no);
      return verdict;
    case net::Property::Kind::always_reachable:
      // Though none of them is always in reach, one or the other may be.
      if (either) verdict = first_of(given, pages, kind, claim, Answer::yes);
      return verdict.answer == Answer::yes ? verdict : RunningVerdict{};
    case net::Property::Kind::always:
      return {};
  }
  return {};
}

}  // namespace tessera::verify
