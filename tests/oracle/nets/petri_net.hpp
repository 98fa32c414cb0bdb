// A place/transition net and the textbook's rule of firing. It shares no code with Tessera.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace oracle {

/// Tokens per place.
using Marking = std::vector<std::uint32_t>;

struct Arc {
  std::uint32_t place = 0, weight = 1;
};

struct PetriNet {
  struct Transition {
    std::vector<Arc> inputs{}, outputs{};  ///< several arcs between the same two count together
    bool never = false;                    ///< its condition is never true: it does not fire
  };
  Marking initial{};
  std::vector<Transition> transitions{};
};

/// The marking after a transition has fired; nullopt if it is not enabled.
[[nodiscard]] std::optional<Marking> fired(const PetriNet::Transition& transition, const Marking& marking);

}  // namespace oracle
