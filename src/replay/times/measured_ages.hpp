// How old commands were, in recordings, beside what is proved for the specification.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "replay/times/ages.hpp"
#include "spec/model/model.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

/// The times of a group of chains, and its bounds.
struct AgesOfChain {
  ChainAges measured;
  std::optional<std::int64_t> age_ns, reaction_ns;  ///< proved, for all its chains; nullopt: nothing is
  bool exact = false;                               ///< some run takes so long
  std::string why;                                  ///< there are no bounds, because of this
  /// Behaviours on the way whose calls took no time, in runs on the simulated clock: `takes` said nothing of them.
  std::vector<std::string> timeless;

  [[nodiscard]] bool exceeds() const {
    return (age_ns && measured.age.most > *age_ns) || (reaction_ns && measured.reaction.most > *reaction_ns);
  }
};

/// Those that the specification names; else each receptor -> control -> effector of one agent.
[[nodiscard]] std::vector<MeasuredChain> measured_chains(const spec::Model& model);

/// Adds the bounds of the model to measured times.
[[nodiscard]] std::vector<AgesOfChain> beside_bounds(std::vector<ChainAges> measured,
                                                     const spec::Model& model);

/// The chains of the model, measured in all the recordings together.
[[nodiscard]] std::vector<AgesOfChain> ages_in(std::span<const Recording> recordings,
                                               const spec::Model& model);

/// Tells that the measured times leave out calls; empty: they do not.
[[nodiscard]] std::string timeless_note(const AgesOfChain& one);

/// names: of the recordings, for the worst cases. docs/reference/recordings.md describes it.
[[nodiscard]] nlohmann::json ages_json(const std::vector<AgesOfChain>& all,
                                       std::span<const std::string> names);

}  // namespace tessera::replay
