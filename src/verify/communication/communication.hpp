#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "net/net.hpp"

/// The subsystems that communicate with each other, from the executed flat net.
namespace tessera::verify {

enum class Side : std::uint8_t { send, receive };

using SubsystemFlowId = net::Id<struct SubsystemFlowTag>;  ///< into CommunicationStructure::subsystems
using ChannelFlowId = net::Id<struct ChannelFlowTag>;      ///< into CommunicationStructure::channels

/// One block: one side of one channel in one behaviour.
struct Communication {
  net::ChannelId channel;
  ChannelFlowId flow{};  ///< the same channel in the communication structure
  Side side = Side::send;
  bool blocking = false;
  bool timeout = false;    ///< only of a blocking side
  bool own_model = false;  ///< by a model of the author: its waits are unknown
  bool operator==(const Communication&) const = default;
};

/// Blocks that run side by side, between a fork and a join; a sequential transfer has one block per stage.
using Stage = std::vector<Communication>;

struct BehaviourFlow {
  std::string name;           ///< "robot.control.follow"
  std::vector<Stage> stages;  ///< those of snd, then those of rcv; with `receive: first` the other way round
  bool repeats = false;       ///< t4 may fire
  bool leaves = false;        ///< t5 or t6 may fire
  /// Once the behaviour is left, an entry of `next` can certainly be taken: one has no condition, or the last
  /// one covers all other cases.
  bool complete = true;
  std::vector<std::uint32_t> next;  ///< behaviours that may follow; indices into SubsystemFlow
  bool ends = false;                ///< the subsystem may end after it
};

struct SubsystemFlow {
  net::SubsystemId id;
  std::string name;  ///< "robot.control"
  /// Those that can be reached, given the conditions that are known to be constant. The first is the start.
  std::vector<BehaviourFlow> behaviours;
};

/// The two ends of a channel that some reachable behaviour uses.
struct ChannelFlow {
  net::ChannelId id;
  std::string name;                  ///< "robot.control.motion->robot.motor.velocity"
  SubsystemFlowId sender, receiver;  ///< none: no reachable behaviour uses this end
  bool send_blocks = false, send_timeout = false;
  bool receive_blocks = false, receive_timeout = false;
  bool own_model = false;  ///< a model of the author, at one end at least
  bool networked = false;  ///< its ends are in different processes
  bool always_readable =
      false;  ///< both sides non-blocking: reading never depends on a value having been sent
  /// If no reachable behaviour uses an end: its subsystem, "b.control", and the reason, "b.control never
  /// leaves look (line 9), so take (line 10), which receives it, is never entered".
  std::string absent{}, absence{};
};

struct CommunicationStructure {
  std::vector<SubsystemFlow> subsystems;
  std::vector<ChannelFlow> channels;

  [[nodiscard]] const SubsystemFlow& operator[](SubsystemFlowId id) const { return subsystems[id.value]; }
  [[nodiscard]] const ChannelFlow& operator[](ChannelFlowId id) const { return channels[id.value]; }
};

/// Which conditions may hold.
enum class Assume : std::uint8_t {
  conditions,  ///< as given: constants are known, the rest are free choices
  exceptions,  ///< also every error condition (t6) is a free choice, as user code may throw
  partition    ///< as `conditions`; and delivery between processes may stop for ever at any time
};

struct CommunicationResult {
  std::optional<CommunicationStructure> structure;
  std::string why_not;  ///< without a structure: the first element that the five layers do not have
};

/// Finds out from the net what each subsystem communicates, and in which order. It reads the net, not the
/// specification, so that the net that is judged is the net that is executed. Every transition of a subsystem
/// must belong to a block or a page of the five layers; otherwise there is no structure.
///
/// Threads: pure. Linear in the net.
/// Source: Figat & Zielinski, ICRA 2019, sec. IV.
[[nodiscard]] CommunicationResult communication_structure(const net::Net& net,
                                                          Assume assume = Assume::conditions);

}  // namespace tessera::verify
