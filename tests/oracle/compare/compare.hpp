// One specification through the command and through the oracle, and where they differ.
#pragma once

#include "command.hpp"
#include "oracle/judge/judge.hpp"

namespace oracle {

struct Disagreement {
  std::string kind;    // "verdict goes_on", "net", "run goes_on: end", ...
  std::string detail;  // for people
};

/// The compared items.
struct Comparison {
  bool refused = false;    // the command refuses the specification, for a reason that the oracle sees too
  bool too_large = false;  // for the oracle
  std::string refusal;     // code of the diagnostic
  int nets = 0, verdicts = 0, violated = 0, runs = 0, unknown = 0, without_run = 0;
  std::size_t states = 0;
  std::vector<Disagreement> disagreements;
};

Comparison compare(const Specification& specification, const Command& command, std::size_t limit);

}  // namespace oracle
