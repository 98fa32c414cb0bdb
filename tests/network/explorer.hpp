#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fair_cycle.hpp"
#include "monitor.hpp"
#include "network/receiver.hpp"
#include "network/sender.hpp"

namespace tessera::test {

/// The two sides of the channel.
struct Sides {
  layers::SideMode send, receive;
  [[nodiscard]] bool exchange() const { return !send.blocks && !receive.blocks; }
  /// A receiver that does not wait for ever may skip.
  [[nodiscard]] bool skips() const { return !receive.blocks || receive.timeout; }
  /// The values that are never read may be exchanged ones, or those that were given up.
  bool latest_only = false;  ///< non-blocking at both ends
};

/// How far the exploration goes.
struct Bounds {
  std::uint32_t writes = 2;  ///< of each incarnation of the sender
  std::uint32_t sender_restarts = 0, receiver_restarts = 0;
  std::size_t data = 2, states = 2;  ///< messages on the way at once; any may be lost, repeated, overtaken
  std::size_t most = 3'000'000;      ///< states of the whole
};

/// All behaviour of two sides and a bad network, with the real code.
template <class Sender, class Receiver>
class Explorer {
 public:
  Explorer(Sides sides, Bounds bounds)
      : sides_(sides), bounds_(bounds), monitor_(as_seen(sides.send, bounds), sides.receive) {}

  /// The mistake; empty: there is none. Stops at the first run with a mistake.
  std::string run() {
    Whole first{sender(1), receiver(1)};
    if (!sides_.latest_only) first.net = monitor_.initial();
    visit(first);
    for (std::uint32_t at = 0; at < all_.size() && wrong_.empty(); ++at) {
      if (all_.size() > bounds_.most) return "too large";
      expand(at);
    }
    if (wrong_.empty()) look_for_endless_waits();
    return wrong_;
  }
  [[nodiscard]] std::size_t size() const { return all_.size(); }

 private:
  using Data = network::Data;
  using State = network::State;

  struct Whole {
    Sender sender;
    Receiver receiver;
    std::vector<Data> data{};  // on the way, sorted
    std::vector<State> states{};
    // The observations so far, by values numbered over all incarnations of the sender:
    std::uint64_t read = 0;  // one bit per value
    std::uint64_t last = 0, greatest = 0, acknowledged = 0;
    Monitor::Markings net = 1;
  };

  /// After a restart of its sender, values of both incarnations may be on the way, also of one that waits.
  static layers::SideMode as_seen(layers::SideMode send, const Bounds& bounds) {
    send.timeout = send.timeout || (send.blocks && bounds.sender_restarts > 0);
    return send;
  }
  Sender sender(std::uint64_t incarnation) const {
    network::Sending mode = sides_.send.blocks ? network::Sending::blocking : network::Sending::non_blocking;
    if (sides_.latest_only) mode = network::Sending::exchange;
    return Sender(mode, {incarnation});
  }
  Receiver receiver(std::uint64_t incarnation) const {
    return Receiver(sides_.latest_only ? network::Receiving::exchange : network::Receiving::once,
                    {incarnation});
  }
  std::uint64_t value_of(network::Incarnation sender, network::Number number) const {
    return (sender.value - 1) * bounds_.writes + number.value;
  }

  static std::string packed(const Whole& whole) {
    std::string bytes;
    const auto put = [&](std::uint64_t value) { bytes += static_cast<char>(value); };
    const Sender& s = whole.sender;
    for (const std::uint64_t value : {s.incarnation().value, s.peer().value, s.number().value}) put(value);
    put((s.waiting() ? 1U : 0U) | (s.pending() ? 2U : 0U) | (s.recalling() ? 4U : 0U));
    const Receiver& r = whole.receiver;
    for (const std::uint64_t value : {r.incarnation().value, r.peer().value, r.taken().value, r.slot().value,
                                      whole.read, whole.last, whole.greatest, whole.acknowledged})
      put(value);
    put(whole.data.size());
    for (const Data& one : whole.data) put(code(one));
    for (const State& one : whole.states) put(code(one));
    for (std::size_t byte = 0; byte < 8; ++byte) put(whole.net >> 8 * byte & 0xffU);
    return bytes;
  }
  static std::uint64_t code(const Data& one) {
    return ((one.from.value * 3 + one.to.value) * 5 + one.number.value) * 2 + (one.recall ? 1 : 0);
  }
  static std::uint64_t code(const State& one) {
    return (one.from.value * 3 + one.peer.value) * 5 + one.taken.value;
  }
  /// For messages of both kinds.
  static std::uint32_t message(const Data& one) { return static_cast<std::uint32_t>(code(one)); }
  static std::uint32_t message(const State& one) { return 256 + static_cast<std::uint32_t>(code(one)); }

  std::uint32_t visit(const Whole& whole) {
    const auto [entry, fresh] = numbers_.try_emplace(packed(whole), static_cast<std::uint32_t>(all_.size()));
    if (fresh) {
      all_.push_back(whole);
      graph_.edges.emplace_back();
    }
    return entry->second;
  }

  template <class Message>
  static void add(std::vector<Message>& to, const Message& message, std::size_t most) {
    const auto place = std::ranges::lower_bound(to, message);
    if ((place != to.end() && *place == message) || to.size() >= most) return;  // the latter: lost
    to.insert(place, message);
  }

  /// The whole after a step, with the messages that it sends.
  void go(std::uint32_t from, Whole to, FairGraph::Edge edge, const std::optional<Data>& data = {},
          const std::optional<State>& state = {}) {
    if (to.net == 0) return complain("the trace is no run of the net");
    if (data) {
      add(to.data, *data, bounds_.data);
      edge.sent = message(*data);
    }
    if (state) {
      add(to.states, *state, bounds_.states);
      edge.answered = message(*state);
    }
    edge.to = visit(to);
    graph_.edges[from].push_back(edge);
  }
  void complain(const std::string& what) {
    if (wrong_.empty()) wrong_ = what;
  }

  using Kind = FairGraph::Kind;

  void expand(std::uint32_t at) {
    const Whole now = all_[at];
    send(at, now);
    receive(at, now);
    hear_data(at, now);
    hear_states(at, now);
    restart(at, now);
  }

  void send(std::uint32_t at, const Whole& now) {
    if (!now.sender.waiting() && now.sender.number().value < bounds_.writes) {
      Whole next = now;
      const auto effects = next.sender.write();
      if (!sides_.latest_only) next.net = monitor_.write(now.net);
      go(at, next, {.kind = Kind::user}, effects.send);
    }
    if (now.sender.waiting() && sides_.send.timeout) {
      Whole next = now;
      const auto effects = next.sender.time_is_up();
      next.net = monitor_.time_up(now.net);
      go(at, next, {.kind = Kind::time_up}, effects.send);
    }
    if (now.sender.repeats())
      if (const auto effects = now.sender.repeat(); effects.send)
        go(at, now, {.kind = Kind::repeat}, effects.send);
  }

  void receive(std::uint32_t at, const Whole& now) {
    if (now.receiver.full()) read(at, now);
    if (!now.receiver.full() && sides_.skips() && !sides_.latest_only) {
      Whole next = now;
      next.net = monitor_.skip(now.net);
      go(at, next, {.kind = Kind::user});
    }
    if (now.receiver.repeats()) go(at, now, {.kind = Kind::hello}, {}, now.receiver.repeat().answer);
  }

  void read(std::uint32_t at, const Whole& now) {
    Whole next = now;
    const std::uint64_t value = value_of(now.receiver.peer(), now.receiver.slot());
    if (now.last > value) complain("reads go back");
    if (!sides_.latest_only) {
      if (now.last == value) complain("a value is read twice");
      if (now.acknowledged >= value) complain("an acknowledged value is read again");
      next.net = monitor_.read(now.net);
      next.read |= std::uint64_t{1} << value;
    }
    if (now.greatest > value) complain("reads go back after a restart");
    next.last = value;
    next.greatest = std::max(value, now.greatest);
    next.receiver.begin_read();
    go(at, next_after_read(next), {.kind = Kind::read}, {}, answer_);
  }
  Whole next_after_read(Whole next) {
    answer_ = next.receiver.end_read().answer;
    return next;
  }

  void hear_data(std::uint32_t at, const Whole& now) {
    for (std::size_t index = 0; index < now.data.size(); ++index) {
      Whole gone = now;
      gone.data.erase(gone.data.begin() + static_cast<std::ptrdiff_t>(index));
      go(at, gone, {.kind = Kind::loss});
      for (Whole next : {gone, now}) {  // the network may deliver it again
        const Data& data = now.data[index];
        const auto effects = next.receiver.hear(data);
        if constexpr (requires { next.sender.stop_repeating(); })
          if (effects.keep && data.from == next.sender.incarnation() && data.number == next.sender.number())
            next.sender.stop_repeating();
        go(at, next, {.kind = Kind::arrival, .got = message(data)}, {}, effects.answer);
      }
    }
  }

  void hear_states(std::uint32_t at, const Whole& now) {
    for (std::size_t index = 0; index < now.states.size(); ++index) {
      Whole gone = now;
      gone.states.erase(gone.states.begin() + static_cast<std::ptrdiff_t>(index));
      go(at, gone, {.kind = Kind::loss});
      for (Whole next : {gone, now}) {
        const bool pending = next.sender.pending();
        const auto effects = next.sender.hear(now.states[index]);
        const std::uint64_t value = value_of(now.sender.incarnation(), now.sender.number());
        if (pending && !next.sender.pending()) next.acknowledged = value;
        if (effects.taken) {
          if ((now.read >> value & 1U) == 0) complain("a blocking send ended, and its value was not read");
          next.net = monitor_.acknowledged(now.net);
        }
        go(at, next, {.kind = Kind::arrival, .got = message(now.states[index])}, effects.send);
      }
    }
  }

  void restart(std::uint32_t at, const Whole& now) {
    if (now.sender.incarnation().value <= bounds_.sender_restarts) {
      Whole next = now;
      next.sender = sender(now.sender.incarnation().value + 1);
      if (!sides_.latest_only) next.net = monitor_.sender_restarted(now.net);
      go(at, next, {.kind = Kind::restart});
    }
    if (now.receiver.incarnation().value <= bounds_.receiver_restarts) {
      Whole next = now;
      next.receiver = receiver(now.receiver.incarnation().value + 1);
      next.last = 0;
      if (!sides_.latest_only) next.net = monitor_.receiver_restarted(now.net);
      go(at, next, {.kind = Kind::restart});
    }
  }

  void look_for_endless_waits() {
    std::vector<std::uint32_t> waits, unread;
    for (std::uint32_t at = 0; at < all_.size(); ++at) {
      const Whole& one = all_[at];
      graph_.marks.push_back({one.sender.pending(), one.receiver.full(), one.receiver.repeats()});
      if (one.sender.waiting()) waits.push_back(at);
      if (!one.sender.number().any()) continue;
      const std::uint64_t newest = value_of(one.sender.incarnation(), one.sender.number());
      const bool known = sides_.latest_only ? one.receiver.peer() == one.sender.incarnation() &&
                                                  one.receiver.slot() == one.sender.number()
                                            : (one.read >> newest & 1U) != 0;
      if (!known && !sides_.send.timeout) unread.push_back(at);
    }
    if (has_fair_cycle(graph_, waits)) complain("a blocking sender waits for ever");
    if (has_fair_cycle(graph_, unread)) complain("the newest value is never read");
  }

  Sides sides_;
  Bounds bounds_;
  Monitor monitor_;
  std::vector<Whole> all_;
  FairGraph graph_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::optional<State> answer_;
  std::string wrong_;
};

}  // namespace tessera::test
