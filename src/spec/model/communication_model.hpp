#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"

/// How the two sides of a channel share its memory: a pair of Petri nets with fused
/// places (paper, sec. IV-E).
namespace tessera::spec {

/// A place that both sides see. It belongs to the channel, whatever behaviours use it.
struct SharedPlace {
  std::string name;
  std::uint32_t tokens = 0;  ///< initially, 0 or 1
  diagnostics::Span span;
};

/// One side: a net whose single token is the behaviour that sends or receives. So every transition takes
/// one token from a place of the side and gives one to a place of the side, besides shared places.
struct ModelSide {
  struct Place {
    std::string name;
    std::optional<std::uint32_t> slot;  ///< of the memory that is written (send) or read (receive), from 0
    diagnostics::Span span;
  };
  struct Transition {
    std::string name;
    std::uint32_t from = 0, to = 0;           ///< into places
    std::vector<std::uint32_t> takes, gives;  ///< into CommunicationModel::shared
    bool elapsed = false;                     ///< fires only after the timeout of the channel
    diagnostics::Span span;
  };

  static constexpr std::uint32_t in = 0, out = 1;  ///< places that every side has
  std::vector<Place> places;
  std::vector<Transition> transitions;
  /// Whether the side always takes time: if the other side does nothing, its token comes to a stop,
  /// whatever the shared places hold. A behaviour that uses it waits for the other side or for a timeout.
  bool waits = false;

  /// Whether a transition waits for the timeout.
  [[nodiscard]] bool has_timeout() const;
};

/// A transition between shared places alone: what a network does between the two sides.
struct MediumTransition {
  std::string name;
  std::vector<std::uint32_t> takes, gives;  ///< into CommunicationModel::shared
};

struct CommunicationModel {
  std::string name;
  std::uint32_t slots = 1;  ///< values that the memory holds
  std::vector<SharedPlace> shared;
  ModelSide send, receive;
  std::vector<MediumTransition> medium{};  ///< only of a channel between processes
  diagnostics::Span span;
};

/// The contents of ModelSide::waits. Precondition: at most `most_shared_places` of them. O(2^shared *
/// transitions).
[[nodiscard]] bool waits_without_peer(const CommunicationModel& model, const ModelSide& side);

}  // namespace tessera::spec
