#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "links/network_conditions.hpp"
#include "network/carrier.hpp"
#include "system/clock.hpp"

namespace tessera {

/// A network in memory that behaves as its conditions say. All processes are in this program: a value goes to
/// the receiving end of its channel, a state to the sending end. Its behaviour depends only on the seed and
/// on the messages.
///
/// Threads: one.
class SimulatedNetwork final : public network::Carrier {
 public:
  struct Channel {
    network::ProcessNumber sender = 0, receiver = 0;
  };
  /// joined: two processes hear each other from now on, or have not done so for the time `liveliness`.
  using Joined = std::function<void(network::ProcessNumber, network::ProcessNumber, bool)>;
  /// channels: by number. A channel within a process is included, but never used.
  SimulatedNetwork(const NetworkConditions& conditions, std::vector<Cut> cuts, std::vector<Outage> outages,
                   Duration liveliness, std::uint64_t seed, const Clock& clock, std::vector<Channel> channels,
                   Joined joined);

  void send(network::ChannelNumber channel, const network::Data& data, const network::Value& value) override;
  void send(network::ChannelNumber channel, const network::State& state) override;
  /// Delivers everything that has arrived by now. Never waits.
  void receive(Listener& listener, std::chrono::nanoseconds longest) override;
  void wake() override {}

  /// When the next message arrives, or a cut is noticed or over; Time::max(): never.
  [[nodiscard]] Time next() const;
  /// When the last cut is over, and the last process that begins again has done so.
  [[nodiscard]] Time last_cut() const;

 private:
  struct Message {
    network::ChannelNumber channel = 0;
    bool is_state = false;
    network::Data data{};
    network::State state{};
    std::chrono::nanoseconds stamp{0};
    bool valid = false;
    std::vector<std::byte> bytes{};
  };
  struct News {
    network::ProcessNumber one, other;
    bool joined;
  };
  void send(Message message);
  [[nodiscard]] Time arrival(std::size_t lane);
  [[nodiscard]] bool happens(double probability);
  [[nodiscard]] bool is_cut(network::ProcessNumber one, network::ProcessNumber other, Time at) const;
  [[nodiscard]] bool is_dead(network::ProcessNumber process, Time at) const;
  [[nodiscard]] Duration up_to(Duration most);
  void tell_of(const Outage& outage,
               const std::set<std::pair<network::ProcessNumber, network::ProcessNumber>>& pairs);

  NetworkConditions conditions_;
  std::vector<Cut> cuts_;
  std::vector<Outage> outages_;
  Duration liveliness_;
  std::mt19937_64 random_;
  const Clock& clock_;
  std::vector<Channel> channels_;
  Joined joined_;
  std::vector<Time> last_;  // per channel and direction: the arrival of the last message
  std::multimap<Time, Message> on_the_way_;
  std::multimap<Time, News> news_;
};

}  // namespace tessera
