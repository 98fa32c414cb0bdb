#include "verify/invariants/forbidden.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace tessera::verify {

using explore::Formula;
using net::PageId;
using net::PlaceId;

namespace {

/// Two tokens in the one place, or one there and one in another.
Formula with_company(PlaceId place, const std::vector<PlaceId>& others) {
  std::vector<Formula> company;
  for (const PlaceId other : others)
    if (other != place) company.push_back(Formula::marked(other));
  return Formula::any({Formula::at_least(place, 2),
                       Formula::all({Formula::marked(place), Formula::any(std::move(company))})});
}

}  // namespace

std::vector<PagePlaces> places_of_pages(const net::HierarchicalNet& pages, const net::Net& net) {
  std::vector<PagePlaces> places(pages.pages.size());
  std::vector<std::string> in(places.size()), out(places.size());
  for (std::uint32_t page = 0; page < places.size(); ++page) {
    const net::Page& drawn = pages.pages[page];
    const std::string path = pages.path({page});
    const std::string prefix = path.empty() ? "" : path + ".";
    in[page] = prefix + drawn.nodes[drawn.input].name;
    out[page] = prefix + drawn.nodes[drawn.output].name;
  }
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    const net::Place& place = net.places()[index];
    if (place.page.valid() && place.name == in[place.page.value]) places[place.page.value].in = {index};
    if (place.page.valid() && place.name == out[place.page.value]) places[place.page.value].out = {index};
    for (PageId page = place.page; page.valid(); page = pages.pages[page.value].parent)
      places[page.value].all.push_back({index});
  }
  return places;
}

Formula unsound(const PagePlaces& page) {
  return Formula::any({with_company(page.in, page.all), with_company(page.out, page.all)});
}

std::uint32_t SharedMemory::id() const {
  PlaceId first;  // none: it comes after all others
  for (const std::vector<PlaceId>* places : {&writes, &reads})
    if (!places->empty()) first = std::min(first, places->front());
  return first.value;
}

std::vector<SharedMemory> shared_memories(const net::Net& net) {
  std::map<std::pair<net::ChannelId, std::uint32_t>, SharedMemory> memories;  // by channel and slot
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    const net::Operation& operation = net.places()[index].operation;
    const std::pair memory(operation.channel, operation.slot);
    if (operation.kind == net::Operation::Kind::write) memories[memory].writes.push_back({index});
    if (operation.kind == net::Operation::Kind::read) memories[memory].reads.push_back({index});
  }
  std::vector<SharedMemory> all;
  for (auto& [channel_and_slot, memory] : memories) all.push_back(std::move(memory));
  return all;
}

Formula used_twice(const SharedMemory& memory) {
  std::vector<PlaceId> all = memory.writes;
  all.insert(all.end(), memory.reads.begin(), memory.reads.end());
  std::vector<Formula> ways;
  while (!all.empty()) {
    const PlaceId place = all.back();
    ways.push_back(with_company(place, all));
    all.pop_back();
  }
  return Formula::any(std::move(ways));
}

}  // namespace tessera::verify
