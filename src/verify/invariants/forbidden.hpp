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
  net::PlaceId in, out;           ///< invalid: the page has none
  std::vector<net::PlaceId> all;  ///< including those of the pages in it
};
[[nodiscard]] std::vector<PagePlaces> places_of_pages(const net::HierarchicalNet& pages, const net::Net& net);

/// The page is entered while it is in use, or left while it is still in use.
[[nodiscard]] explore::Formula unsound(const PagePlaces& page);

/// Shared memory, a slot of a channel: the places that write to it and those that read from it.
struct SharedMemory {
  std::vector<net::PlaceId> writes, reads;

  /// Its first place, which no other memory has.
  [[nodiscard]] std::uint32_t id() const;
};
[[nodiscard]] std::vector<SharedMemory> shared_memories(const net::Net& net);

/// Two tokens write or read the memory at once.
[[nodiscard]] explore::Formula used_twice(const SharedMemory& memory);

}  // namespace tessera::verify
