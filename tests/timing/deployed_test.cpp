// Random systems of several processes on the runtime, over its simulated network, beside their bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "nets/flat_net.hpp"
#include "system_rows.hpp"
#include "tessera/buffer.hpp"
#include "tessera/controller.hpp"
#include "timing/bounds.hpp"

namespace tessera::timing_test {
namespace {

using timing::Bounds;
using timing::ChainBound;
using timing::Occurrences;
using timing::unbounded;

constexpr timing::Time ms = 1'000'000;
constexpr std::size_t most_chains = 6, most_subsystems = 7;

/// A value: when the device was read that it comes from, chain by chain.
struct Origins {
  std::array<std::int64_t, most_chains> sampled;
  bool filled;
};
struct Command {
  std::int64_t given = 0, sampled = 0;
};

struct Observed {
  timing::System system;
  std::vector<timing::Chain> chains{};
  std::array<std::vector<std::int64_t>, most_subsystems> called{};
  std::array<std::vector<Command>, most_chains> commands{};
  std::array<std::vector<std::int64_t>, most_chains> samples{};
  std::vector<std::uint64_t> timeouts{};  ///< per channel, at both ends

  [[nodiscard]] std::uint32_t first_of(std::size_t chain) const {
    return system.channels[chains[chain].front()].from;
  }
  [[nodiscard]] std::uint32_t last_of(std::size_t chain) const {
    return system.channels[chains[chain].back()].to;
  }
};
Observed* observed = nullptr;

/// Hands on when its inputs were sampled.
class Passing final : public Subsystem {
 public:
  explicit Passing(std::uint32_t index)
      : index_(index), inputs_(mine().receives.size()), outputs_(mine().sends.size()) {}
  void bind(Bindings& bindings) override {
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      bindings.input(port_named(mine().receives[k]), inputs_[k]);
    for (std::size_t k = 0; k < outputs_.size(); ++k)
      bindings.output(port_named(mine().sends[k]), outputs_[k]);
  }
  void call(std::uint16_t) override {
    Observed& seen = *observed;
    const std::int64_t now = context_.now.time_since_epoch().count();
    seen.called[index_].push_back(now);
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      seen.timeouts[mine().receives[k]] += inputs_[k].timed_out ? 1 : 0;
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      seen.timeouts[mine().sends[k]] += outputs_[k].timed_out ? 1 : 0;
      outputs_[k].filled = true;
    }
    for (std::size_t chain = 0; chain < seen.chains.size(); ++chain) {
      const timing::Chain& channels = seen.chains[chain];
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
  [[nodiscard]] const timing::Subsystem& mine() const { return observed->system.subsystems[index_]; }
  [[nodiscard]] Output<Origins>* output(std::uint32_t channel) {
    for (std::size_t k = 0; k < outputs_.size(); ++k)
      if (mine().sends[k] == channel) return &outputs_[k];
    return nullptr;
  }
  /// Less than 0: nothing has come yet.
  [[nodiscard]] std::int64_t sampled(std::uint32_t channel, std::size_t chain) const {
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

/// A robot or two, a base, and channels between them in all modes: sources that look, others that pass on, and answers
/// that go back.
class Drawing {
 public:
  explicit Drawing(std::uint64_t seed) : random_(seed) {}
  [[nodiscard]] Observed draw() {
    const std::size_t subsystems = 3 + below(most_subsystems - 2);
    const timing::Time network = std::array{1, 2, 5, 12, 30}[below(5)] * ms;
    const std::size_t processes = 2 + below(2);
    for (std::uint32_t i = 0; i < subsystems; ++i) {
      timing::Subsystem& one = system_.subsystems.emplace_back();
      one.process = static_cast<std::uint32_t>(i < processes ? i : below(processes));
      one.period = below(4) == 0 ? 0 : std::array{4, 5, 10, 15, 20, 40, 50}[below(7)] * ms;
      one.shortest = static_cast<timing::Time>(1 + below(3)) * ms;
      one.longest = one.shortest + static_cast<timing::Time>(below(4)) * ms;
      one.catch_up = below(8) == 0;
      if (i > 0) connect(static_cast<std::uint32_t>(below(i)), i, network);
    }
    for (std::size_t more = below(3); more > 0; --more) {
      const auto a = static_cast<std::uint32_t>(below(subsystems)),
                 b = static_cast<std::uint32_t>(below(subsystems));
      if (a != b) connect(a, b, network);
    }
    for (timing::Subsystem& one : system_.subsystems) {
      std::ranges::shuffle(one.sends, random_);
      std::ranges::shuffle(one.receives, random_);
    }
    for (std::uint32_t i = 0; i < subsystems; ++i)
      if (system_.subsystems[i].period == 0 && !waits(i)) system_.subsystems[i].period = 10 * ms;
    Observed seen{std::move(system_)};
    std::set<timing::Chain> found;
    for (int tries = 0; tries < 30 && found.size() < most_chains; ++tries) walk(seen.system, found);
    seen.chains.assign(found.begin(), found.end());
    return seen;
  }

 private:
  std::size_t below(std::size_t count) { return random_() % count; }
  void connect(std::uint32_t from, std::uint32_t to, timing::Time network) {
    const auto c = static_cast<std::uint32_t>(system_.channels.size());
    timing::Channel& one = system_.channels.emplace_back();
    one.from = from;
    one.to = to;
    one.send_blocks = below(4) == 0;
    one.receive_blocks = below(2) == 0;
    if (one.send_blocks && below(3) == 0) one.send_timeout = static_cast<timing::Time>(5 + below(200)) * ms;
    if (one.receive_blocks && below(3) == 0)
      one.receive_timeout = static_cast<timing::Time>(5 + below(200)) * ms;
    system_.subsystems[from].sends.push_back(c);
    system_.subsystems[to].receives.push_back(c);
    if (system_.crosses(c)) one.network = network;
  }
  [[nodiscard]] bool waits(std::uint32_t i) const {
    return std::ranges::any_of(system_.channels, [&](const timing::Channel& one) {
      return (one.from == i && one.send_blocks) || (one.to == i && one.receive_blocks);
    });
  }
  void walk(const timing::System& system, std::set<timing::Chain>& found) {
    timing::Chain chain{static_cast<std::uint32_t>(below(system.channels.size()))};
    for (std::size_t hops = below(4); hops > 0; --hops) {
      const std::vector<std::uint32_t>& next = system.subsystems[system.channels[chain.back()].to].sends;
      if (next.empty()) break;
      const std::uint32_t c = next[below(next.size())];
      if (std::ranges::find(chain, c) != chain.end()) break;
      chain.push_back(c);
    }
    if (std::ranges::any_of(chain, [&](std::uint32_t c) { return system.crosses(c); })) found.insert(chain);
  }

  std::mt19937_64 random_;
  timing::System system_;
};

/// conditions: of the network. false: the run has not begun.
[[nodiscard]] bool run(Observed& seen, std::uint64_t seed, const std::string& conditions) {
  const timing::System& drawn = seen.system;
  observed = &seen;
  seen.timeouts.assign(drawn.channels.size(), 0);
  std::deque<SystemRows> rows;
  std::deque<std::string> names;
  std::vector<Instance> instances;
  std::vector<std::uint32_t> process_of;
  timing::Time longest = 60 * ms;
  for (std::uint32_t i = 0; i < drawn.subsystems.size(); ++i) {
    Policies policies;
    policies.overrun = drawn.subsystems[i].catch_up ? Overrun::catch_up : Overrun::skip;
    instances.push_back({names.emplace_back("a" + std::to_string(i)), "control", Kind::control,
                         rows.emplace_back(drawn, i).net(), make[i], Duration(drawn.subsystems[i].period),
                         Duration(0), policies});
    process_of.push_back(drawn.subsystems[i].process);
    longest = std::max(longest, drawn.subsystems[i].period);
  }
  std::vector<Channel> channels;
  for (std::uint32_t c = 0; c < drawn.channels.size(); ++c) {
    const timing::Channel& one = drawn.channels[c];
    const std::span<const FusedPlace> places = places_between(drawn, c);
    channels.push_back({port_named(c),
                        {one.from, rows[one.from].port(c)},
                        {one.to, rows[one.to].port(c)},
                        places,
                        Duration(one.send_timeout),
                        Duration(one.receive_timeout),
                        1,
                        testing::medium_of(places)});
  }
  const std::array processes{Process{"p0", "", ""}, Process{"p1", "", ""}, Process{"p2", "", ""}};
  const std::size_t count = *std::ranges::max_element(process_of) + std::size_t{1};
  System system{tables_version,
                "drawn",
                "",
                "",
                {},
                instances,
                channels,
                &testing::system_page,
                &testing::agent_page,
                {},
                {},
                std::span(processes).first(count),
                process_of,
                0,
                std::chrono::milliseconds(900)};
  const std::string hash = net_of(system).hash();
  system.net_hash = hash;
  RunOptions options;
  options.duration = Duration(60 * longest);
  options.seed = seed;
  options.interleave = seed % 2 == 0;
  options.accept_stuck = true;
  options.network.conditions = conditions;
  std::string error;
  const std::optional<RunSummary> summary = execute(system, options, error);
  EXPECT_TRUE(summary) << error;
  return summary.has_value();
}

void hold(const char* what, std::size_t index, std::int64_t most, timing::Time bound) {
  EXPECT_LE(most, bound >= unbounded ? INT64_MAX : bound) << what << " " << index;
}

void hold_subsystems(const Observed& seen, const Occurrences& bounds) {
  for (std::uint32_t i = 0; i < seen.system.subsystems.size(); ++i) {
    const timing::Subsystem& one = seen.system.subsystems[i];
    if (one.period == 0 || (one.catch_up && !bounds.never_overruns(i))) continue;
    std::int64_t gap = 0;
    for (std::size_t k = 1; k < seen.called[i].size(); ++k)
      gap = std::max(gap, seen.called[i][k] - seen.called[i][k - 1]);
    hold("time between calls of", i, gap, bounds.gap(bounds.events().start(i)));
  }
}

void hold_timeouts(const Observed& seen, const Occurrences& bounds) {
  for (std::uint32_t c = 0; c < seen.system.channels.size(); ++c) {
    const timing::Channel& one = seen.system.channels[c];
    const bool never = (one.send_timeout == 0 || bounds.timeout_never_fires(bounds.events().acked(c))) &&
                       (one.receive_timeout == 0 || bounds.timeout_never_fires(bounds.events().read(c)));
    if (never) {
      EXPECT_EQ(seen.timeouts[c], 0U) << "channel " << c;
    }
  }
}

/// The largest times of a chain, and the reach of its bound: what was seen, divided by what is proved.
void hold_chains(const Observed& seen, const Bounds& bounds, std::vector<double>& reach) {
  for (std::size_t chain = 0; chain < seen.chains.size(); ++chain) {
    const ChainBound bound = bounds.chain(seen.chains[chain]);
    const timing::Time least = seen.system.subsystems[seen.last_of(chain)].shortest;
    const std::vector<Command>& commands = seen.commands[chain];
    std::int64_t age = 0, reaction = 0;
    for (const Command& command : commands) age = std::max(age, command.given - command.sampled);
    std::size_t at = 0;
    for (const std::int64_t sample : seen.samples[chain]) {
      while (at < commands.size() && commands[at].sampled <= sample) ++at;
      if (at == commands.size()) break;
      reaction = std::max(reaction, commands[at].given - sample);
    }
    hold("age of chain", chain, age + least, bound.age);
    hold("reaction of chain", chain, reaction + least, bound.reaction);
    if (bound.reaction < unbounded && age > 0)
      reach.push_back(static_cast<double>(age + least) / static_cast<double>(bound.age));
  }
}

// TESSERA_TIMING_DEPLOYED=5000 runs so many systems.
TEST(Deployed, ExceedsNoBoundOverASimulatedNetwork) {
  const char* const asked = std::getenv("TESSERA_TIMING_DEPLOYED");
  const std::uint64_t systems = asked == nullptr ? 300 : std::strtoull(asked, nullptr, 10);
  std::vector<double> reach;
  for (std::uint64_t seed = 1; seed <= systems && !HasFailure(); ++seed) {
    Observed seen = Drawing(seed).draw();
    if (seen.chains.empty()) continue;
    timing::Time network = ms;
    for (const timing::Channel& channel : seen.system.channels) network = std::max(network, channel.network);
    const std::array conditions{"delay=0ms,jitter=" + std::to_string(network / ms) + "ms",
                                "delay=" + std::to_string(network / ms) + "ms", std::string("delay=0ms")};
    const Bounds bounds(seen.system);
    SCOPED_TRACE("seed " + std::to_string(seed));
    if (!run(seen, seed, conditions[seed % 3])) return;
    hold_subsystems(seen, bounds.occurrences());
    hold_timeouts(seen, bounds.occurrences());
    hold_chains(seen, bounds, reach);
  }
  ASSERT_GT(reach.size(), systems);
  std::ranges::sort(reach);
  RecordProperty("median_of_age_by_bound", std::to_string(reach[reach.size() / 2]));
  if (asked != nullptr)
    std::printf("%zu chains, median of age / bound %.2f\n", reach.size(), reach[reach.size() / 2]);
}

}  // namespace
}  // namespace tessera::timing_test
