#include <span>
#include <string>
#include <vector>

#include "layers/layers.hpp"

namespace tessera::layers {
namespace {

using net::Invariant;
using net::PlaceId;
using Nodes = std::vector<std::uint32_t>;

/// The flat places of the nodes of each page. Flattening keeps the order of pages and of nodes.
class Places {
 public:
  Places(const net::HierarchicalNet& pages, const net::Net& net) : pages_(pages) {
    PlaceId next{0};
    for (const net::Page& page : pages.pages) {
      std::vector<PlaceId>& places = of_page_.emplace_back();
      for (const net::Node& node : page.nodes)
        places.push_back(node.page.valid() || node.fusion.valid() ? PlaceId{} : PlaceId{next.value++});
    }
    for (; next.value < net.places().size(); ++next.value) fused_.push_back(next);
  }

  [[nodiscard]] std::span<const PlaceId> of(net::PageId page) const { return of_page_[page.value]; }
  [[nodiscard]] PlaceId input(net::PageId page) const { return of(page)[pages_.pages[page.value].input]; }
  [[nodiscard]] PlaceId output(net::PageId page) const { return of(page)[pages_.pages[page.value].output]; }
  [[nodiscard]] const std::vector<PlaceId>& fused() const { return fused_; }

 private:
  const net::HierarchicalNet& pages_;
  std::vector<std::vector<PlaceId>> of_page_;
  std::vector<PlaceId> fused_;
};

/// The places of a communication page: those outside any branch, and those of each branch of a parallel
/// transfer.
struct Branches {
  Nodes trunk;
  std::vector<Nodes> branches;  ///< empty unless the page forks
};

/// A transition that has several outputs which are no fused places forks, one with several such inputs joins;
/// what is connected without them is a branch.
Branches branches_of(const net::Page& page) {
  const auto own = [&](const Nodes& ends) {
    Nodes kept;
    for (const std::uint32_t end : ends)
      if (!page.nodes[end].fusion.valid()) kept.push_back(end);
    return kept;
  };
  std::vector<Nodes> neighbours(page.nodes.size());
  Nodes starts;
  for (const net::PageTransition& transition : page.transitions) {
    const Nodes inputs = own(transition.inputs), outputs = own(transition.outputs);
    if (outputs.size() > 1) starts = outputs;
    if (outputs.size() == 1 && inputs.size() == 1) neighbours[inputs.front()].push_back(outputs.front());
  }
  Branches found;
  std::vector<bool> seen(page.nodes.size(), false);
  for (const std::uint32_t start : starts) {
    Nodes branch{start};
    seen[start] = true;
    for (std::size_t at = 0; at < branch.size(); ++at)
      for (const std::uint32_t next : neighbours[branch[at]])
        if (!seen[next]) {
          seen[next] = true;
          branch.push_back(next);
        }
    found.branches.push_back(std::move(branch));
  }
  for (std::uint32_t node = 0; node < page.nodes.size(); ++node)
    if (!seen[node] && !page.nodes[node].fusion.valid() && !page.nodes[node].page.valid())
      found.trunk.push_back(node);
  return found;
}

void add(Invariant& invariant, std::span<const PlaceId> places, const Nodes& nodes, std::int32_t weight = 1) {
  for (const std::uint32_t node : nodes) invariant.terms.push_back({places[node], weight});
}

/// One token per subsystem, wherever it is: still above, in the subsystem, or waiting above for the others to
/// end. Of the branches of a parallel transfer it counts the first; `branches` says that the others hold as
/// much.
class Subsystems {
 public:
  Subsystems(const net::HierarchicalNet& pages, const Places& places, std::size_t instances)
      : pages_(pages), places_(places), tokens_(instances) {}

  std::vector<Invariant> result() {
    for (std::uint32_t page = 0; page < pages_.pages.size(); ++page)
      if (pages_.pages[page].subsystem != net::no_subsystem) gather(net::PageId{page});
    std::vector<Invariant> all = std::move(tokens_);
    for (Invariant& branch : branches_) all.push_back(std::move(branch));
    return all;
  }

 private:
  void gather(net::PageId id) {
    const net::Page& page = pages_.pages[id.value];
    Invariant& token = tokens_[page.subsystem];
    if (page.layer == net::Layer::subsystem) begin(id, token);
    const auto places = places_.of(id);
    const Branches found = branches_of(page);
    add(token, places, found.trunk);
    if (found.branches.empty()) return;
    add(token, places, found.branches.front());
    for (std::size_t branch = 1; branch < found.branches.size(); ++branch) {
      Invariant equal{
          "branch " + std::to_string(branch + 1) + " of " + pages_.path(id) + " holds as much as branch 1",
          {},
          0};
      add(equal, places, found.branches[branch]);
      add(equal, places, found.branches.front(), -1);
      branches_.push_back(std::move(equal));
    }
  }

  void begin(net::PageId id, Invariant& token) const {
    token.name = "one token in " + pages_.path(id);
    token.total = 1;
    for (net::PageId above = pages_.pages[id.value].parent; above.valid();
         above = pages_.pages[above.value].parent) {
      token.terms.push_back({places_.input(above)});
      token.terms.push_back({places_.output(above)});
    }
  }

  const net::HierarchicalNet& pages_;
  const Places& places_;
  std::vector<Invariant> tokens_;    // per instance
  std::vector<Invariant> branches_;  // second and later branches
};

/// Per channel: its memory is free, full, or in use by one side. And with an acknowledgement: a value that a
/// waiting producer has sent is unread, being read, or acknowledged.
class Channels {
 public:
  Channels(const spec::Model& model, const net::HierarchicalNet& pages, const net::Net& net,
           const Places& places)
      : pages_(pages),
        net_(net),
        places_(places),
        memory_(model.channels.size()),
        acknowledged_(model.channels.size()) {
    for (spec::Index channel = 0; channel < model.channels.size(); ++channel) {
      const std::string name = model.channel_name(model.channels[channel]);
      memory_[channel] = {"one side at a time in " + name, {}, 1};
      acknowledged_[channel] = {"one acknowledgement per value of " + name, {}, 0};
      blocks_.push_back(model.channels[channel].send == spec::Mode::blocking);
    }
  }

  std::vector<Invariant> result() {
    for (const PlaceId place : places_.fused()) gather_fused(place);
    for (std::uint32_t page = 0; page < pages_.pages.size(); ++page)
      if (pages_.pages[page].layer == net::Layer::communication) gather(net::PageId{page});
    std::vector<Invariant> all;
    for (auto* invariants : {&memory_, &acknowledged_})
      for (Invariant& invariant : *invariants)
        if (!invariant.terms.empty()) all.push_back(std::move(invariant));
    return all;
  }

 private:
  void gather_fused(PlaceId place) {
    const std::uint32_t channel = net_[place].channel;
    const bool acknowledges = net_[place].name.ends_with(".ack");
    if (!acknowledges) memory_[channel].terms.push_back({place});
    if (acknowledges || (blocks_[channel] && net_[place].name.ends_with(".full")))
      acknowledged_[channel].terms.push_back({place});
  }

  void gather(net::PageId id) {
    const net::Page& page = pages_.pages[id.value];
    const auto places = places_.of(id);
    for (std::uint32_t node = 0; node < page.nodes.size(); ++node) {
      const net::Operation& operation = page.nodes[node].operation;
      if (operation.kind == net::Operation::Kind::none) continue;
      memory_[operation.subject].terms.push_back({places[node]});
      if (operation.kind == net::Operation::Kind::read && blocks_[operation.subject])
        acknowledged_[operation.subject].terms.push_back({places[node]});
    }
    for (const net::PageTransition& transition : page.transitions) gather_wait(page, transition, places);
  }

  /// What is taken together with an acknowledgement is the wait for it.
  void gather_wait(const net::Page& page, const net::PageTransition& transition,
                   std::span<const PlaceId> places) {
    std::uint32_t channel = UINT32_MAX;
    for (const std::uint32_t input : transition.inputs)
      if (const net::FusionId set = page.nodes[input].fusion;
          set.valid() && pages_.fusions[set.value].name.ends_with(".ack"))
        channel = pages_.fusions[set.value].channel;
    if (channel == UINT32_MAX) return;
    for (const std::uint32_t input : transition.inputs)
      if (!page.nodes[input].fusion.valid()) acknowledged_[channel].terms.push_back({places[input], -1});
  }

  const net::HierarchicalNet& pages_;
  const net::Net& net_;
  const Places& places_;
  std::vector<Invariant> memory_, acknowledged_;  // per channel
  std::vector<bool> blocks_;                      // per channel: does the producer?
};

}  // namespace

std::vector<Invariant> invariants(const spec::Model& model, const net::HierarchicalNet& pages,
                                  const net::Net& net) {
  const Places places(pages, net);
  std::vector<Invariant> all = Subsystems(pages, places, model.instances.size()).result();
  for (Invariant& invariant : Channels(model, pages, net, places).result())
    all.push_back(std::move(invariant));
  return all;
}

}  // namespace tessera::layers
