#include "verify/communication/behaviour_graph.hpp"

#include <algorithm>

namespace tessera::verify {

std::optional<Running> running(const net::HierarchicalNet& pages, const net::Statement& statement) {
  using Kind = net::Statement::Kind;
  if (statement.kind == Kind::token) {
    if (!statement.page.valid()) return std::nullopt;
    const net::Page& page = pages.pages[statement.page.value];
    if (page.layer != net::Layer::behaviour) return std::nullopt;
    return Running{page.subsystem, {pages.path(statement.page)}};
  }
  const bool plain = statement.kind == Kind::any || statement.parts.size() == 1;
  if (statement.kind == Kind::negation || !plain) return std::nullopt;
  std::optional<Running> all;
  for (const net::Statement& part : statement.parts) {
    std::optional<Running> one = running(pages, part);
    if (!one || (all && all->subsystem != one->subsystem)) return std::nullopt;
    if (!all) all = Running{one->subsystem, {}};
    all->behaviours.insert(all->behaviours.end(), one->behaviours.begin(), one->behaviours.end());
  }
  return all;
}

BehaviourGraph::BehaviourGraph(const SubsystemFlow& subsystem)
    : subsystem_(subsystem), next_(subsystem.behaviours.size() + 2) {
  const auto end = static_cast<std::uint32_t>(subsystem.behaviours.size());
  const std::uint32_t lost = end + 1;
  for (std::uint32_t node = 0; node < end; ++node) {
    const BehaviourFlow& behaviour = subsystem.behaviours[node];
    if (behaviour.repeats) next_[node].push_back(node);
    if (!behaviour.leaves) continue;
    next_[node].insert(next_[node].end(), behaviour.next.begin(), behaviour.next.end());
    if (behaviour.ends) next_[node].push_back(end);
    if (!behaviour.complete) next_[node].push_back(lost);
  }
}

BehaviourGraph::Nodes BehaviourGraph::nodes(const std::vector<std::string>& names) const {
  Nodes nodes(size(), false);
  for (std::size_t node = 0; node < subsystem_.behaviours.size(); ++node)
    nodes[node] = std::ranges::count(names, subsystem_.behaviours[node].name) > 0;
  return nodes;
}

bool BehaviourGraph::any(const Nodes& nodes) { return std::ranges::count(nodes, true) > 0; }

BehaviourGraph::Nodes BehaviourGraph::that_reach(const Nodes& goal) const {
  Nodes reach = goal;
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t node = 0; node < size(); ++node) {
      if (reach[node]) continue;
      reach[node] = std::ranges::any_of(next_[node], [&](std::uint32_t next) { return reach[next]; });
      grew = grew || reach[node];
    }
  }
  return reach;
}

BehaviourGraph::Nodes BehaviourGraph::reached(const Nodes& start, const Nodes& around) const {
  Nodes reached(size(), false);
  std::vector<std::size_t> open;
  const auto visit = [&](std::size_t node) {
    if (around[node] || reached[node]) return;
    reached[node] = true;
    open.push_back(node);
  };
  for (std::size_t node = 0; node < size(); ++node)
    if (start[node]) visit(node);
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    for (const std::uint32_t next : next_[node]) visit(next);
  }
  return reached;
}

std::string BehaviourGraph::name(std::size_t node) const {
  if (node < subsystem_.behaviours.size()) return "'" + subsystem_.behaviours[node].name + "'";
  return node == subsystem_.behaviours.size() ? "the end of '" + subsystem_.name + "'"
                                              : "where no initial condition holds";
}

}  // namespace tessera::verify
