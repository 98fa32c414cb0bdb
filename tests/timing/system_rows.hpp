// The tables of a system of subsystems with one behaviour each, also in several processes.
#pragma once

#include <bit>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "named_net.hpp"
#include "timing/system.hpp"

namespace tessera::timing_test {

/// The name of the port at each end of a channel.
inline std::string_view port_named(std::size_t channel) {
  static std::deque<std::string> names;
  while (names.size() <= channel) names.push_back("c" + std::to_string(names.size()));
  return names[channel];
}

/// Non-blocking at both ends.
inline bool is_exchange(const timing::Channel& channel) {
  return !channel.send_blocks && !channel.receive_blocks;
}

/// The rows of one subsystem. Its nets at channels are those that src/layers draws, within a process and between two.
class SystemRows {
 public:
  SystemRows(const timing::System& system, std::uint32_t index) : system_(system) {
    const timing::Subsystem& one = system_.subsystems[index];
    behaviours_.push_back({"run", Duration(one.shortest), Duration(one.longest)});
    namespace rows = testing::named;
    places_ = {{"in"},
               {"out"},
               {"run.in", rows::calls("run")},
               {"run.snd.in"},
               {"run.snd.out"},
               {"run.2", rows::counts()},
               {"run.rcv.in"},
               {"run.rcv.out", rows::decides("run")},
               {"run.out", rows::routes("run")}};
    arc("t_in", {"in"}, {"run.in"});
    arc("run.t1", {"run.in"}, {"run.snd.in"});
    arc("run.t2", {"run.snd.out"}, {"run.2"});
    arc("run.t3", {"run.2"}, {"run.rcv.in"});
    arc("run.t4", {"run.rcv.out"}, {"run.in"}, if_go_on);
    arc("run.t5", {"run.rcv.out"}, {"run.out"}, if_terminal);
    arc("run.t6", {"run.rcv.out"}, {"run.out"}, if_error);
    arc("t_run_1", {"run.out"}, {"out"}, if_next(0));
    page(one.sends, "run.snd.");
    page(one.receives, "run.rcv.");
    net_ = testing::numbered(behaviours_, ports_, places_, transitions_, testing::networked);
  }
  [[nodiscard]] const SubsystemNet* net() const { return &net_; }
  [[nodiscard]] std::uint16_t port(std::size_t channel) const {
    return testing::named::number_of(ports_, port_named(channel));
  }

 private:
  using Names = std::vector<std::string>;
  std::string_view keep(const std::string& text) { return texts_.emplace_back(text); }
  /// A program cannot write a list of a number of elements that only the running program knows.
  std::initializer_list<std::string_view> list_of(const Names& names) {
    std::vector<std::string_view>& kept = lists_.emplace_back();
    for (const std::string& name : names) kept.push_back(keep(name));
    struct List {
      const std::string_view* first;
      std::size_t count;
    };
    return std::bit_cast<std::initializer_list<std::string_view>>(List{kept.data(), kept.size()});
  }
  void arc(const std::string& name, const Names& in, const Names& out, testing::named::Guard guard = {}) {
    transitions_.push_back({keep(name), list_of(in), list_of(out), guard});
  }
  void page(const std::vector<std::uint32_t>& channels, const std::string& page) {
    if (channels.empty()) return arc(page + "t1", {page + "in"}, {page + "out"});
    const bool sends = page == "run.snd.";
    std::string at = page + "in";
    for (const std::uint32_t channel : channels) {
      const std::string port(port_named(channel)), block = page + port;
      ports_.push_back({port_named(channel), sends ? Side::send : Side::receive, port_named(channel)});
      std::string to = page + "out";
      if (channel != channels.back()) places_.push_back({keep(to = block + ".out")});
      places_.push_back({keep(block + ".2"), sends ? testing::named::writes(port_named(channel))
                                                   : testing::named::reads(port_named(channel))});
      sends ? send(channel, block + ".", at, to) : receive(channel, block + ".", at, to);
      at = to;
    }
  }
  /// A place that both ends of a channel know, by its number. `numbered` knows the names of one kind of channel only.
  static std::string shared(const std::string& port, std::size_t number) {
    return port + '/' + std::string(testing::networked[number].name);
  }
  void take_lock(const std::string& block, const std::string& in, const std::string& out,
                 const std::string& lock) {
    arc(block + "t1", {in, lock}, {block + "2"});
    arc(block + "t2", {block + "2"}, {out, lock});
  }
  void send(std::uint32_t channel, const std::string& block, const std::string& in, const std::string& out) {
    const std::string port(port_named(channel));
    const std::string empty = shared(port, 0), full = shared(port, 1), ack = shared(port, 2);
    const timing::Channel& one = system_.channels[channel];
    const bool crosses = system_.crosses(channel);
    if (is_exchange(one)) return take_lock(block, in, out, shared(port, 0));
    if (crosses) return send_away(one, port, block, in, out);
    arc(block + "t1", {in, empty}, {block + "2"});
    if (!one.send_blocks) {
      arc(block + "t1o", {in, full}, {block + "2"});
      return arc(block + "t2", {block + "2"}, {out, full});
    }
    places_.push_back({keep(block + "wait")});
    arc(block + "t2", {block + "2"}, {block + "wait", full});
    arc(block + "t3", {block + "wait", ack}, {out});
    if (one.send_timeout > 0) arc(block + "timeout", {block + "wait", full}, {out, empty}, if_elapsed);
  }
  /// To another process.
  void send_away(const timing::Channel& one, const std::string& port, const std::string& block,
                 const std::string& in, const std::string& out) {
    const std::string idle = shared(port, 0), sent = shared(port, 1), empty = shared(port, 2),
                      full = shared(port, 3), more = shared(port, 4), wait = block + "wait";
    arc(block + "t1", {in}, {block + "2"});
    if (one.send_blocks) places_.push_back({keep(wait)});
    const std::string& after = one.send_blocks ? wait : out;
    arc(block + "t2", {block + "2", idle}, {after, sent});
    if (!one.send_blocks || one.send_timeout > 0) {
      arc(block + "t2n", {block + "2", sent}, {after, more});
      arc(block + "t2m", {block + "2", more}, {after, more});
    }
    if (!one.send_blocks) return;
    arc(block + "t3", {wait, idle, empty}, {out, idle, empty});
    if (one.send_timeout <= 0) return;
    arc(block + "timeout", {wait}, {out}, testing::named::if_elapsed_at(keep(port)));
    arc(block + "withdraw", {wait, sent}, {out, idle}, if_elapsed);
    arc(block + "withdraw_m", {wait, more}, {out, sent}, if_elapsed);
    arc(block + "recall", {wait, idle, full}, {out, idle, empty}, if_elapsed);
  }
  void receive(std::uint32_t channel, const std::string& block, const std::string& in,
               const std::string& out) {
    const std::string port(port_named(channel));
    const timing::Channel& one = system_.channels[channel];
    const bool crosses = system_.crosses(channel);
    if (is_exchange(one)) return take_lock(block, in, out, shared(port, crosses ? 1 : 0));
    const std::string empty = shared(port, crosses ? 2 : 0), full = shared(port, crosses ? 3 : 1);
    arc(block + "t1", {in, full}, {block + "2"});
    Names after{out, empty};
    if (one.send_blocks && !crosses) after.push_back(shared(port, 2));
    arc(block + "t2", {block + "2"}, after);
    if (!one.receive_blocks) arc(block + "skip", {in, empty}, {out, empty});
    if (one.receive_blocks && one.receive_timeout > 0)
      arc(block + "timeout", {in, empty}, {out, empty}, if_elapsed);
  }

  const timing::System& system_;
  std::vector<Behaviour> behaviours_;
  std::vector<Port> ports_;
  std::vector<testing::named::Place> places_;
  std::vector<testing::named::Transition> transitions_;
  std::deque<std::string> texts_;
  std::deque<std::vector<std::string_view>> lists_;
  SubsystemNet net_{};
};

/// The places that both ends of a channel know.
inline std::span<const FusedPlace> places_between(const timing::System& system, std::uint32_t channel) {
  const timing::Channel& one = system.channels[channel];
  if (!system.crosses(channel)) {
    if (is_exchange(one)) return testing::asynchronous;
    return one.send_blocks ? std::span<const FusedPlace>(testing::acknowledged) : testing::buffered;
  }
  if (is_exchange(one)) return testing::networked_exchange;
  return one.send_blocks && one.send_timeout == 0 ? std::span<const FusedPlace>(testing::networked_single)
                                                  : testing::networked;
}

}  // namespace tessera::timing_test
