#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bag/channel.hpp"
#include "tessera/poses.hpp"
#include "tessera/recording.hpp"

namespace tessera::bag {

/// The poses of the bodies of the simulated world as /tf (tf2_msgs/msg/TFMessage), each in the frame `world`.
/// A whole frame of the recording becomes a message with every body; any other one with those that have moved.
class PoseChannel {
 public:
  explicit PoseChannel(const Recording::Scene& scene);
  [[nodiscard]] static ChannelPlan plan();

  /// nullopt: the poses are not known now, because frames before this one are missing.
  [[nodiscard]] std::optional<std::string> message_of(const Recording::Entry& frame);
  /// Frames are missing from here on.
  void forget() { decoder_ = PoseDecoder(names_.size()); }

 private:
  std::vector<std::string> names_;
  PoseDecoder decoder_;
  std::vector<RoundedPose> last_;
};

}  // namespace tessera::bag
