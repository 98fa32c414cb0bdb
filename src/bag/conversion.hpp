#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bag/buffer_channel.hpp"
#include "bag/channel.hpp"
#include "bag/pose_channel.hpp"
#include "tessera/recording.hpp"

namespace tessera::bag {

/// The version of the messages that this conversion makes, as the metadata `tessera` of a bag name it.
inline constexpr const char* bag_version = "1";

/// Makes the messages of a bag of the entries of a recording, one after the other. The same entries give the same
/// messages. That is how a bag is checked: the recording that stands in it must give the messages that stand beside it.
///
/// Threads: one at a time.
class Conversion {
 public:
  /// recording: its header is needed, not its entries.
  Conversion(const Recording& recording, const Background& background);

  /// The channel of the recording itself comes first.
  [[nodiscard]] const std::vector<ChannelPlan>& channels() const { return channels_; }
  /// Gives the messages of this entry, that of the recording itself first. Precondition: the entry belongs to the
  /// recording.
  void convert(const Recording::Entry& entry, const Give& give);
  /// Entries are missing from here on.
  void forget();

 private:
  struct Held {
    std::string bytes;
    bool is_known = false;
  };
  void give_value(const Recording::Entry& entry, const Give& give);
  void give_poses(const Recording::Entry& entry, const Give& give);

  Recording recording_;  // without entries
  std::vector<ChannelPlan> channels_;
  std::vector<std::optional<BufferChannel>> buffers_;  // nullopt: its values cannot be recorded
  std::vector<std::size_t> channel_of_buffer_;
  std::vector<Held> held_;
  std::optional<PoseChannel> poses_;
  std::size_t poses_channel_ = 0;
  bool has_gap_ = false;
};

}  // namespace tessera::bag
