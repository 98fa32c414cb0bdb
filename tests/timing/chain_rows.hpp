// The chains of a drawn system in its tables.
#pragma once

#include <bit>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <string>
#include <vector>

#include "reference.hpp"
#include "tessera/tables.hpp"

namespace tessera::timing_test {

inline constexpr std::int64_t tick_ns = 1'000'000;

/// A program cannot write a list of a number of elements that only the running program knows. all: outlives it.
inline std::initializer_list<std::uint32_t> list_of(const std::vector<std::uint32_t>& all) {
  struct List {
    const std::uint32_t* first;
    std::size_t count;
  };
  return std::bit_cast<std::initializer_list<std::uint32_t>>(List{all.data(), all.size()});
}

inline std::string chain_name(std::size_t chain) { return "chain " + std::to_string(chain); }

/// The rows of the chains, with their bounds.
struct ChainRows {
  ChainRows(const std::vector<::timing::Chain>& drawn, const timing::Bounds* bounds) {
    for (std::size_t chain = 0; chain < drawn.size(); ++chain) {
      const timing::Chain& channels = channels_.emplace_back(timing::chain_of(drawn[chain]));
      const timing::ChainBound bound = bounds->chain(channels);
      const auto proved = [](timing::Time most) {
        return Duration(most >= timing::unbounded ? 0 : most * tick_ns);
      };
      chains.push_back({names_.emplace_back(chain_name(chain)), proved(bound.age), proved(bound.reaction)});
      ways.push_back({static_cast<std::uint32_t>(chain), list_of(channels)});
    }
  }
  std::vector<tessera::Chain> chains;
  std::vector<ChainWay> ways;

 private:
  std::deque<timing::Chain> channels_;
  std::deque<std::string> names_;
};

}  // namespace tessera::timing_test
