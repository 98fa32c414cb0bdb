// Specifications of every feature at once, from a seed.
#pragma once

#include <cstdint>
#include <vector>

#include "specification.hpp"

namespace oracle {

/// The same numbers on every machine.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed);
  /// 0 .. below - 1
  int below(int bound);
  /// True so many times in a hundred.
  bool percent(int chance) { return below(100) < chance; }
  template <class T>
  const T& of(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(below(static_cast<int>(all.size())))];
  }

 private:
  std::uint64_t state_;
};

Specification random_specification(std::uint64_t seed);

/// Communication models: some sound, some spoilt by one change.
std::vector<Model> random_models(RandomNumbers& random);
/// Properties over the places that the net has.
std::vector<Property> random_properties(RandomNumbers& random, const Specification& specification);

/// Cells with few values, and what behaviours and entries of `next` do to them; none of it is refused.
void add_memory(RandomNumbers& random, Subsystem& subsystem);
/// A goal of one output and one input, which some of the behaviours order.
void add_goal(RandomNumbers& random, Subsystem& subsystem);
/// A comparison of a cell with a constant.
Asked random_question(RandomNumbers& random, const Cell& cell);
/// Properties about values of cells, and values where behaviours run; none if there are no cells.
std::vector<Property> properties_of_memory(RandomNumbers& random, const Specification& specification);

}  // namespace oracle
