#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "explore/formula.hpp"
#include "net/net.hpp"

/// The markings that the properties sound_pages and exclusive_channels rule out.
namespace tessera::verify {

/// A page in terms of the flat net.
struct PagePlaces {
  net::PlaceId in, out;           ///< invalid: the page has none of its own
  std::vector<net::PlaceId> all;  ///< those of the pages in it too
};
[[nodiscard]] std::vector<PagePlaces> places_of_pages(const net::HierarchicalNet& pages, const net::Net& net);

/// The page is entered while it is in use, or left while it is.
[[nodiscard]] explore::Formula unsound(const PagePlaces& page);

/// Shared memory, a slot of a channel: the places that write to it and those that read from it.
struct SharedMemory {
  std::vector<net::PlaceId> writes, reads;

  /// Tells it from the others: its first place.
  [[nodiscard]] std::uint32_t id() const;
};
[[nodiscard]] std::vector<SharedMemory> shared_memories(const net::Net& net);

/// Two tokens write or read at once.
[[nodiscard]] explore::Formula used_twice(const SharedMemory& memory);

}  // namespace tessera::verify
