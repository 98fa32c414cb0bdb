// The parts of the times of a chain, and what would help.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "timing/patience.hpp"
#include "verify/verify.hpp"

namespace tessera::cli {

struct ChainExplanation {
  std::string text;
  nlohmann::json json;  ///< {chain, ..., steps: {age, reaction}, changes}, or {chain, ..., missing}
  verify::Verdict verdict = verify::Verdict::holds;
};

/// Names of all chains of the specification.
[[nodiscard]] std::vector<std::string> chain_names(const spec::Model& model);

/// nullopt: there is no such chain. Throws timing::Interrupted.
/// Precondition: the model is sound.
[[nodiscard]] std::optional<ChainExplanation> explain_chain(const spec::Model& model, const std::string& name,
                                                            const timing::StopAsked& stop = {});

}  // namespace tessera::cli
