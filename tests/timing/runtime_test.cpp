// Random systems on the runtime, under the simulated clock and with `takes` as it draws it, beside their bounds.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <string>
#include <utility>

#include "named_net.hpp"
#include "nets/flat_net.hpp"
#include "reference.hpp"
#include "replay/times/ages.hpp"
#include "tessera/buffer.hpp"
#include "tessera/controller.hpp"
#include "tessera/recording.hpp"

namespace tessera::timing_test {
namespace {

using timing::Bounds;
using timing::ChainBound;
using timing::Occurrences;
using timing::unbounded;

constexpr std::int64_t tick_ns = 1'000'000;
constexpr std::size_t most_chains = 4, most_subsystems = 8;

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
  std::vector<ChainTimes> measured;  ///< by the run itself, chain by chain

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
Observed* observed = nullptr;

/// The name of the port at each end of a channel.
std::string_view port_of(std::size_t channel) {
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
constexpr auto make = makers(std::make_integer_sequence<std::uint32_t, most_subsystems>{});

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

/// A program cannot write a list of a number of elements that only the running program knows. all: outlives it.
std::initializer_list<std::uint32_t> list_of(const std::vector<std::uint32_t>& all) {
  struct List {
    const std::uint32_t* first;
    std::size_t count;
  };
  return std::bit_cast<std::initializer_list<std::uint32_t>>(List{all.data(), all.size()});
}

std::string chain_name(std::size_t chain) { return "chain " + std::to_string(chain); }

/// The rows of the chains, with their bounds.
struct ChainRows {
  ChainRows(const Observed& seen, const Bounds& bounds) {
    for (std::size_t chain = 0; chain < seen.drawn.chains.size(); ++chain) {
      const timing::Chain& channels = channels_.emplace_back(timing::chain_of(seen.drawn.chains[chain]));
      const ChainBound bound = bounds.chain(channels);
      const auto proved = [](timing::Time most) { return Duration(most >= unbounded ? 0 : most * tick_ns); };
      chains.push_back({names_.emplace_back(chain_name(chain)), proved(bound.age), proved(bound.reaction)});
      ways.push_back({static_cast<std::uint32_t>(chain), list_of(channels)});
    }
  }
  std::vector<tessera::Chain> chains;
  std::vector<ChainWay> ways;

 private:
  std::deque<timing::Chain> channels_;
  std::deque<std::string> names_;
};

/// recording: its file; empty: none. false: the run has not begun.
[[nodiscard]] bool run(Observed& seen, const Bounds& bounds, std::uint64_t seed, ::timing::Tick until,
                       bool interleave, const std::string& recording) {
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
  const ChainRows chain_rows(seen, bounds);
  system.chains = chain_rows.chains;
  system.chain_ways = chain_rows.ways;
  const std::string hash = net_of(system).hash();
  system.net_hash = hash;
  RunOptions options;
  options.duration = Duration(until * tick_ns);
  options.seed = seed;
  options.interleave = interleave;
  options.recording = recording;
  std::string error;
  const std::optional<RunSummary> summary = execute(system, options, error);
  EXPECT_TRUE(summary) << error;
  if (summary) seen.measured = summary->chains;
  return summary.has_value();
}

void hold(const char* what, std::size_t index, std::int64_t most_ns, timing::Time bound) {
  EXPECT_LE(most_ns, bound >= unbounded ? INT64_MAX : bound * tick_ns) << what << " " << index;
}

void hold_subsystems(const Observed& seen, const Occurrences& bounds) {
  for (std::uint32_t i = 0; i < seen.net().subsystems.size(); ++i) {
    const ::timing::Subsystem& one = seen.net().subsystems[i];
    if (one.period == 0 || (one.catch_up && !bounds.never_overruns(i))) continue;
    std::int64_t gap = 0;
    for (std::size_t k = 1; k < seen.called[i].size(); ++k)
      gap = std::max(gap, seen.called[i][k] - seen.called[i][k - 1]);
    hold("time between calls of", i, gap, bounds.gap(bounds.events().start(i)));
    if (bounds.periodic(i)) hold("period of", i, gap, one.period);
  }
}

void hold_timeouts(const Observed& seen, const Occurrences& bounds) {
  for (std::uint32_t c = 0; c < seen.net().channels.size(); ++c) {
    const ::timing::Channel& one = seen.net().channels[c];
    if (one.send_blocks && one.send_timeout > 0 && bounds.timeout_never_fires(bounds.events().acked(c))) {
      EXPECT_EQ(seen.send_timeouts[c], 0U) << "channel " << c;
    }
    if (one.receive_blocks && one.receive_timeout > 0 &&
        bounds.timeout_never_fires(bounds.events().read(c))) {
      EXPECT_EQ(seen.receive_timeouts[c], 0U) << "channel " << c;
    }
  }
}

/// A command is given when the last transition function ends. The runtime tells when it begins, so that the least
/// time of a call is added.
void hold_chains(const Observed& seen, const Bounds& bounds) {
  for (std::size_t chain = 0; chain < seen.drawn.chains.size(); ++chain) {
    const ChainBound bound = bounds.chain(timing::chain_of(seen.drawn.chains[chain]));
    const timing::Time least = seen.least_time_of(seen.last_of(chain));
    const std::vector<Command>& commands = seen.commands[chain];
    std::int64_t age = 0, reaction = 0;
    for (const Command& command : commands) age = std::max(age, command.given - command.sampled);
    std::size_t at = 0;
    for (const std::int64_t sample : seen.samples[chain]) {
      while (at < commands.size() && commands[at].sampled <= sample) ++at;
      if (at == commands.size()) break;
      reaction = std::max(reaction, commands[at].given - sample);
    }
    hold("age of chain", chain, age + least * tick_ns, bound.age);
    hold("reaction of chain", chain, reaction + least * tick_ns, bound.reaction);
  }
}

/// What the run itself has measured exceeds no bound.
void hold_measured(const Observed& seen) {
  ASSERT_EQ(seen.measured.size(), seen.drawn.chains.size());
  for (const ChainTimes& chain : seen.measured) {
    EXPECT_EQ(chain.over, 0U) << chain.name;
    if (chain.proved_age && chain.longest_age) {
      EXPECT_LE(*chain.longest_age, *chain.proved_age) << chain.name;
    }
    if (chain.proved_reaction && chain.longest_reaction) {
      EXPECT_LE(*chain.longest_reaction, *chain.proved_reaction) << chain.name;
    }
  }
}

/// What the run itself has measured is what its recording tells.
void compare_with_recording(const Observed& seen, const std::string& file) {
  std::vector<replay::MeasuredChain> chains;
  for (std::size_t chain = 0; chain < seen.drawn.chains.size(); ++chain) {
    replay::MeasuredChain& one = chains.emplace_back();
    one.name = one.group = chain_name(chain);
    std::vector<std::string>& way = one.ways.emplace_back();
    const auto name_of = [](int subsystem) { return "a" + std::to_string(subsystem) + ".control"; };
    one.subsystems.push_back(name_of(static_cast<int>(seen.first_of(chain))));
    for (const int channel : seen.drawn.chains[chain]) {
      one.subsystems.push_back(name_of(seen.net().channels[static_cast<std::size_t>(channel)].to));
      way.emplace_back(port_of(static_cast<std::size_t>(channel)));
    }
  }
  std::string error;
  const std::optional<Recording> recording = read_recording(file, error);
  ASSERT_TRUE(recording) << error;
  replay::Ages ages(chains);
  ages.add(*recording);
  const std::vector<replay::ChainAges> told = ages.finish();
  ASSERT_EQ(told.size(), seen.measured.size());
  for (std::size_t chain = 0; chain < told.size(); ++chain) {
    const ChainTimes& measured = seen.measured[chain];
    EXPECT_EQ(measured.commands, told[chain].age.count) << measured.name << " " << told[chain].why;
    EXPECT_EQ(measured.longest_age.value_or(Duration(0)).count(), told[chain].age.most) << measured.name;
    EXPECT_EQ(measured.longest_reaction.value_or(Duration(0)).count(), told[chain].reaction.most)
        << measured.name;
  }
}

/// Whether a chain uses a channel twice, whose values would then come from two places.
bool repeats(const ::timing::Chain& chain) {
  for (auto one = chain.begin(); one != chain.end(); ++one)
    if (std::find(std::next(one), chain.end(), *one) != chain.end()) return true;
  return false;
}

// TESSERA_TIMING_RUNS=20000 runs so many systems.
TEST(Runtime, ExceedsNoBound) {
  const char* const asked = std::getenv("TESSERA_TIMING_RUNS");
  const std::uint64_t systems = asked == nullptr ? 2000 : std::strtoull(asked, nullptr, 10);
  using ::timing::Family;
  constexpr std::array families{Family::any, Family::periodic, Family::driven, Family::blocking,
                                Family::ring};
  std::uint64_t commands = 0;
  const std::string file = ::testing::TempDir() + "timing_runtime." + std::to_string(getpid());
  for (std::uint64_t seed = 1; seed <= systems && !HasFailure(); ++seed) {
    Observed seen;
    seen.drawn = ::timing::draw(seed, families[seed % families.size()]);
    seen.longest = seed % 3 == 0;
    seen.drawn.net.latency = 0;  // the simulated clock has none
    std::erase_if(seen.drawn.chains, repeats);
    if (seen.drawn.chains.size() > most_chains) seen.drawn.chains.resize(most_chains);
    const timing::System system = timing::system_of(seen.net());
    const Bounds bounds(system);
    ::timing::Tick longest = 30;
    for (const ::timing::Subsystem& one : seen.net().subsystems)
      longest = std::max({longest, one.period, one.wcet});
    SCOPED_TRACE("seed " + std::to_string(seed));
    const bool records = seed % 4 < 2;
    if (!run(seen, bounds, seed, 40 * longest, seed % 2 == 0, records ? file : "")) return;
    hold_subsystems(seen, bounds.occurrences());
    hold_timeouts(seen, bounds.occurrences());
    hold_chains(seen, bounds);
    hold_measured(seen);
    if (records) compare_with_recording(seen, file);
    for (const std::vector<Command>& of_chain : seen.commands) commands += of_chain.size();
  }
  std::filesystem::remove(file);
  EXPECT_GT(commands, systems);
}

}  // namespace
}  // namespace tessera::timing_test
