#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "explore/pt_net.hpp"

namespace tessera::explore {

/// Chooses, in each marking, a part of the enabled transitions that still leads to every dead marking.
///
/// Source: Valmari's strong stubborn sets, closed in the usual way. With an enabled transition come those
///         that share an input place with it, if one of the two removes tokens from it. With a disabled
///         transition come those that add tokens to one of its missing places. Threads: one at a time.
class StubbornSets {
 public:
  explicit StubbornSets(const PtNet& net);

  /// The enabled transitions of the smallest stubborn set that a bounded search finds; empty if and only if
  /// the marking is dead. Valid until the next call.
  [[nodiscard]] std::span<const std::uint32_t> choose(std::span<const Tokens> marking);

 private:
  void close(std::uint32_t seed, std::span<const Tokens> marking, std::size_t give_up_at);
  void add(std::uint32_t transition);
  void add_rivals(std::uint32_t transition);
  void add_suppliers(std::uint32_t transition, std::span<const Tokens> marking);
  [[nodiscard]] std::size_t suppliers_missing(std::uint32_t place) const;

  const PtNet& net_;
  std::vector<std::uint32_t> enabled_, set_, best_, chosen_;
  std::vector<char> is_enabled_;
  std::vector<std::uint32_t> member_;  // per transition: the number of the last set that had it
  std::uint32_t set_number_ = 0;
};

}  // namespace tessera::explore
