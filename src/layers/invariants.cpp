#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "layers/built_in.hpp"
#include "layers/known_facts.hpp"
#include "layers/layers.hpp"
#include "layers/pair_invariants.hpp"

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
    for (; next.value < net.places().size(); ++next.value)
      (net[next].fused() ? fused_ : facts_).push_back(next);
  }

  [[nodiscard]] std::span<const PlaceId> of(net::PageId page) const { return of_page_[page.value]; }
  [[nodiscard]] PlaceId input(net::PageId page) const { return of(page)[pages_.pages[page.value].input]; }
  [[nodiscard]] PlaceId output(net::PageId page) const { return of(page)[pages_.pages[page.value].output]; }
  [[nodiscard]] const std::vector<PlaceId>& fused() const { return fused_; }
  /// Those of the facts, which follow one another.
  [[nodiscard]] const std::vector<PlaceId>& facts() const { return facts_; }

 private:
  const net::HierarchicalNet& pages_;
  std::vector<std::vector<PlaceId>> of_page_;
  std::vector<PlaceId> fused_, facts_;
};

/// One of the values of each fact holds.
std::vector<Invariant> of_facts(const net::Net& net, const Places& places) {
  std::vector<Invariant> all;
  net::FactId last;
  for (const PlaceId place : places.facts()) {
    const net::Parts::Fact& fact = net.parts()[net[place].fact];
    if (std::exchange(last, net[place].fact) != net[place].fact)
      all.push_back({"one value of " + fact.name + " in " + net.parts()[fact.subsystem].path, {}, 1});
    all.back().terms.push_back({place});
  }
  return all;
}

/// The places of a communication page: those outside any branch, and those of each branch of
/// a parallel transfer.
struct Branches {
  Nodes trunk;
  std::vector<Nodes> branches;  ///< empty unless the page forks
};

/// A transition forks if several of its outputs are no fused places, and joins if several of its inputs are
/// none. Without these transitions, the page falls into connected parts: the branches.
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
    if (outputs.size() != 1 || inputs.size() != 1) continue;
    neighbours[inputs.front()].push_back(outputs.front());
    // A send whose condition never holds has places that no transition leads to.
    neighbours[outputs.front()].push_back(inputs.front());
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

/// One token per subsystem, wherever it is: still above, in the subsystem, or waiting above for the others
/// to end. In a parallel transfer it counts the first branch; `branches` says that the other branches
/// hold as much. The memory of a side over a network has no other guard than that token, so a branch with
/// such a block also gets an invariant that counts it in place of the first.
class Subsystems {
 public:
  Subsystems(const spec::Model& model, const net::HierarchicalNet& pages, const Places& places)
      : model_(model), pages_(pages), places_(places), tokens_(model.instances.size()) {}

  std::vector<Invariant> result() {
    for (std::uint32_t page = 0; page < pages_.pages.size(); ++page)
      if (pages_.pages[page].subsystem.valid()) gather(net::PageId{page});
    std::vector<Invariant> all = tokens_;
    for (const auto& [side, detours] : detours_) all.push_back(by_way_of(side, detours));
    for (Invariant& branch : branches_) all.push_back(std::move(branch));
    return all;
  }

 private:
  void gather(net::PageId id) {
    const net::Page& page = pages_.pages[id.value];
    Invariant& token = tokens_[page.subsystem.value];
    if (page.layer == net::Layer::subsystem && !page.is_group()) begin(id, token);
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
      for (const std::uint32_t node : found.branches[branch]) gather_detour(id, node, found, branch);
    }
  }

  /// A branch of a parallel transfer that counts in place of the first one of its page.
  struct Detour {
    net::PageId page;
    Nodes first, branch;
  };
  /// One side of a channel; those of several behaviours use one memory.
  using SideOfChannel = std::pair<net::ChannelId, bool>;

  void gather_detour(net::PageId id, std::uint32_t node, const Branches& found, std::size_t branch) {
    const net::Node& drawn = pages_.pages[id.value].nodes[node];
    if (!drawn.block.valid() || drawn.operation.kind == net::Operation::Kind::none) return;
    const net::Parts::Block& block = pages_.parts[drawn.block];
    if (!model_.crosses_processes(model_.channels[block.channel])) return;
    detours_[{block.channel, block.sends}].push_back({id, found.branches.front(), found.branches[branch]});
  }

  [[nodiscard]] Invariant by_way_of(const SideOfChannel& side, const std::vector<Detour>& detours) const {
    Invariant token = tokens_[pages_.pages[detours.front().page.value].subsystem.value];
    token.name += ", by the branches that " + std::string(side.second ? "send " : "receive ") +
                  pages_.parts[side.first];
    for (const Detour& detour : detours) {
      const auto places = places_.of(detour.page);
      std::erase_if(token.terms, [&](const Invariant::Term& term) {
        return std::ranges::any_of(detour.first,
                                   [&](std::uint32_t node) { return places[node] == term.place; });
      });
      add(token, places, detour.branch);
    }
    return token;
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

  const spec::Model& model_;
  const net::HierarchicalNet& pages_;
  const Places& places_;
  std::map<SideOfChannel, std::vector<Detour>> detours_;
  std::vector<Invariant> tokens_;    // per instance
  std::vector<Invariant> branches_;  // second and later branches
};

/// The invariants of the memory of each channel by its model, summed over all behaviours that use it. The
/// first ones state that one of several places is marked; the others state how many tokens places of both
/// sides hold together.
class Channels {
 public:
  Channels(const spec::Model& model, const net::HierarchicalNet& pages, const net::Net& net,
           const Places& places)
      : model_(model), pages_(pages), net_(net), places_(places), of_channel_(model.channels.size()) {}

  std::vector<Invariant> result() {
    for (const PlaceId place : places_.fused()) gather_fused(place);
    for (std::uint32_t page = 0; page < pages_.pages.size(); ++page)
      if (pages_.pages[page].layer == net::Layer::communication) gather(net::PageId{page});
    std::vector<Invariant> units, sums;
    for (Gathered& channel : of_channel_)
      for (std::size_t index = 0; index < channel.invariants.size(); ++index)
        ((*channel.known)[index].is_unit() ? units : sums).push_back(std::move(channel.invariants[index]));
    std::ranges::move(sums, std::back_inserter(units));
    return units;
  }

 private:
  struct Gathered {
    const spec::CommunicationModel* model = nullptr;
    const std::vector<PairInvariant>* known = nullptr;
    std::vector<Invariant> invariants;  // as known
    std::uint32_t shared = 0;           // places gathered
  };

  Gathered& at(net::ChannelId id) {
    Gathered& gathered = of_channel_[id.value];
    if (gathered.model != nullptr) return gathered;
    const spec::Channel& channel = model_.channels[id];
    gathered.model = &model_of(model_, channel);
    const auto [known, added] = known_.try_emplace(gathered.model);
    if (added) known->second = pair_invariants(*gathered.model);
    gathered.known = &known->second;
    const std::string name = model_.channel_name(channel);
    for (const PairInvariant& invariant : known->second)
      gathered.invariants.push_back(
          {in_words(invariant, *gathered.model) + " in " + name, {}, invariant.total});
    return gathered;
  }

  /// "one of empty, full, send.2, receive.2", "full + receive.2 + ack - send.wait".
  static std::string in_words(const PairInvariant& invariant, const spec::CommunicationModel& model) {
    std::string more, less;
    const bool unit = invariant.is_unit();
    const auto count = [&](std::int32_t weight, const std::string& name) {
      const std::int32_t size = std::abs(weight);
      const std::string term = (size == 1 ? "" : std::to_string(size) + " ") + name;
      if (weight > 0) more += (more.empty() ? "" : unit ? ", " : " + ") + term;
      if (weight < 0) less += " - " + term;
    };
    for (std::size_t place = 0; place < model.shared.size(); ++place)
      count(invariant.shared[place], model.shared[place].name);
    for (std::size_t place = 0; place < model.send.places.size(); ++place)
      count(invariant.send[place], "send." + model.send.places[place].name);
    for (std::size_t place = 0; place < model.receive.places.size(); ++place)
      count(invariant.receive[place], "receive." + model.receive.places[place].name);
    return (unit ? "one of " : "") + more + less;
  }

  /// Fused places follow one another, channel by channel, as the model has them, without those that nobody
  /// uses.
  void gather_fused(PlaceId place) {
    Gathered& channel = at(net_[place].channel);
    const std::vector<spec::SharedPlace>& shared = channel.model->shared;
    while (channel.shared < shared.size() && role_of(shared[channel.shared]) != net_[place].role)
      ++channel.shared;
    for (std::size_t index = 0; index < channel.invariants.size(); ++index)
      add_term(channel.invariants[index], place, (*channel.known)[index].shared[channel.shared]);
    ++channel.shared;
  }

  void gather(net::PageId id) {
    const std::vector<net::Node>& nodes = pages_.pages[id.value].nodes;
    const auto places = places_.of(id);
    net::BlockId drawn;
    std::size_t number = 0;
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
      if (nodes[node].fusion.valid() || !nodes[node].block.valid()) continue;
      // A block draws the places of its side in their order, and its output last.
      if (std::exchange(drawn, nodes[node].block) != nodes[node].block) number = spec::ModelSide::out + 1;
      const net::Parts::Block& block = pages_.parts[drawn];
      gather_own(at(block.channel), block.sends, number++, places[node]);
    }
  }

  static void gather_own(Gathered& channel, bool sends, std::size_t number, PlaceId place) {
    if (number >= (sends ? channel.model->send : channel.model->receive).places.size()) return;
    for (std::size_t index = 0; index < channel.invariants.size(); ++index) {
      const PairInvariant& known = (*channel.known)[index];
      add_term(channel.invariants[index], place, (sends ? known.send : known.receive)[number]);
    }
  }

  static void add_term(Invariant& invariant, PlaceId place, std::int32_t weight) {
    if (weight != 0) invariant.terms.push_back({place, weight});
  }

  const spec::Model& model_;
  const net::HierarchicalNet& pages_;
  const net::Net& net_;
  const Places& places_;
  std::unordered_map<const spec::CommunicationModel*, std::vector<PairInvariant>> known_;
  std::vector<Gathered> of_channel_;
};

}  // namespace

std::vector<Invariant> invariants(const spec::Model& model, const net::HierarchicalNet& pages,
                                  const net::Net& net) {
  const Places places(pages, net);
  std::vector<Invariant> all = Subsystems(model, pages, places).result();
  const std::vector<Invariant> of_memory = memory_invariants(model, pages, net, all);
  for (Invariant& invariant : Channels(model, pages, net, places).result())
    all.push_back(std::move(invariant));
  for (Invariant& invariant : of_facts(net, places)) all.push_back(std::move(invariant));
  all.insert(all.end(), of_memory.begin(), of_memory.end());
  return all;
}

}  // namespace tessera::layers
