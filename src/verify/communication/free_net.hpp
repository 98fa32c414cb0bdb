#pragma once

#include <optional>
#include <vector>

#include "net/property.hpp"
#include "verify/communication/communication.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {

/// A net without what its subsystems know (net::Parts::Fact): every condition that asks for a fact is a free
/// choice. Places keep their numbers: those of facts, which come last, are left out. Transitions that differ only
/// in the values of facts are one.
///
/// Every run of a net is a run of its free net, and where a token stands before a choice in the free net, the net
/// can choose something, too. Answers about all runs carry over from the free net; see carries_over.
struct FreeNet {
  net::Net net;
  std::vector<net::Invariant> invariants;
};

/// nullopt: no subsystem knows anything. Linear in the net.
[[nodiscard]] std::optional<FreeNet> free_net(const net::Net& net,
                                              const std::vector<net::Invariant>& invariants);

/// Whether facts decide if something is sent. In the free net a subsystem can then skip a send that would wait, and
/// in the net it cannot: there is not always something that the net can choose.
[[nodiscard]] bool facts_decide_sends(const net::Net& net);

/// Whether the property speaks of values of facts, which the free net does not have.
[[nodiscard]] bool asks_facts(const net::Net& net, const net::Property& property);

/// The run of the net that is the given run of its free net. Both nets are abstract ones under one assumption.
/// nullopt: what the subsystems know prevents it.
[[nodiscard]] std::optional<std::vector<net::TransitionId>> lifted(const net::Net& free, const net::Net& net,
                                                                   const std::vector<net::TransitionId>& run);

/// Whether the choices that facts decide change no communication: each subsystem that knows something has
/// behaviours that all communicate in the same way, it cannot end, and one of its entries of `next` always holds.
/// Then whatever the free net can go on with, the net can.
///
/// structure: of the free net.
[[nodiscard]] bool choices_change_nothing(const CommunicationStructure& structure, const net::Net& net);

}  // namespace tessera::verify
