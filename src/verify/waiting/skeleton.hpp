#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "net/net.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// A net of some subsystems, without anything that no subsystem ever waits for. It has a place for every
/// point of a behaviour at which a subsystem can be, the places `full` and `ack` of every channel at which a
/// subsystem may have to wait, and a transition for every step. A transfer is one step: a write counts as
/// done once it has begun, a read once it is over. Traps are searched in this net; they do not need `empty`.
class Skeleton {
 public:
  /// A place where a token may wait without a limit.
  struct Stop {
    std::uint32_t place = 0;
    SubsystemFlowId subsystem;
    ChannelFlowId channel;
    Side side = Side::receive;  ///< send: for the acknowledgement
    /// Places that may be marked together with this one: those of the other branches of a parallel transfer.
    std::vector<std::uint32_t> beside;
    std::uint32_t stage = 0;  ///< stops of one stage may be occupied together
  };

  Skeleton(const CommunicationStructure& structure, std::span<const SubsystemFlowId> subsystems);

  [[nodiscard]] const net::Net& net() const { return net_; }
  [[nodiscard]] const std::vector<Stop>& stops() const { return stops_; }
  /// All places of a subsystem.
  [[nodiscard]] std::span<const std::uint32_t> of_subsystem(SubsystemFlowId subsystem) const {
    return places_of_[subsystem.value];
  }
  /// The place whose token a stop waits for.
  [[nodiscard]] std::uint32_t awaited(const Stop& stop) const {
    const Memory& memory = memory_[stop.channel.value];
    return stop.side == Side::send ? memory.acknowledged : memory.full;
  }

 private:
  struct Memory {
    std::uint32_t full = 0, acknowledged = 0;
  };

  std::uint32_t place(std::uint32_t tokens = 0);
  std::uint32_t point(SubsystemFlowId subsystem, std::uint32_t tokens = 0);
  void step(const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& to);
  void draw(SubsystemFlowId subsystem);
  std::uint32_t draw_stage(SubsystemFlowId subsystem, const Stage& stage, std::uint32_t from);
  void draw_block(SubsystemFlowId subsystem, const Communication& communication, std::uint32_t from,
                  std::uint32_t to);
  void draw_send(SubsystemFlowId subsystem, ChannelFlowId channel, std::uint32_t from, std::uint32_t to);
  void draw_receive(SubsystemFlowId subsystem, ChannelFlowId channel, std::uint32_t from, std::uint32_t to);

  const CommunicationStructure& structure_;
  net::Net net_;
  std::vector<Memory> memory_;                         // per channel
  std::vector<std::vector<std::uint32_t>> places_of_;  // per subsystem
  std::vector<Stop> stops_;
  std::uint32_t stages_ = 0;
};

}  // namespace tessera::verify
