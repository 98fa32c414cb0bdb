// The times of a specification, as `tessera verify` tells them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "timing/declared.hpp"
#include "timing/patience.hpp"
#include "verify/verify.hpp"

namespace tessera::cli {

struct ChainVerdicts {
  std::string text;       ///< lines to print; empty: the specification says nothing about times
  std::string explained;  ///< the same with all rates, waits, timeouts and `stale`
  /// [{chain, leads, age_ns, reaction_ns, start_ns, exact, age, reaction} or {chain, leads, why}], all chains
  nlohmann::json json;
  nlohmann::json conduct;  ///< {rates, waits, stale}
  /// The first chain of which something asked is violated; empty: none.
  std::string violated{};
  /// The worst verdict on what the specification asks of chains. holds: on all of it, or it asks nothing.
  verify::Verdict overall = verify::Verdict::holds;
};

/// stop: ends the computation; what is asked is then unknown.
/// Precondition: the model is sound.
/// explained: runs that reach the bounds are searched for all chains, and not only where that answers what is asked.
[[nodiscard]] ChainVerdicts chain_verdicts(const spec::Model& model, const timing::StopAsked& stop = {},
                                           bool explained = false);

/// "age holds (at most 82 ms; asked 100 ms), reaction at most 142 ms"
[[nodiscard]] std::string verdict_text(const timing::DeclaredChain& chain,
                                       const timing::ChainVerdict& verdict);
/// The verdict of what is asked of one chain.
[[nodiscard]] verify::Verdict overall(const timing::ChainVerdict& verdict);

}  // namespace tessera::cli
