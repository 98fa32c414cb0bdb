#pragma once

#include "verify/deciders/facts.hpp"
#include "verify/deciders/question.hpp"

namespace tessera::verify {

/// Whether the answer yes about a free net (communication/free_net.hpp) is that of the net, too. What is said of all
/// markings and runs is: each of the net is one of its free net. That something can still happen is where
/// the facts of the net decide nothing that matters for it.
///
/// free: facts about the free net.
[[nodiscard]] bool carries_over(const Question& question, Facts& free, const net::Net& net);

}  // namespace tessera::verify
