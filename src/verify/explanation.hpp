#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"

/// How a run to a violation ends, and who waits for whom there: only what is so for ever is told.
namespace tessera::verify {

struct Explanation {
  std::vector<net::TransitionId> run;
  std::vector<std::string> waits;
};

/// A run after which the property "one of these transitions can always be fired again" cannot be true any
/// more, gone on with to where
///
/// * none of the transitions can ever be fired again, and
/// * of those who are waited for each is stuck for ever too, has ended, or can go on without giving what it
/// is
///   waited for.
///
/// stuck: transitions of one subsystem. Where there are too many markings to see all that may follow, the run
/// is gone on with as far as it goes, and only those are named of whom it can be shown that they are stuck.
[[nodiscard]] Explanation explained(const net::Net& net, std::vector<net::TransitionId> run,
                                    const std::vector<net::TransitionId>& stuck);

/// Who is stuck for ever after a run, and for whom each of them waits.
[[nodiscard]] std::vector<std::string> waits_for_ever(const net::Net& net,
                                                      const std::vector<net::TransitionId>& run);

}  // namespace tessera::verify
