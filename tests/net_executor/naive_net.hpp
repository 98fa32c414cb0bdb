#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tessera/net_executor.hpp"

namespace tessera::testing {

using Marking = std::vector<std::uint32_t>;

/// The oracle: plays a net as in a textbook. It reads the net itself, not the data of the executor.
class NaiveNet {
 public:
  explicit NaiveNet(const ExecutableNet& net);

  [[nodiscard]] const Marking& marking() const { return marking_; }
  [[nodiscard]] bool enabled(std::uint32_t transition) const;
  [[nodiscard]] std::vector<std::uint32_t> enabled() const;
  /// false: it is not enabled, and nothing changes.
  [[nodiscard]] bool fire(std::uint32_t transition);

  struct Outcomes {
    std::set<Marking> reachable, dead;
  };
  /// Everything that can be reached from here; nullopt: more than `most` markings, or more tokens in a place.
  [[nodiscard]] std::optional<Outcomes> outcomes(std::size_t most, std::uint32_t most_tokens) const;

 private:
  const ExecutableNet& net_;
  Marking marking_;
};

using Random = std::mt19937;

/// Weights, several tokens, self-loops, sources and sinks; most are bounded.
[[nodiscard]] ExecutableNet random_net(Random& random);

[[nodiscard]] std::unique_ptr<NetExecutor> load(ExecutableNet net, NetExecutor::Options options = {});

/// The number an environment variable holds, for long forms of tests.
[[nodiscard]] std::uint32_t number_from(const char* variable, std::uint32_t otherwise);

}  // namespace tessera::testing
