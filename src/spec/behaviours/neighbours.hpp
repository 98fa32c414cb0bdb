#pragma once

#include <cstdint>
#include <vector>

#include "spec/document/families.hpp"
#include "spec/model/model.hpp"

/// Entries of `next` that lead from a behaviour `for: each robot` to that of another member: "poll[i+1]".
namespace tessera::spec {

/// An entry whose end is a neighbour, in a fleet that is no ring. Not every member has one.
struct NeighbourEntry {
  std::uint32_t entry = 0;  ///< of `next`
  IndexedName name;
  EachMember each;
  bool exists = false;  ///< for the member that is read
};

/// Leaves one of the entries "poll[i+1]", "poll[0]": the first one if the member has it, else the one behind it. So
/// the lists of all members have the same form.
///
/// neighbours: in the order of `next`, all entries of which have been read.
/// Errors: E289 such an entry has a condition, or none without a condition stands behind it.
void choose_neighbours(const std::vector<NeighbourEntry>& neighbours, Behaviour& behaviour, Diagnostics& out);

}  // namespace tessera::spec
