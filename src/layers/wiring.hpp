#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::layers {

enum class Direction : std::uint8_t { send, receive };

/// The channels that begin or end at the buffers of each instance, in channel order.
class Wiring {
 public:
  explicit Wiring(const spec::Model& model);

  /// The channels that a behaviour of `instance` sends to or receives from, in the order of the blocks
  /// of its page: its `send:`/`receive:` list (channels of one output in channel order), else the
  /// order of Model::channels.
  [[nodiscard]] std::vector<spec::ChannelId> used(spec::InstanceId instance, const spec::Behaviour& behaviour,
                                                  Direction direction) const;

  /// Per channel: does any behaviour of either end use it?
  [[nodiscard]] Numbered<spec::ChannelId, bool> used_channels() const;

 private:
  const spec::Model& model_;
  Numbered<spec::InstanceId, std::vector<spec::ChannelId>> outgoing_, incoming_;
};

/// The end of a channel that the given side holds.
[[nodiscard]] const spec::ChannelEnd& end_of(const spec::Channel& channel, Direction direction);

}  // namespace tessera::layers
