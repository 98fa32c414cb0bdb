#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::server {

/// Other times of a subsystem than its specification says. They hold for all that share its description.
struct OtherTimes {
  std::string path;  ///< "robot.control"; of a fleet, with or without the number of a member
  /// Nanoseconds. Below 0: as the specification says. A period of 0: no rate.
  std::int64_t period = -1, shortest = -1, longest = -1;
};

/// How old a command can be: all chains of the specification, with the bounds that `tessera verify` tells
/// (docs/theory/timing.md), for the times that it says and `others`.
///
/// explained: the name of the chain whose parts are told; empty: none.
/// Returns the answer of POST /api/timing, or why there is none.
/// Threads: pure.
[[nodiscard]] std::variant<nlohmann::json, std::string> chain_bounds(const spec::Model& model,
                                                                     const std::vector<OtherTimes>& others,
                                                                     const std::string& explained);

/// The single changes of the specification that make a time of a chain smaller, the best one first.
///
/// Returns the answer of POST /api/timing/changes, or why there is none.
/// Threads: pure.
[[nodiscard]] std::variant<nlohmann::json, std::string> chain_changes(const spec::Model& model,
                                                                      const std::string& name);

/// The run in which the age or the reaction of a chain comes nearest to its bound, for the times of the specification
/// and `others`.
///
/// Returns the answer of POST /api/timing/worst, or why there is none.
/// Threads: pure.
[[nodiscard]] std::variant<nlohmann::json, std::string> chain_worst_run(const spec::Model& model,
                                                                        const std::vector<OtherTimes>& others,
                                                                        const std::string& name, bool age);

}  // namespace tessera::server
