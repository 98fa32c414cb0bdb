#include "ros2/codec/seen_requests.hpp"

#include <algorithm>

namespace tessera::ros2 {

bool SeenRequests::is_new(const RelatedIdentity& request) {
  if (clients_.size() >= most_clients && !clients_.contains(request.endpoint)) forget_oldest();
  const auto [known, first] = clients_.try_emplace(request.endpoint, Client{request.sequence});
  Client& client = known->second;
  client.turn = ++turns_;
  if (request.sequence > client.newest) {
    // A malformed number may be anything, so the difference is one of unsigned numbers.
    const std::uint64_t newer =
        static_cast<std::uint64_t>(request.sequence) - static_cast<std::uint64_t>(client.newest);
    client.seen = newer < window ? client.seen << static_cast<std::size_t>(newer) : std::bitset<window>();
    client.newest = request.sequence;
  }
  const std::uint64_t older =
      static_cast<std::uint64_t>(client.newest) - static_cast<std::uint64_t>(request.sequence);
  if (older >= window || client.seen.test(static_cast<std::size_t>(older))) return false;
  client.seen.set(static_cast<std::size_t>(older));
  return true;
}

void SeenRequests::forget_oldest() {
  const auto oldest = std::ranges::min_element(clients_, {}, [](const auto& one) { return one.second.turn; });
  if (oldest != clients_.end()) clients_.erase(oldest);
}

}  // namespace tessera::ros2
