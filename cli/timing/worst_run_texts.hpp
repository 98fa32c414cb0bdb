// The run in which a command is as old as it can be, in words, and as a file.
#pragma once

#include <optional>
#include <string>

#include "spec/model/model.hpp"
#include "timing/worst/worst_run.hpp"

namespace tessera::cli {

/// The lines that tell the run from the reading to the command. bound: of the age or the reaction.
[[nodiscard]] std::string story_of(const timing::WorstRun& run, bool is_age, timing::Time bound,
                                   const timing::Declared& declared, const spec::Model& model);

/// A run of a chain that can be made again.
struct RunToWrite {
  timing::WorstRun run;
  std::string chain;
  bool is_age = false;
};
/// The run that shows a violation of what is asked of a chain, or else the one with the largest reaction.
/// name: of the chain; empty: the first one of which something asked is violated. nullopt: there is none.
[[nodiscard]] std::optional<RunToWrite> run_to_write(const spec::Model& model, const std::string& name,
                                                     const timing::StopAsked& stop);

}  // namespace tessera::cli
