#pragma once

#include <atomic>
#include <cstdint>

#include "links/network_end.hpp"
#include "links/outbox.hpp"
#include "nets/shared_channel.hpp"
#include "network/repetition.hpp"
#include "network/sender.hpp"

namespace tessera {

/// The end at which a subsystem sends to another process.
///
/// The subsystem numbers its values (`begun_`) before it fires t2, t2n or t2m; the firing publishes the value,
/// so the service never sends a value that the net has not sent. The service ends a blocking send by taking
/// `sent` or `more` and giving `idle`. It does so by a compare-and-swap from a word that it read *before* it
/// looked at `begun_`. If the subsystem has given up and begun another send meanwhile, then either `begun_`
/// shows it, because the word that was read is one after t2, or the word has changed and the swap fails.
///
/// Threads: as NetworkEnd; serve, hear and next are called by the thread of the service alone.
class SendingEnd final : public NetworkEnd {
 public:
  SendingEnd(const LinkedChannel& channel, SharedChannel& word, const ValueEncoding& encoding,
             network::Incarnation incarnation, Waker& service);

  void write(const void* value, Time now, bool valid) override;
  [[nodiscard]] std::uint32_t fired(Firing firing, Time now, RecordingLane* lane) override;

  /// Handles the actions of the subsystem, and sends everything that is due.
  void serve(Time now, LinkServices& services);
  void hear(const network::State& state, Time now, LinkServices& services);
  /// Bytes of the longest encoded value.
  [[nodiscard]] std::size_t longest() const { return encoding_.most; }
  /// When it needs service without news; Time::max(): never.
  [[nodiscard]] Time next() const { return due_; }
  /// Whether a value may still have to be delivered. Threads: the service's.
  [[nodiscard]] bool pending() const { return sender_.pending(); }

 private:
  void take_value(Time now, LinkServices& services);
  void give_up_if_told(Time now, LinkServices& services);
  void acknowledge(network::Incarnation by);
  void send(const network::Sender::Effects& effects, Time now, LinkServices& services);
  void schedule(Time now);

  SharedChannel& word_;
  const ValueEncoding& encoding_;
  Outbox outbox_;
  std::atomic<std::uint64_t> begun_{0};     // the number of the newest value; written by the subsystem
  std::atomic<std::uint64_t> given_up_{0};  // the newest value that timed out; written by the subsystem
  std::atomic<std::uint64_t> taken_by_{0};  // incarnation; written by the service before it gives `idle`

  network::Sender sender_;
  network::Repetition repetition_;
  Time due_ = Time::max();
  bool superseded_ = false;
};

}  // namespace tessera
