#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "verify/invariants/unit_invariants.hpp"

/// The pages and channels that place invariants do not settle.
namespace tessera::verify {

/// Something that the invariants do not settle.
struct Gap {
  std::uint32_t subject = 0;
  std::string why;
};

/// The pages with a place that no unit invariant excludes from being marked together with the input or output
/// of the page. Empty: every page is entered once at a time and left empty. Linear in the net times the depth
/// of its pages.
[[nodiscard]] std::vector<Gap> uncovered_pages(const net::HierarchicalNet& pages, const net::Net& net,
                                               const UnitInvariants& units);

/// The memories (forbidden.hpp) whose writes and reads no unit invariant excludes from each other. Linear.
[[nodiscard]] std::vector<Gap> uncovered_memories(const net::Net& net, const UnitInvariants& units);

}  // namespace tessera::verify
