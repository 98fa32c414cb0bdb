#include "verify/invariants/covered.hpp"

#include <algorithm>
#include <iterator>

#include "verify/invariants/forbidden.hpp"

namespace tessera::verify {
namespace {

using net::PlaceId;
using Numbers = std::vector<std::uint32_t>;

Numbers both(const Numbers& a, const Numbers& b) {
  Numbers result;
  std::ranges::set_intersection(a, b, std::back_inserter(result));
  return result;
}

}  // namespace

std::vector<Gap> uncovered_pages(const net::HierarchicalNet& pages, const net::Net& net,
                                 const UnitInvariants& units) {
  std::vector<Gap> gaps;
  const std::vector<PagePlaces> all = places_of_pages(pages, net);
  for (std::uint32_t index = 0; index < all.size(); ++index) {
    const PagePlaces& page = all[index];
    const Numbers shared = both(units.of(page.in), units.of(page.out));
    const auto apart = [&](PlaceId place) {
      return std::ranges::any_of(
          units.of(place), [&](std::uint32_t unit) { return std::ranges::binary_search(shared, unit); });
    };
    const auto loose = std::ranges::find_if_not(page.all, apart);
    if (loose == page.all.end()) continue;
    gaps.push_back({index, "no invariant keeps '" + net[*loose].name + "' empty when page '" +
                               pages.path({index}) + "' is left"});
  }
  return gaps;
}

std::vector<Gap> uncovered_memories(const net::Net& net, const UnitInvariants& units) {
  std::vector<Gap> gaps;
  for (const SharedMemory& memory : shared_memories(net)) {
    std::vector<PlaceId> places = memory.writes;
    places.insert(places.end(), memory.reads.begin(), memory.reads.end());
    Numbers common = units.of(places.front());
    for (const PlaceId place : places) {
      common = both(common, units.of(place));
      if (!common.empty()) continue;
      gaps.push_back({memory.id(), "no invariant keeps '" + net[place].name +
                                       "' apart from the other side of its channel"});
      break;
    }
  }
  return gaps;
}

}  // namespace tessera::verify
