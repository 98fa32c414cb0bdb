#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "network/clock_offset.hpp"
#include "network/messages.hpp"
#include "network/status.hpp"

namespace tessera::network {

/// A value of a channel on its way to another process.
struct Value {
  std::chrono::nanoseconds stamp{0};  ///< when it was written, by the clock of its sender
  bool valid = false;                 ///< the transition function that made it had not failed
  std::span<const std::byte> bytes;   ///< as recordings encode it (tessera/value_encoding.hpp)
};

/// The number of a process of the deployment in the verified system.
using ProcessNumber = std::uint32_t;
/// The number of a channel of the system. All processes use the same numbers, because they execute parts of
/// one verified net.
using ChannelNumber = std::uint32_t;

/// The quality of the link from a process that is reachable. Only for display.
struct SignsOfLife {
  std::uint32_t expected = 0;  ///< signs of life among the newest, at most 64
  std::uint32_t lost = 0;      ///< those of them that have not arrived (yet)
  std::optional<ClockOffset> clock;
};

/// Moves messages between the processes of one deployment. It may lose, repeat, delay and reorder them; the
/// protocol tolerates that. It never alters a message, and never delivers one of another deployment.
///
/// Threads: all members from one thread, except wake().
class Carrier {
 public:
  /// Receives what has arrived. Spans are valid during the call only.
  class Listener {
   public:
    virtual ~Listener() = default;
    virtual void heard(ChannelNumber channel, const Data& data, const Value& value) = 0;
    virtual void heard(ChannelNumber channel, const State& state) = 0;
    /// A process of the deployment is found, or is no longer heard of.
    virtual void reachable(ProcessNumber process, bool is_there) = 0;
    /// A sign of life has arrived. Only some carriers send them.
    virtual void alive(ProcessNumber /*process*/, const SignsOfLife& /*signs*/) {}
    /// A message is dropped for a reason that a person should know: another version, another net, malformed
    /// bytes.
    virtual void complaint(std::string_view text) = 0;
  };

  virtual ~Carrier() = default;
  /// value: ignored for a recall. Never waits: a message that cannot be sent now is lost.
  virtual void send(ChannelNumber channel, const Data& data, const Value& value) = 0;
  virtual void send(ChannelNumber channel, const State& state) = 0;
  /// Delivers everything that has arrived. Waits until there is a message, wake() is called, or `longest` is
  /// over.
  virtual void receive(Listener& listener, std::chrono::nanoseconds longest) = 0;
  /// Ends a wait of receive(), or the next one. Threads: any.
  virtual void wake() = 0;

  /// The number of readers of the status of this process (network/status.hpp). Threads: any.
  [[nodiscard]] virtual std::size_t watchers() { return 0; }
  /// Sends the status to them once: there is no answer, and a lost text is not repeated. Nothing else of the
  /// carrier waits for it. text: at most longest_status_bytes. Threads: one, which may differ from that of the
  /// other members.
  virtual void send_status(StatusPart /*part*/, std::string_view /*text*/) {}
};

/// The last domain of the middleware that has enough UDP ports.
inline constexpr int last_domain = 230;

/// A channel between two processes, as its carrier needs to know it.
struct ChannelSetup {
  ChannelNumber number = 0;
  std::string_view name;                  ///< "base.plan.goal->cart.drive.goal"
  ProcessNumber sender = 0;               ///< the process that sends values
  ProcessNumber receiver = 0;             ///< the process that receives them
  std::uint32_t longest_value_bytes = 0;  ///< of the encoded value
};

/// The facts of the run that a carrier needs. Views are valid while the carrier is made.
struct CarrierSetup {
  std::string_view system, net_hash;            ///< messages of other systems and other nets are dropped
  ProcessNumber process = 0;                    ///< this one
  std::span<const std::string_view> processes;  ///< names, by number
  std::uint64_t incarnation = 0;                ///< number of this start of the process, greater than all
                                                ///< before
  std::chrono::nanoseconds liveliness{0};       ///< a process that is silent for longer is not reachable
  int domain = 0;                               ///< of the middleware
  std::string_view interface;                   ///< of the network, or its address; empty: "lo"
  std::span<const std::string_view>
      peers;                               ///< hosts at which other processes are looked for; empty: anywhere
  std::span<const ChannelSetup> channels;  ///< those that begin or end in this process
};

/// Makes a carrier. A library that offers one exports this function under the name open_carrier_function.
///
/// Errors: nullptr, and `error` (of `size` bytes, terminated by 0) says why.
using OpenCarrier = Carrier*(const CarrierSetup& setup, char* error, std::size_t size);
inline constexpr const char* open_carrier_function = "tessera_open_carrier_4";

}  // namespace tessera::network
