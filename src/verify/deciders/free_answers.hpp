#pragma once

#include "verify/deciders/facts.hpp"
#include "verify/deciders/question.hpp"

namespace tessera::verify {

/// Whether the answer yes about a free net (communication/free_net.hpp) is that of the net, too. It is, if it speaks
/// of all markings and runs, since each of the net is one of its free net. If it says that something can still happen,
/// it is where the facts of the net decide nothing that matters for it.
///
/// free: facts about the free net.
[[nodiscard]] bool carries_over(const Question& question, Facts& free, const net::Net& net);

}  // namespace tessera::verify
