#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "oracle/nets/petri_net.hpp"
#include "oracle/nets/random_net.hpp"
#include "tessera/net_executor.hpp"

namespace tessera::testing {

using oracle::Marking;
using oracle::Random;

/// The net itself, not the compiled form of the executor. Conditions and operations are left out.
[[nodiscard]] oracle::PetriNet petri_net(const ExecutableNet& net);

/// One run of a net as the textbook has it.
class NaiveRun {
 public:
  explicit NaiveRun(const ExecutableNet& net) : net_(petri_net(net)), marking_(net_.initial) {}

  [[nodiscard]] const Marking& marking() const { return marking_; }
  [[nodiscard]] std::vector<std::uint32_t> enabled() const;
  /// false: it is not enabled, and the marking stays.
  [[nodiscard]] bool fire(std::uint32_t transition);

 private:
  oracle::PetriNet net_;
  Marking marking_;
};

/// Weights, several tokens, several arcs between the same two, self-loops, sources and sinks; most are
/// bounded.
[[nodiscard]] ExecutableNet random_net(Random& random);

[[nodiscard]] std::unique_ptr<NetExecutor> load(ExecutableNet net, NetExecutor::Options options = {});

}  // namespace tessera::testing
