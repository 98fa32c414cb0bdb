#include "net/flatten.hpp"

#include <memory>
#include <string>
#include <utility>

namespace tessera::net {
namespace {

/// Rejects hierarchies that have no flat net.
class Examination {
 public:
  Examination(const HierarchicalNet& net, diagnostics::Diagnostics& out) : net_(net), out_(out) {}

  bool passes() {
    const std::size_t before = out_.error_count();
    if (net_.pages.empty()) out_.error("E401", {}, "the net has no pages");
    reached_.assign(net_.pages.size(), 0);
    operations_.assign(net_.fusions.size(), 0);
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page) examine(PageId{page});
    for (std::uint32_t page = 1; page < net_.pages.size(); ++page)
      if (reached_[page] == 0)
        out_.error("E404", net_.pages[page].span, "no net draws page '" + name(page) + "'");
    return out_.error_count() == before;
  }

 private:
  void examine(PageId id) {
    const Page& page = net_.pages[id.value];
    if (page.input >= page.nodes.size() || page.output >= page.nodes.size())
      out_.error("E401", page.span,
                 "page '" + name(id.value) + "' has no net with an input and an output place");
    for (const Node& node : page.nodes) {
      if (node.page.valid()) examine_page(id, node);
      if (node.fusion.valid()) examine_member(id, node);
    }
    for (const PageTransition& transition : page.transitions)
      for (const auto& ends : {transition.inputs, transition.outputs})
        for (const std::uint32_t end : ends)
          if (end >= page.nodes.size())
            out_.error("E401", transition.span, "an arc of '" + transition.name + "' leads out of its net");
  }

  void examine_page(PageId drawn_in, const Node& node) {
    const Span span = net_.pages[drawn_in.value].span;
    if (node.page.value >= net_.pages.size()) {
      out_.error("E401", span, "page '" + node.name + "' has no net");
      return;
    }
    if (node.fusion.valid() || node.tokens > 0 || node.operation.kind != Operation::Kind::none)
      out_.error("E405", span,
                 "page '" + node.name + "' is fused, marked or has an operation, which only places may");
    // Children follow their parents, so this also rejects pages that contain themselves.
    if (node.page <= drawn_in || net_.pages[node.page.value].parent != drawn_in ||
        reached_[node.page.value]++ > 0)
      out_.error("E404", span, "page '" + node.name + "' is reached twice");
  }

  void examine_member(PageId drawn_in, const Node& node) {
    const Span span = net_.pages[drawn_in.value].span;
    if (node.fusion.value >= net_.fusions.size()) {
      out_.error("E402", span, "place '" + node.name + "' is a member of no fusion set");
      return;
    }
    const FusionSet& set = net_.fusions[node.fusion.value];
    if (node.tokens != set.tokens)
      out_.error("E402", span,
                 "place '" + node.name + "' starts with " + std::to_string(node.tokens) +
                     " tokens, its fusion set '" + set.name + "' with " + std::to_string(set.tokens));
    if (node.operation.kind != Operation::Kind::none && operations_[node.fusion.value]++ > 0)
      out_.error("E403", span, "two members of fusion set '" + set.name + "' have an operation");
  }

  [[nodiscard]] const std::string& name(std::uint32_t page) const { return net_.pages[page].name; }

  const HierarchicalNet& net_;
  diagnostics::Diagnostics& out_;
  std::vector<std::uint32_t> reached_;     // per page: how many nodes refer to it
  std::vector<std::uint32_t> operations_;  // per fusion set: how many members have one
};

/// Builds the flat net of an examined hierarchy.
class Flattening {
 public:
  explicit Flattening(const HierarchicalNet& net) : net_(net) {}

  Net result() {
    flat_ = Net(std::make_shared<const Parts>(net_.parts));
    first_node_.reserve(net_.pages.size());
    std::uint32_t nodes = 0;
    for (const Page& page : net_.pages) {
      first_node_.push_back(nodes);
      nodes += static_cast<std::uint32_t>(page.nodes.size());
    }
    place_of_.resize(nodes);
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page) add_places(PageId{page});
    fuse();
    seen_.assign(flat_.places().size(), {0, 0});
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page) add_transitions(PageId{page});
    return std::move(flat_);
  }

 private:
  void add_places(PageId id) {
    const Page& page = net_.pages[id.value];
    const std::string above = page.parent.valid() ? prefix_[page.parent.value] : std::string{};
    prefix_.push_back(page.parent.valid() ? above + page.name + '.' : std::string{});
    for (std::uint32_t node = 0; node < page.nodes.size(); ++node) {
      const Node& drawn = page.nodes[node];
      if (drawn.page.valid() || drawn.fusion.valid()) continue;
      place_of_[first_node_[id.value] + node] = flat_.add(Place{.name = prefix_.back() + drawn.name,
                                                                .tokens = drawn.tokens,
                                                                .operation = drawn.operation,
                                                                .layer = page.layer,
                                                                .page = id,
                                                                .subsystem = page.subsystem,
                                                                .span = page.span,
                                                                .role = drawn.role,
                                                                .agent = page.agent,
                                                                .behaviour = page.behaviour,
                                                                .block = drawn.block});
    }
  }

  /// One place per fusion set that has members.
  void fuse() {
    std::vector<std::vector<std::uint32_t>> members(net_.fusions.size());
    std::vector<Operation> operations(net_.fusions.size());
    for (std::uint32_t page = 0; page < net_.pages.size(); ++page)
      for (std::uint32_t node = 0; node < net_.pages[page].nodes.size(); ++node) {
        const Node& drawn = net_.pages[page].nodes[node];
        if (!drawn.fusion.valid()) continue;
        members[drawn.fusion.value].push_back(first_node_[page] + node);
        if (drawn.operation.kind != Operation::Kind::none) operations[drawn.fusion.value] = drawn.operation;
      }
    for (std::size_t set = 0; set < members.size(); ++set) {
      if (members[set].empty()) continue;
      const FusionSet& fusion = net_.fusions[set];
      const SubsystemId owner = fusion.fact.valid() ? net_.parts[fusion.fact].subsystem : SubsystemId{};
      const PlaceId place = flat_.add(Place{.name = fusion.name,
                                            .tokens = fusion.tokens,
                                            .operation = operations[set],
                                            .layer = owner.valid() ? Layer::subsystem : Layer::communication,
                                            .page = {},
                                            .subsystem = owner,
                                            .channel = fusion.channel,
                                            .span = fusion.span,
                                            .role = fusion.role,
                                            .agent = owner.valid() ? net_.parts[owner].agent : AgentId{},
                                            .fact = fusion.fact,
                                            .value = fusion.value});
      for (const std::uint32_t member : members[set]) place_of_[member] = place;
    }
  }

  void add_transitions(PageId id) {
    const Page& page = net_.pages[id.value];
    for (const PageTransition& drawn : page.transitions) {
      collect(id, drawn.inputs, &Page::output, inputs_);
      collect(id, drawn.outputs, &Page::input, outputs_);
      flat_.add(Transition{.name = prefix_[id.value] + drawn.name,
                           .condition = drawn.condition,
                           .layer = page.layer,
                           .page = id,
                           .subsystem = page.subsystem,
                           .span = drawn.span,
                           .role = drawn.role,
                           .agent = page.agent,
                           .behaviour = page.behaviour,
                           .block = drawn.block},
                inputs_, outputs_);
    }
  }

  /// The arcs from or to the given nodes. Arcs whose places were fused into one become one heavier arc.
  void collect(PageId page, const std::vector<std::uint32_t>& ends, std::uint32_t Page::*port,
               std::vector<Arc>& arcs) {
    arcs.clear();
    ++collection_;
    for (const std::uint32_t end : ends) {
      const PlaceId place = resolve(page, end, port);
      auto& [collection, arc] = seen_[place.value];
      if (collection == collection_) {
        ++arcs[arc].weight;
      } else {
        collection = collection_;
        arc = static_cast<std::uint32_t>(arcs.size());
        arcs.push_back({place, 1});
      }
    }
  }

  /// The place behind a node. For a page, it is the place at its port; the net may again be entered
  /// through a page.
  [[nodiscard]] PlaceId resolve(PageId page, std::uint32_t node, std::uint32_t Page::*port) const {
    while (net_.pages[page.value].nodes[node].page.valid()) {
      page = net_.pages[page.value].nodes[node].page;
      node = net_.pages[page.value].*port;
    }
    return place_of_[first_node_[page.value] + node];
  }

  struct Seen {
    std::uint32_t collection = 0, arc = 0;
  };

  const HierarchicalNet& net_;
  Net flat_;
  std::vector<std::string> prefix_;        // per page: its path and a full stop
  std::vector<std::uint32_t> first_node_;  // per page, into place_of_
  std::vector<PlaceId> place_of_;          // per node of every page
  std::vector<Arc> inputs_, outputs_;
  std::vector<Seen> seen_;  // per place: the last collection that had it, and its arc there
  std::uint32_t collection_ = 0;
};

}  // namespace

std::optional<Net> flatten(const HierarchicalNet& net, diagnostics::Diagnostics& out) {
  if (!Examination(net, out).passes()) return std::nullopt;
  return Flattening(net).result();
}

}  // namespace tessera::net
