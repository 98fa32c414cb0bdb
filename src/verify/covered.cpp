#include "verify/covered.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace tessera::verify {
namespace {

using net::PageId;
using net::PlaceId;
using Numbers = std::vector<std::uint32_t>;

bool is_unit(const net::Invariant& invariant) {
  return invariant.total >= 0 && invariant.total <= 1 &&
         std::ranges::all_of(invariant.terms, [](const auto& term) { return term.weight > 0; });
}

/// Per place the unit invariants that count it, in ascending order.
std::vector<Numbers> units_of_places(const net::Net& net, const std::vector<net::Invariant>& invariants) {
  std::vector<Numbers> units(net.places().size());
  for (std::uint32_t index = 0; index < invariants.size(); ++index) {
    if (!is_unit(invariants[index])) continue;
    for (const auto& term : invariants[index].terms)
      if (units[term.place.value].empty() || units[term.place.value].back() != index)
        units[term.place.value].push_back(index);
  }
  return units;
}

Numbers both(const Numbers& a, const Numbers& b) {
  Numbers result;
  std::ranges::set_intersection(a, b, std::back_inserter(result));
  return result;
}

/// The flat places of each page's own nodes.
std::vector<std::vector<PlaceId>> places_of_pages(const net::HierarchicalNet& pages, const net::Net& net) {
  std::vector<std::vector<PlaceId>> places(pages.pages.size());
  for (std::uint32_t index = 0; index < net.places().size(); ++index)
    if (net.places()[index].page.valid()) places[net.places()[index].page.value].push_back({index});
  return places;
}

/// Input and output of a page among its own places.
struct Ends {
  PlaceId in, out;
};
Ends ends_of(const net::Page& page, const net::Net& net, const std::vector<PlaceId>& own) {
  Ends ends;
  const std::string& in = page.nodes[page.input].name;
  const std::string& out = page.nodes[page.output].name;
  for (const PlaceId place : own) {
    const std::string& name = net[place].name;
    const auto is = [&](const std::string& local) { return name == local || name.ends_with("." + local); };
    if (!ends.in.valid() && is(in)) ends.in = place;
    if (is(out)) ends.out = place;
  }
  return ends;
}

}  // namespace

std::string unsound_page(const net::HierarchicalNet& pages, const net::Net& net,
                         const std::vector<net::Invariant>& invariants) {
  const std::vector<Numbers> units = units_of_places(net, invariants);
  const std::vector<std::vector<PlaceId>> own = places_of_pages(pages, net);
  std::vector<Ends> ends;
  std::vector<Numbers> shared;  // by input and output of each page
  for (std::size_t page = 0; page < own.size(); ++page) {
    ends.push_back(ends_of(pages.pages[page], net, own[page]));
    if (!ends.back().in.valid() || !ends.back().out.valid())
      return "page '" + pages.path({static_cast<std::uint32_t>(page)}) + "' has no input or no output place";
    shared.push_back(both(units[ends.back().in.value], units[ends.back().out.value]));
  }
  for (std::uint32_t index = 0; index < net.places().size(); ++index)
    for (PageId page = net.places()[index].page; page.valid(); page = pages.pages[page.value].parent) {
      const bool apart = std::ranges::any_of(units[index], [&](std::uint32_t unit) {
        return std::ranges::binary_search(shared[page.value], unit);
      });
      if (!apart)
        return "no invariant keeps '" + net.places()[index].name + "' empty when page '" + pages.path(page) +
               "' is left";
    }
  return {};
}

std::string shared_memory(const net::Net& net, const std::vector<net::Invariant>& invariants) {
  const std::vector<Numbers> units = units_of_places(net, invariants);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Numbers> common;  // by channel and slot
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    const net::Operation& operation = net.places()[index].operation;
    if (operation.kind != net::Operation::Kind::write && operation.kind != net::Operation::Kind::read)
      continue;
    const auto [entry, added] = common.emplace(std::pair(operation.subject, operation.slot), units[index]);
    if (!added) entry->second = both(entry->second, units[index]);
    if (entry->second.empty())
      return "no invariant keeps '" + net.places()[index].name + "' apart from the other side of its channel";
  }
  return {};
}

}  // namespace tessera::verify
