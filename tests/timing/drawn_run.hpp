// A drawn system on the runtime, under the simulated clock and with `takes` as it draws it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "named_net.hpp"
#include "nets/flat_net.hpp"
#include "reference.hpp"
#include "tessera/buffer.hpp"
#include "tessera/controller.hpp"

namespace tessera::timing_test {

inline constexpr std::int64_t tick_ns = 1'000'000;
inline constexpr std::size_t most_chains = 4, most_subsystems = 12;

/// A value: when the device was read that it comes from, chain by chain.
struct Origins {
  std::array<std::int64_t, most_chains> sampled;
  bool filled;
};

struct Command {
  std::int64_t given = 0, sampled = 0;
};

/// A drawn system, and what a run of it shows.
struct Observed {
  ::timing::Case drawn;
  bool longest = false;  ///< each call takes as long as it may; else the runtime draws
  std::array<std::vector<std::int64_t>, most_subsystems> called;
  std::array<std::vector<Command>, most_chains> commands;
  std::array<std::vector<std::int64_t>, most_chains> samples;
  std::vector<std::uint64_t> send_timeouts, receive_timeouts;

  [[nodiscard]] const ::timing::Net& net() const { return drawn.net; }
  [[nodiscard]] timing::Time least_time_of(std::size_t subsystem) const {
    return longest ? net().subsystems[subsystem].wcet : net().subsystems[subsystem].bcet;
  }
  [[nodiscard]] std::uint32_t first_of(std::size_t chain) const {
    return static_cast<std::uint32_t>(net().channels[drawn.chains[chain].front()].from);
  }
  [[nodiscard]] std::uint32_t last_of(std::size_t chain) const {
    return static_cast<std::uint32_t>(net().channels[drawn.chains[chain].back()].to);
  }
};
inline Observed* observed = nullptr;

/// The name of the port at each end of a channel.
inline std::string_view port_of(std::size_t channel) {
  static std::deque<std::string> names;
  while (names.size() <= channel) names.push_back("c" + std::to_string(names.size()));
  return names[channel];
}

/// Hands on when its inputs were sampled.
class Passing final : public Subsystem {
 public:
  explicit Passing(std::uint32_t index)
      : index_(index), inputs_(mine().receives.size()), outputs_(mine().sends.size()) {}
  void bind(Bindings& bindings) override {
    for (std::size_t k = 0; k < inputs_.size(); ++k) bindings.input(port_of(mine().receives[k]), inputs_[k]);
    for (std::size_t k = 0; k < outputs_.size(); ++k) bindings.output(port_of(mine().sends[k]), outputs_[k]);
  }
  void call(std::uint16_t) override {
    Observed& seen = *observed;
    const std::int64_t now = context_.now.time_since_epoch().count();
    seen.called[index_].push_back(now);
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      seen.receive_timeouts[mine().receives[k]] += inputs_[k].timed_out ? 1 : 0;
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      seen.send_timeouts[mine().sends[k]] += outputs_[k].timed_out ? 1 : 0;
      outputs_[k].filled = true;
    }
    for (std::size_t chain = 0; chain < seen.drawn.chains.size(); ++chain) {
      const ::timing::Chain& channels = seen.drawn.chains[chain];
      if (seen.first_of(chain) == index_) {
        seen.samples[chain].push_back(now);
        output(channels.front())->sampled[chain] = now;
      }
      for (std::size_t hop = 1; hop < channels.size(); ++hop)
        if (Output<Origins>* const next = output(channels[hop]))
          next->sampled[chain] = sampled(channels[hop - 1], chain);
      if (seen.last_of(chain) == index_ && sampled(channels.back(), chain) >= 0)
        seen.commands[chain].push_back({now, sampled(channels.back(), chain)});
    }
  }
  Outcome decide(std::uint16_t, bool) override { return Outcome::go_on; }
  int route(std::uint16_t, bool) override { return 0; }
  void keep_outputs() override {}
  void restore_outputs() override {}
  Context& context() override { return context_; }

 private:
  [[nodiscard]] const ::timing::Subsystem& mine() const { return observed->net().subsystems[index_]; }
  [[nodiscard]] Output<Origins>* output(int channel) {
    for (std::size_t k = 0; k < outputs_.size(); ++k)
      if (mine().sends[k] == channel) return &outputs_[k];
    return nullptr;
  }
  /// Less than 0: nothing has come yet.
  [[nodiscard]] std::int64_t sampled(int channel, std::size_t chain) const {
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      if (mine().receives[k] == channel) return inputs_[k].filled ? inputs_[k].sampled[chain] : -1;
    return -1;
  }

  std::uint32_t index_;
  std::vector<Input<Origins>> inputs_;
  std::vector<Output<Origins>> outputs_;
  Context context_;
};

template <std::uint32_t... index>
constexpr auto makers(std::integer_sequence<std::uint32_t, index...>) {
  return std::array{+[]() -> std::unique_ptr<Subsystem> { return std::make_unique<Passing>(index); }...};
}
inline constexpr auto make = makers(std::make_integer_sequence<std::uint32_t, most_subsystems>{});

/// The rows of one subsystem with a single behaviour.
class SubsystemRows {
 public:
  SubsystemRows(const Observed& seen, std::size_t index) : net_(seen.net()) {
    const ::timing::Subsystem& one = net_.subsystems[index];
    behaviours_.push_back(
        {"run", Duration(seen.least_time_of(index) * tick_ns), Duration(one.wcet * tick_ns)});
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
    page(one.sends, "run.snd.", one.parallel);
    page(one.receives, "run.rcv.", one.parallel);
    net_of_it_ = testing::numbered(behaviours_, ports_, places_, transitions_);
  }
  [[nodiscard]] const SubsystemNet* net() const { return &net_of_it_; }
  [[nodiscard]] std::uint16_t port(std::size_t channel) const {
    return testing::named::number_of(ports_, port_of(channel));
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
  void place(const std::string& name, testing::named::Does does = {}) {
    places_.push_back({keep(name), does});
  }
  void arc(const std::string& name, const Names& in, const Names& out, testing::named::Guard guard = {}) {
    transitions_.push_back({keep(name), list_of(in), list_of(out), guard});
  }
  void page(const std::vector<int>& channels, const std::string& page, bool parallel) {
    if (channels.empty()) return arc(page + "t1", {page + "in"}, {page + "out"});
    const bool sends = page == "run.snd.", forks = parallel && channels.size() > 1;
    Names forked, joined;
    std::string at = page + "in";
    for (const int channel : channels) {
      const std::string port(port_of(channel)), block = page + port;
      ports_.push_back({port_of(channel), sends ? Side::send : Side::receive, port_of(channel)});
      std::string to = page + "out";
      if (forks) forked.push_back(at = block + ".in");
      if (forks) place(at);
      if (forks || channel != channels.back()) place(to = block + ".out");
      if (forks) joined.push_back(to);
      sends ? send(channel, block + ".", at, to) : receive(channel, block + ".", at, to);
      at = to;
    }
    if (!forks) return;
    arc(page + "fork", {page + "in"}, forked);
    arc(page + "join", joined, {page + "out"});
  }
  [[nodiscard]] bool is_asynchronous(int channel) const { return net_.channels[channel].asynchronous(); }
  void take_lock(const std::string& block, const std::string& in, const std::string& out,
                 const std::string& lock) {
    arc(block + "t1", {in, lock}, {block + "2"});
    arc(block + "t2", {block + "2"}, {out, lock});
  }
  void send(int channel, const std::string& block, const std::string& in, const std::string& out) {
    const std::string port(port_of(channel)), empty = port + "/empty", full = port + "/full";
    place(block + "2", testing::named::writes(port_of(channel)));
    if (is_asynchronous(channel)) return take_lock(block, in, out, port + "/channel");
    arc(block + "t1", {in, empty}, {block + "2"});
    if (!net_.channels[channel].send_blocks) {
      arc(block + "t1o", {in, full}, {block + "2"});
      return arc(block + "t2", {block + "2"}, {out, full});
    }
    place(block + "wait");
    arc(block + "t2", {block + "2"}, {block + "wait", full});
    arc(block + "t3", {block + "wait", port + "/ack"}, {out});
    if (net_.channels[channel].send_timeout > 0)
      arc(block + "timeout", {block + "wait", full}, {out, empty}, if_elapsed);
  }
  void receive(int channel, const std::string& block, const std::string& in, const std::string& out) {
    const std::string port(port_of(channel)), empty = port + "/empty";
    const ::timing::Channel& one = net_.channels[channel];
    place(block + "2", testing::named::reads(port_of(channel)));
    if (is_asynchronous(channel)) return take_lock(block, in, out, port + "/channel");
    arc(block + "t1", {in, port + "/full"}, {block + "2"});
    Names after{out, empty};
    if (one.send_blocks) after.push_back(port + "/ack");
    arc(block + "t2", {block + "2"}, after);
    if (!one.receive_blocks) arc(block + "skip", {in, empty}, {out, empty});
    if (one.receive_blocks && one.receive_timeout > 0)
      arc(block + "timeout", {in, empty}, {out, empty}, if_elapsed);
  }

  const ::timing::Net& net_;
  std::vector<Behaviour> behaviours_;
  std::vector<Port> ports_;
  std::vector<testing::named::Place> places_;
  std::vector<testing::named::Transition> transitions_;
  std::deque<std::string> texts_;
  std::deque<std::vector<std::string_view>> lists_;
  SubsystemNet net_of_it_{};
};

/// false: the run has not begun.
/// scenario: the times of calls and the order of turns; null: they are drawn.
[[nodiscard]] inline bool run(Observed& seen, std::uint64_t seed, ::timing::Tick until, bool interleave,
                              nlohmann::json scenario = nullptr) {
  const ::timing::Net& net = seen.net();
  observed = &seen;
  seen.send_timeouts.assign(net.channels.size(), 0);
  seen.receive_timeouts = seen.send_timeouts;
  std::deque<SubsystemRows> rows;
  std::deque<std::string> names;
  std::vector<Instance> instances;
  for (std::size_t i = 0; i < net.subsystems.size(); ++i) {
    Policies policies;
    policies.overrun = net.subsystems[i].catch_up ? Overrun::catch_up : Overrun::skip;
    instances.push_back({names.emplace_back("a" + std::to_string(i)), "control", Kind::control,
                         rows.emplace_back(seen, i).net(), make[i],
                         Duration(net.subsystems[i].period * tick_ns), Duration(0), policies});
  }
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < net.channels.size(); ++c) {
    const ::timing::Channel& one = net.channels[c];
    const auto from = static_cast<std::uint32_t>(one.from), to = static_cast<std::uint32_t>(one.to);
    const std::span<const FusedPlace> memory =
        one.asynchronous() ? std::span<const FusedPlace>(testing::asynchronous)
        : one.send_blocks  ? std::span<const FusedPlace>(testing::acknowledged)
                           : std::span<const FusedPlace>(testing::buffered);
    channels.push_back({port_of(c),
                        {from, rows[from].port(c)},
                        {to, rows[to].port(c)},
                        memory,
                        Duration(one.send_timeout * tick_ns),
                        Duration(one.receive_timeout * tick_ns)});
  }
  System system{tables_version,       "drawn", "", "", {}, instances, channels, &testing::system_page,
                &testing::agent_page, {},      {}};
  const std::string hash = net_of(system).hash();
  system.net_hash = hash;
  RunOptions options;
  options.duration = Duration(until * tick_ns);
  options.seed = seed;
  options.interleave = interleave;
  if (!scenario.is_null()) {
    scenario["net_hash"] = hash;
    options.scenario = ::testing::TempDir() + "tessera_worst_run_" + std::to_string(getpid()) + ".json";
    std::ofstream(options.scenario) << scenario;
  }
  std::string error;
  const std::optional<RunSummary> summary = execute(system, options, error);
  if (!options.scenario.empty()) std::filesystem::remove(options.scenario);
  EXPECT_TRUE(summary) << error;
  return summary.has_value();
}

}  // namespace tessera::timing_test
