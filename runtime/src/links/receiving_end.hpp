#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "links/network_end.hpp"
#include "nets/shared_channel.hpp"
#include "network/receiver.hpp"
#include "network/repetition.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// The end at which a subsystem receives from another process.
///
/// Before the service accesses a value, it takes the token of the slot (`empty`, `full`, or the lock of the
/// memory). It gives back `full` if there is a value to read then. If no token is there, the subsystem is
/// reading; the value waits in `held_`. The token passes through the word, whose compare-and-swaps acquire
/// and release, so the slot, `number_` and `from_` need no atomics.
///
/// Threads: as NetworkEnd; serve, hear and next are called by the thread of the service alone.
class ReceivingEnd final : public NetworkEnd {
 public:
  ReceivingEnd(const LinkedChannel& channel, SharedChannel& word, const ValueEncoding& encoding,
               std::size_t value_bytes, const ValueType* type, network::Incarnation incarnation,
               Waker& service);
  ~ReceivingEnd() override;

  void write(const void* /*value*/, Time /*now*/, bool /*valid*/) override {}
  [[nodiscard]] std::uint32_t fired(Firing firing, Time now, RecordingLane* lane) override;

  void serve(Time now, LinkServices& services);
  /// stamp: when the value was written, by the clock of this process.
  void hear(const network::Data& data, const network::Value& value, Time stamp, Time now,
            LinkServices& services);
  /// Bytes of the longest encoded value.
  [[nodiscard]] std::size_t longest() const { return encoding_.most; }
  /// When it needs service without news; Time::max(): never.
  [[nodiscard]] Time next() const { return held_.any ? std::min(announce_, look_) : announce_; }

 private:
  /// A message that came while the slot was being read.
  struct Held {
    bool any = false;
    network::Data data;
    Time stamp{};
    bool valid = false;
    std::vector<std::byte> bytes;
  };
  void hold(const network::Data& data, const network::Value& value, Time stamp, Time now);
  void accept(const network::Data& data, const network::Value& value, Time stamp, LinkServices& services);
  void take_held(Time now, LinkServices& services);
  void finish_read(LinkServices& services);
  void end_read(LinkServices& services);
  [[nodiscard]] bool seize(LinkServices& services);
  void release();
  void keep(const network::Data& data, bool valid, Time stamp);
  void answer(const network::Receiver::Effects& effects, LinkServices& services);
  void announce(Time now, LinkServices& services);

  SharedChannel& word_;
  const ValueEncoding& encoding_;
  const ValueType* type_;
  SharedChannel::Memory decoded_;  // a value that may turn out invalid
  std::uint64_t number_ = 0;       // of the value in the slot
  network::Incarnation from_;      // the incarnation that has sent it
  std::uint32_t reading_ = 0;      // used by the subsystem only

  network::Receiver receiver_;
  network::Repetition repetition_;
  Held held_;
  Time announce_{}, look_{};  // when it announces itself, and when it checks the slot again
  bool undecodable_ = false;
};

}  // namespace tessera
