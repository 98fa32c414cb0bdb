#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "net/net.hpp"

/// Naive explorers, written for clearness: oracles for everything faster.
namespace tessera::test {

using Marking = std::vector<std::uint32_t>;

struct Exploration {
  std::set<Marking> markings;
  bool complete = true;  ///< false: the limit was reached
};

/// Breadth first over the flat net; conditions are free choices.
Exploration explore(const net::Net& net, std::size_t limit);

/// The same by the token game of the hierarchy itself: markings of pages' nodes, never flattened.
Exploration explore(const net::HierarchicalNet& net, std::size_t limit);

/// The marked places by name, "name" or "name*2": comparable between both.
std::set<std::string> marked(const net::Net& net, const Marking& marking);
std::set<std::string> marked(const net::HierarchicalNet& net, const Marking& marking);

}  // namespace tessera::test
