#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "chains/carried_readings.hpp"
#include "nets/process_part.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// The chains of the part of a system that runs here.
class FollowedChains {
 public:
  explicit FollowedChains(const ProcessPart& part);

  /// How many readings stand beside a value in that channel.
  [[nodiscard]] std::size_t readings_in(std::uint32_t channel) const {
    return channel < in_channel_.size() ? in_channel_[channel] : 0;
  }
  /// nullptr: no chain goes through that subsystem.
  [[nodiscard]] std::unique_ptr<CarriedReadings> readings_of(std::uint32_t instance) const;
  /// Row by row of the tables; rows without a chain here are left out. Threads: any.
  [[nodiscard]] std::vector<ChainTimes> times() const;

 private:
  struct Through {
    CarriedReadings::Layout layout;
    std::size_t ports = 0;
  };
  std::vector<std::uint32_t> in_channel_;  // per channel
  std::vector<Through> through_;           // per instance
  std::deque<ChainMember> members_;        // row by row
};

/// "joints to motors: a command was 95 ms old, and at most 81 ms is proved"; as much of it as there is room for.
[[nodiscard]] std::string_view text_of(const ChainExcess& excess, std::span<char> room);

}  // namespace tessera
