// The bounds of a specification's chains, as `tessera verify` tells them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "spec/model/model.hpp"

namespace tessera::cli {

struct ChainVerdicts {
  std::string text;     ///< lines to print; empty: the specification says nothing about times
  nlohmann::json json;  ///< [{chain, age_ns, reaction_ns, start_ns, exact} or {chain, why}], all chains
};

/// Precondition: the model is sound.
[[nodiscard]] ChainVerdicts chain_verdicts(const spec::Model& model);

}  // namespace tessera::cli
