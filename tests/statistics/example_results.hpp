#pragma once

#include "statistics/results.hpp"

namespace tessera::statistics {

/// Seeds `begin` to `end` - 1 of 1 to 300, in three parts. The seeds that 10 divides fail.
inline Results example_results(std::uint64_t begin, std::uint64_t end) {
  Results results{
      .identity = {"rover", "s1", "n1", "c1", {{"for", "1s"}, {"set", "v=0.3"}}},
      .whole = {1, 301},
      .parts = 3,
      .ran = {},
      .tried = end - begin,
      .failed = 0,
      .simulated_s = static_cast<double>(end - begin),
      .wall_s = 0.5,
      .firings = 660 * (end - begin),
      .interrupted = false,
      .kinds = {{.kind = "assertion", .name = {}, .text = {}}, {.kind = "deadlock", .name = {}, .text = {}}},
      .outcomes = {{.kind = "assertion", .name = "nobody touches", .text = {}}},
      .failure = {},
      .not_repeated = {},
      .again = "tessera simulate rover --interleave --for 1s --seed",
      .transitions = {{"t_in", end - begin}}};
  if (begin < end) results.ran = {{begin, end}};
  std::uint64_t first = 0;
  for (std::uint64_t seed = begin; seed < end; ++seed) {
    if (seed % 10 != 0) continue;
    ++results.failed;
    if (first == 0) first = seed;
  }
  if (results.failed == 0) return results;
  results.outcomes.push_back(
      {"assertion", "robot.control", results.failed, results.failed, first, 0.25, "blind"});
  results.kinds[0] = {"assertion", "", results.failed, results.failed, first, 0.25, "blind"};
  results.failure = {first, 0.5, "stopped: blind"};
  return results;
}

}  // namespace tessera::statistics
