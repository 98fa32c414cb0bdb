#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// The fused places of a channel, as bits.
enum Memory : std::uint8_t {
  free_to_use = 1,
  empty = 2,
  full = 4,
  acknowledged = 8,
  // of a channel between processes
  idle = 16,
  sent = 32,
  more = 64
};

/// A transition of one subsystem. It uses places of this subsystem, and of the memory of at most one channel.
struct TokenStep {
  net::TransitionId id;
  net::PlaceId from, to;              ///< invalid if there are several: a fork or a join
  net::ChannelId channel{};           ///< none: it uses no memory
  std::uint8_t takes = 0, gives = 0;  ///< Memory
  bool own_model = false;             ///< it uses fused places that no built-in block has
};

/// The steps of every subsystem, by their input places.
class Steps {
 public:
  explicit Steps(const net::Net& net);

  [[nodiscard]] std::span<const TokenStep> from(net::PlaceId place) const {
    return std::span(steps_).subspan(starts_[place.value], starts_[place.value + 1] - starts_[place.value]);
  }
  [[nodiscard]] const net::Net& net() const { return net_; }
  /// A transition that is neither a step of one subsystem nor a transition of the upper layers or of a medium.
  [[nodiscard]] std::optional<net::TransitionId> stray() const { return stray_; }
  /// Does the memory of the channel include acknowledgements?
  [[nodiscard]] bool acknowledges(net::ChannelId channel) const { return acknowledges_[channel.value]; }
  /// Does the channel cross processes?
  [[nodiscard]] bool networked(net::ChannelId channel) const { return networked_[channel.value]; }
  [[nodiscard]] std::uint32_t channel_count() const {
    return static_cast<std::uint32_t>(acknowledges_.size());
  }

 private:
  std::optional<TokenStep> read(net::TransitionId id);

  const net::Net& net_;
  std::vector<TokenStep> steps_;
  std::vector<std::uint32_t> starts_;
  std::vector<bool> acknowledges_;  // per channel
  std::vector<bool> networked_;     // the same
  std::optional<net::TransitionId> stray_;
};

/// A block of the communication layer, the fifth.
struct Block {
  Communication communication;  ///< without its flow
  net::PlaceId out;
};

/// Whether the block that starts at `in` is one of a send that an iteration may skip.
[[nodiscard]] bool may_be_skipped(const Steps& steps, net::PlaceId in);

/// The block that starts at `in`: a built-in one if exactly the transitions of one start there, else one of
/// the author's model, whose transitions share the name of their block and lead to one place. nullopt also for one
/// that may be skipped.
[[nodiscard]] std::optional<Block> block_at(const Steps& steps, net::PlaceId in);

}  // namespace tessera::verify
