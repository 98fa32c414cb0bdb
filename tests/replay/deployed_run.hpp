#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "net/net.hpp"
#include "replay/deployed_net.hpp"
#include "spec/model/model.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

/// A deployed system and its net.
struct Deployed {
  spec::Model model;
  net::Net net;
  ProcessMap processes;
};
/// Each agent of the model in a process of its own.
[[nodiscard]] Deployed each_apart(spec::Model model);

/// A random run of the net, with the transitions of the medium, and with values that have numbers: one
/// recording per process, as threads would leave them. Incarnations are 1 + the number of the process.
[[nodiscard]] std::vector<Recording> deployed_run(const Deployed& system, std::size_t firings,
                                                  std::mt19937& random);
/// The same run in one recording, in its order, as the simulated clock leaves it.
[[nodiscard]] Recording simulated_run(const Deployed& system, std::size_t firings, std::mt19937& random);

}  // namespace tessera::replay
