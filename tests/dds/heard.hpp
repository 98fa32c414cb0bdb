#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "network/carrier.hpp"
#include "tests/eventually.hpp"

namespace tessera::test {

/// Keeps the reports of a carrier.
struct Heard final : network::Carrier::Listener {
  struct Message {
    network::ChannelNumber channel = 0;
    network::Data data;
    std::chrono::nanoseconds stamp{0};
    bool valid = false;
    std::vector<std::byte> bytes;
  };
  struct StateMessage {
    network::ChannelNumber channel = 0;
    network::State state;
  };
  struct Change {
    network::ProcessNumber process = 0;
    bool is_there = false;
    bool operator==(const Change&) const = default;
  };
  std::vector<Message> messages;
  std::vector<StateMessage> states;
  std::vector<Change> changes;
  std::vector<std::string> complaints;
  std::map<network::ProcessNumber, network::SignsOfLife> signs;  ///< the newest

  void heard(network::ChannelNumber channel, const network::Data& data,
             const network::Value& value) override {
    messages.push_back({channel, data, value.stamp, value.valid, {value.bytes.begin(), value.bytes.end()}});
  }
  void heard(network::ChannelNumber channel, const network::State& state) override {
    states.push_back({channel, state});
  }
  void reachable(network::ProcessNumber process, bool is_there) override {
    changes.push_back({process, is_there});
  }
  void alive(network::ProcessNumber process, const network::SignsOfLife& its) override {
    signs[process] = its;
  }
  void complaint(std::string_view text) override { complaints.emplace_back(text); }

  [[nodiscard]] bool sees(network::ProcessNumber process) const {
    const auto last = std::find_if(changes.rbegin(), changes.rend(),
                                   [&](const Change& change) { return change.process == process; });
    return last != changes.rend() && last->is_there;
  }
  [[nodiscard]] bool has_complaint(std::string_view part) const {
    return std::ranges::any_of(complaints,
                               [&](const std::string& one) { return one.find(part) != std::string::npos; });
  }
};

/// A carrier and its reports.
struct Station {
  explicit Station(network::Carrier& its_carrier) : carrier(its_carrier) {}
  void receive(std::chrono::milliseconds longest = std::chrono::milliseconds(2)) {
    carrier.receive(heard, longest);
  }
  network::Carrier& carrier;
  Heard heard;
};

/// Lets all receive until it holds.
template <class Condition, class... Stations>
[[nodiscard]] bool receive_until(Condition condition, Stations&... stations) {
  return eventually([&] {
    (stations.receive(), ...);
    return condition();
  });
}

}  // namespace tessera::test
