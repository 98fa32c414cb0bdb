#include "layers/memory_invariants.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "layers/known_facts.hpp"

namespace tessera::layers {
namespace {

using net::Invariant;
using net::PlaceId;
using Terms = std::vector<Invariant::Term>;

/// A transition of the page of a subsystem, as one cell sees it.
struct Move {
  std::uint32_t to = 0;                       // node
  std::optional<std::uint32_t> takes, gives;  // values of the cell
};

/// The values that one cell can have at each node of the page of its subsystem.
class Reached {
 public:
  Reached(const net::HierarchicalNet& pages, const net::Page& page, net::FactId cell, std::size_t values)
      : moves_(page.nodes.size()), values_(page.nodes.size(), std::vector<bool>(values, false)) {
    const auto value = [&](std::uint32_t node) -> std::optional<std::uint32_t> {
      const net::Node& drawn = page.nodes[node];
      if (!drawn.fusion.valid() || pages.fusions[drawn.fusion.value].fact != cell) return std::nullopt;
      return pages.fusions[drawn.fusion.value].value;
    };
    for (const net::PageTransition& transition : page.transitions) {
      Move move;
      std::uint32_t from = 0;
      for (const std::uint32_t node : transition.inputs)
        if (const auto taken = value(node))
          move.takes = taken;
        else if (!page.nodes[node].fusion.valid())
          from = node;
      for (const std::uint32_t node : transition.outputs)
        if (const auto given = value(node))
          move.gives = given;
        else if (!page.nodes[node].fusion.valid())
          move.to = node;
      moves_[from].push_back(move);
    }
    reach(page.input, 0);
    while (!open_.empty()) {
      const auto [node, now] = open_.back();
      open_.pop_back();
      for (const Move& move : moves_[node])
        if (!move.takes || *move.takes == now) reach(move.to, move.gives.value_or(now));
    }
  }

  /// The nodes at which the cell has the value; empty: also another one at one of them, or none of them is a page.
  [[nodiscard]] std::vector<std::uint32_t> alone_at(std::uint32_t value, const net::Page& page) const {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t node = 0; node < values_.size(); ++node) {
      if (!values_[node][value]) continue;
      if (!page.nodes[node].page.valid() || std::ranges::count(values_[node], true) != 1) return {};
      nodes.push_back(node);
    }
    return nodes;
  }

 private:
  void reach(std::uint32_t node, std::uint32_t value) {
    if (values_[node][value]) return;
    values_[node][value] = true;
    open_.emplace_back(node, value);
  }

  std::vector<std::vector<Move>> moves_;   // per node
  std::vector<std::vector<bool>> values_;  // per node and value
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open_;
};

/// Per page of a behaviour of that subsystem, the places that its token may be at.
std::unordered_map<std::uint32_t, Terms> terms_of_pages(const net::HierarchicalNet& pages,
                                                        const net::Net& net, const Invariant& token,
                                                        net::PageId subsystem) {
  std::unordered_map<std::uint32_t, Terms> terms;
  for (const Invariant::Term& term : token.terms)
    for (net::PageId page = net[term.place].page; page.valid(); page = pages.pages[page.value].parent)
      if (pages.pages[page.value].parent == subsystem) terms[page.value].push_back(term);
  return terms;
}

}  // namespace

std::vector<Invariant> memory_invariants(const spec::Model& model, const net::HierarchicalNet& pages,
                                         const net::Net& net, const std::vector<Invariant>& tokens) {
  std::unordered_map<std::uint32_t, std::vector<PlaceId>> places;  // per fact
  for (std::uint32_t index = 0; index < net.places().size(); ++index)
    if (net.places()[index].fact.valid()) places[net.places()[index].fact.value].push_back({index});
  std::vector<Invariant> all;
  for (std::uint32_t number = 0; number < pages.pages.size(); ++number) {
    const net::Page& page = pages.pages[number];
    if (page.layer != net::Layer::subsystem) continue;
    const spec::Subsystem& subsystem = model.subsystem(page.subsystem);
    for (std::uint32_t id = 0; id < pages.parts.facts.size(); ++id) {
      const net::Parts::Fact& fact = pages.parts.facts[id];
      if (fact.kind != net::Parts::Fact::Kind::memory || fact.subsystem != page.subsystem) continue;
      const spec::FewValues& few = *subsystem.memory[fact.subject].few;
      if (few.member_count <= KnownFacts::most_members) continue;
      const Reached reached(pages, page, {id}, few.names.size());
      const auto terms = terms_of_pages(pages, net, tokens[page.subsystem.value], {number});
      for (std::uint32_t value = 1; value < few.names.size(); ++value) {
        const std::vector<std::uint32_t> nodes = reached.alone_at(value, page);
        if (nodes.empty()) continue;
        Invariant invariant{
            fact.name + " is " + few.names[value] + " in the behaviours of that value", {}, 1};
        for (const std::uint32_t node : nodes)
          if (const auto found = terms.find(page.nodes[node].page.value); found != terms.end())
            invariant.terms.insert(invariant.terms.end(), found->second.begin(), found->second.end());
        for (const PlaceId place : places[id])
          if (net[place].value != value) invariant.terms.push_back({place});
        all.push_back(std::move(invariant));
      }
    }
  }
  return all;
}

}  // namespace tessera::layers
