#include "server/recordings/marking_tracker.hpp"

#include <algorithm>

namespace tessera::server {

MarkingTracker::MarkingTracker(const net::Net& net) : net_(net) {
  for (const net::Place& place : net.places()) tokens_.push_back(static_cast<std::int32_t>(place.tokens));
}

void MarkingTracker::fire(net::TransitionId id) {
  for (const net::Arc& arc : net_.preset(id))
    tokens_[arc.place.value] -= static_cast<std::int32_t>(arc.weight);
  for (const net::Arc& arc : net_.postset(id))
    tokens_[arc.place.value] += static_cast<std::int32_t>(arc.weight);
}

void MarkingTracker::set(std::span<const net::PlaceId> places) {
  std::ranges::fill(tokens_, 0);
  for (const net::PlaceId place : places) tokens_[place.value] = 1;
}

std::vector<std::uint32_t> MarkingTracker::marked() const {
  std::vector<std::uint32_t> marked;
  for (std::uint32_t place = 0; place < tokens_.size(); ++place)
    if (tokens_[place] > 0) marked.push_back(place);
  return marked;
}

}  // namespace tessera::server
