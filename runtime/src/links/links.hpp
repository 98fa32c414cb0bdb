#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "links/link_gauges.hpp"
#include "links/receiving_end.hpp"
#include "links/sending_end.hpp"
#include "network/carrier.hpp"
#include "system/clock.hpp"
#include "tessera/context.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// All ends of channels to other processes, and the carrier of their messages. One thread serves them; under
/// the simulated clock, the one that runs everything.
///
/// Threads: the service's, unless said otherwise; add_... before the run.
class Links final : public Waker, private network::Carrier::Listener, private LinkServices {
 public:
  /// complain: receives a message for people. fatal: the run cannot go on.
  using Complain = std::function<void(std::string_view text, bool fatal)>;
  Links(const Clock& clock, std::uint32_t channels, Complain complain);
  ~Links() override;

  SendingEnd& add_sender(const LinkedChannel& channel, SharedChannel& word, const ValueEncoding& encoding,
                         network::Incarnation incarnation);
  ReceivingEnd& add_receiver(const LinkedChannel& channel, SharedChannel& word, const ValueEncoding& encoding,
                             std::size_t value_bytes, const ValueType* type,
                             network::Incarnation incarnation);
  /// A simulated process of this program has died: its ends become inactive. New ones replace them.
  void kill(network::ProcessNumber process);
  /// The channels of all ends, in the form that a carrier needs.
  [[nodiscard]] std::vector<network::ChannelSetup> carried() const;
  void connect(network::Carrier& carrier) { carrier_ = &carrier; }
  /// origin_ns: SteadyClock::absolute_ns of time zero, so that processes of one host understand each other's
  /// stamps; 0 under the simulated clock. Threads: any.
  void set_origin(std::int64_t origin_ns) { origin_.store(Duration(origin_ns), std::memory_order_relaxed); }

  /// Takes the messages that have arrived, serves the ends that have news, and sends everything that is due.
  /// Waits for work until `until`, if the carrier waits.
  void serve(Time until);
  /// Whether an end has news, or some work is due.
  [[nodiscard]] bool has_work(Time now) const;
  /// When work is due without news; Time::max(): never.
  [[nodiscard]] Time next() const;
  /// Whether some value may still have to be delivered.
  [[nodiscard]] bool pending() const;

  /// Ends a wait of serve. Threads: any.
  void wake(std::uint32_t channel) override;
  /// The gauges of each process with which a channel is shared, in the order of their numbers. Threads: any,
  /// once all ends are made.
  [[nodiscard]] const std::vector<std::unique_ptr<LinkGauges>>& gauges() const { return gauges_; }
  /// The processes can hear each other from now on, or no longer.
  void joined(network::ProcessNumber one, network::ProcessNumber other, bool are);

 private:
  // network::Carrier::Listener
  void heard(network::ChannelNumber channel, const network::Data& data, const network::Value& value) override;
  void heard(network::ChannelNumber channel, const network::State& state) override;
  void reachable(network::ProcessNumber process, bool is_there) override;
  void alive(network::ProcessNumber process, const network::SignsOfLife& signs) override;
  void complaint(std::string_view text) override;
  // LinkServices
  void send(const LinkedChannel& channel, const network::Data& data, const network::Value& value) override;
  void send(const LinkedChannel& channel, const network::State& state) override;
  void complain(const LinkedChannel& channel, std::string_view text, bool fatal) override;

  [[nodiscard]] std::chrono::nanoseconds stamp_to_send(const LinkedChannel& channel,
                                                       std::chrono::nanoseconds stamp) const;
  [[nodiscard]] Time stamp_of(const LinkedChannel& channel, std::chrono::nanoseconds sent) const;

  const Clock& clock_;
  Complain complain_;
  network::Carrier* carrier_ = nullptr;
  std::atomic<Duration> origin_{Duration{0}};
  std::vector<std::unique_ptr<SendingEnd>> senders_;
  std::vector<std::unique_ptr<ReceivingEnd>> receivers_;
  void add_gauges(network::ProcessNumber peer, std::uint32_t channel, Side side);
  /// The newest message of a channel, to recognise a repeated one.
  struct Newest {
    LinkGauges* link = nullptr;  ///< to the process at the other end
    network::Incarnation from;
    network::Number number;
    bool recall = false;
    /// Whether the message is no newer one.
    bool again(const network::Data& data);
  };

  std::vector<std::unique_ptr<NetworkEnd>> dead_;  // ends of dead processes, still readable
  std::vector<std::unique_ptr<LinkGauges>> gauges_;
  std::vector<Newest> sent_, received_;     // per channel; nullptr: that end is in another process
  std::vector<SendingEnd*> sender_of_;      // per channel; nullptr: it is in another process
  std::vector<ReceivingEnd*> receiver_of_;  // the same
};

}  // namespace tessera
