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
/// * each that is waited for is stuck for ever too, has ended, or can go on without giving what is lacking.
///
/// stuck: transitions of one subsystem. Where there are too many markings to see all that may follow, the run
/// is gone on with as far as it goes, and only those are named of whom it can be shown that they are stuck.
[[nodiscard]] Explanation explained(const net::Net& net, std::vector<net::TransitionId> run,
                                    const std::vector<net::TransitionId>& stuck);

/// A run that shows a violation for good: nothing that follows it can mend that. It goes on to where each
/// that is waited for, by those who are stuck for ever, is stuck too, has ended, or can go on without giving
/// it. Where there are too many markings to see all that may follow, the run stays as it is.
[[nodiscard]] Explanation explained(const net::Net& net, std::vector<net::TransitionId> run);

}  // namespace tessera::verify
