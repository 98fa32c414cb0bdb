#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "network/carrier.hpp"
#include "recorder/recorder.hpp"
#include "system/waker.hpp"
#include "tessera/tables.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// A channel between processes, with the facts that both of its ends need.
struct LinkedChannel {
  network::ChannelNumber number = 0;  ///< into System::channels of the whole system
  std::string_view name;
  network::ProcessNumber sender = 0, receiver = 0;
  bool same_host = true;       ///< both processes read the same clock
  bool sender_blocks = false;  ///< a send ends when its value was taken, or by its timeout
  bool exchanged = false;      ///< non-blocking at both ends
  std::uint16_t idle = 0, sent = 0, more = 0, empty = 0, full = 0;  ///< fused places, as bits; 0: none
  std::uint16_t own_memory = 0;  ///< exchanged: the lock of the memory of this end
};
/// is_sender: the end for which `own_memory` is set.
[[nodiscard]] LinkedChannel linked_channel(const System& whole, std::uint32_t channel, bool is_sender);

/// One end of a channel to another process, from the side of its subsystem. The other side of that end's word
/// (SharedChannel) is the thread that serves the links.
///
/// Threads: those of the subsystem, unless said otherwise.
class NetworkEnd {
 public:
  NetworkEnd(const LinkedChannel& channel, bool sends, Waker& service)
      : channel_(channel), sends_(sends), service_(service) {}
  NetworkEnd(const NetworkEnd&) = delete;
  NetworkEnd& operator=(const NetworkEnd&) = delete;
  virtual ~NetworkEnd() = default;

  /// A transition that touches the fused places of the channel, or ends a wait for it.
  struct Firing {
    std::uint16_t taken, produced;  ///< fused places, as bits
    bool elapsed;                   ///< time is up
  };
  /// The firing has happened, and is not recorded yet. Returns the number that its event contains instead of
  /// a version: the low 32 bits of the number of the value; 0: no value.
  [[nodiscard]] virtual std::uint32_t fired(Firing firing, Time now, RecordingLane* lane) = 0;
  /// Takes the value that is to be sent when its transfer ends. Only for ends that send.
  virtual void write(const void* value, Time now, bool valid) = 0;

  /// Whether the process at the other end is unknown or no longer reachable. Threads: any.
  [[nodiscard]] bool disconnected() const { return disconnected_.load(std::memory_order_relaxed); }
  void set_disconnected(bool is) { disconnected_.store(is, std::memory_order_relaxed); }

  /// The time since which a value is on the way without an answer of its receiver, by the run's clock in
  /// nanoseconds; -1: there is none. Threads: any.
  [[nodiscard]] std::int64_t sending_since_ns() const {
    return sending_since_ns_.load(std::memory_order_relaxed);
  }

  [[nodiscard]] const LinkedChannel& channel() const { return channel_; }
  [[nodiscard]] network::ProcessNumber peer() const { return sends_ ? channel_.receiver : channel_.sender; }
  [[nodiscard]] network::ProcessNumber own() const { return sends_ ? channel_.sender : channel_.receiver; }
  /// Whether an event waits for the service. Threads: any.
  [[nodiscard]] bool has_news() const { return news_.load(std::memory_order_acquire); }

 protected:
  /// Threads: the service's.
  void set_sending(bool is, Time now) {
    if (is == (sending_since_ns() >= 0)) return;
    sending_since_ns_.store(is ? now.time_since_epoch().count() : -1, std::memory_order_relaxed);
  }
  /// Publishes news: the service that takes it sees everything that happened before.
  void tell() {
    if (!news_.exchange(true, std::memory_order_acq_rel)) service_.wake(channel_.number);
  }
  [[nodiscard]] bool take_news() { return news_.exchange(false, std::memory_order_acq_rel); }
  /// Records the incarnation of the other end, unless it is the one that was recorded last.
  void record_peer(network::Incarnation peer, Time now, RecordingLane* lane);

 private:
  const LinkedChannel channel_;
  const bool sends_;
  Waker& service_;
  std::atomic<bool> news_{false}, disconnected_{true};
  std::atomic<std::int64_t> sending_since_ns_{-1};
  network::Incarnation recorded_;
};

/// The requests of an end to its service.
class LinkServices {
 public:
  virtual ~LinkServices() = default;
  virtual void send(const LinkedChannel& channel, const network::Data& data, const network::Value& value) = 0;
  virtual void send(const LinkedChannel& channel, const network::State& state) = 0;
  /// Receives a message for people. fatal: the run cannot go on.
  virtual void complain(const LinkedChannel& channel, std::string_view text, bool fatal) = 0;
};

}  // namespace tessera
