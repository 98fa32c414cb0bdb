#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/ids.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// The net of a subsystem, prepared for firing: arcs in compressed rows, shared places as bits. Instances
/// with the same tables share one. It is immutable, and can be moved but not copied.
struct Plan {
  using PlaceId = Id<struct PlanPlaceTag>;
  using PortId = Id<struct PlanPortTag>;

  struct TransitionEntry;
  struct PlaceEntry {
    const TransitionEntry* departure = nullptr;  ///< the first of those that take from it; nullptr: none
    Does::Kind does = Does::Kind::nothing;
    std::uint16_t subject = 0;  ///< index of the behaviour or of the port
    std::uint16_t slot = 0;     ///< slot that is written or read, from 0
    /// of decide and route: bit i is set if a transition takes a token that says i, whatever the facts are
    std::uint64_t ways = 0;
    bool timed = false;  ///< a timeout counts from the arrival of its token
    bool fact = false;  ///< stands for a value of a fact: its token is only read, and leaves with another one
    bool tells = false;  ///< what is read there decides which state of a goal is the next
    bool idle = false;   ///< an arriving token does nothing, and the place is not `out`
  };
  struct Condition {
    Guard::Kind kind = Guard::Kind::none;
    std::uint16_t entry = 0;
  };
  struct TransitionEntry {
    const TransitionEntry* onward = nullptr;         ///< in departures: the first that takes from `to`
    std::uint32_t index = 0;                         ///< in transitions
    std::uint32_t inputs = 0, outputs = 0, end = 0;  ///< into arcs: inputs up to outputs, outputs up to end
    PlaceId from{};                                  ///< of one with a single input here
    PlaceId to{};                                    ///< of one with a single input and a single output here
    PortId port{};                                   ///< the channel it touches
    PlaceId latch{};                                 ///< the input place whose arrival decides the guard ...
    std::int32_t decided = 0;                        ///< ... if it says this
    Condition guard;
    std::uint16_t taken = 0, produced = 0;  ///< fused places it takes and gives, as bits
    std::optional<std::uint8_t> need{};     ///< `taken` in PortEntry::needs; nullopt: nothing
    bool last = false;                      ///< in departures: of its place
    /// takes from a place from which a timeout counts: an elapsed transition, or one of its alternatives
    bool tells_of_timeout = false;
  };
  struct PortEntry {
    std::vector<std::uint16_t> needs;  ///< different sets of fused places its transitions take, as bits
  };

  Plan() = default;
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  Plan(Plan&&) = default;
  Plan& operator=(Plan&&) = default;
  ~Plan() = default;

  std::vector<PlaceEntry> places;
  std::vector<TransitionEntry> transitions;
  std::vector<PortEntry> ports;
  std::vector<std::uint32_t> arcs;           ///< local places
  std::vector<std::uint32_t> leaving;        ///< per place: transitions that take from it, untimed ones first
  std::vector<std::uint32_t> first_leaving;  ///< into leaving; one more than places
  std::vector<TransitionEntry> departures;   ///< as leaving, the transitions themselves
  std::uint32_t in = 0, out = 0;
  std::vector<std::uint32_t> known;  ///< places that hold a token at the start: of facts
  bool receive_first = false;  ///< iterations begin at their own places (Does::Kind::begin), not with a call

  [[nodiscard]] std::span<const std::uint32_t> inputs(const TransitionEntry& t) const {
    return std::span(arcs).subspan(t.inputs, t.outputs - t.inputs);
  }
  [[nodiscard]] std::span<const std::uint32_t> outputs(const TransitionEntry& t) const {
    return std::span(arcs).subspan(t.outputs, t.end - t.outputs);
  }
  [[nodiscard]] std::span<const std::uint32_t> leaving_of(std::uint32_t place) const {
    return std::span(leaving).subspan(first_leaving[place], first_leaving[place + 1] - first_leaving[place]);
  }
};

/// fused: per port of the net, the fused places of the channel behind it.
///
/// Errors: a number that the tables do not declare, a transition that touches two channels or takes from no
///         place of the subsystem, more than most_shared_places fused places: nullopt and `error`.
[[nodiscard]] std::optional<Plan> compile(const SubsystemNet& net,
                                          std::span<const std::span<const FusedPlace>> fused,
                                          std::string& error);

}  // namespace tessera
