// Bounds of random systems beside those of the reference, and beside what its simulation of them shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "drawn_shapes.hpp"
#include "timing/conduct/certain.hpp"
#include "timing/steps.hpp"

namespace tessera::timing {
namespace {

/// One number for "none", whoever computed it.
Time same(::timing::Tick time) { return time >= ::timing::unbounded ? unbounded : time; }

::timing::Case draw_family(std::uint64_t seed) {
  return ::timing::draw(
      seed, static_cast<::timing::Family>(seed % static_cast<std::uint64_t>(::timing::Family::count)));
}

struct Drawn {
  explicit Drawn(::timing::Case drawn) : one(std::move(drawn)), system(system_of(one.net)) {}
  ::timing::Case one;
  System system;
};

Time total_of(const std::vector<Step>& steps) {
  Time all = 0;
  for (const Step& step : steps) {
    EXPECT_GT(step.time, 0);
    all += step.time;
  }
  return all;
}

void compare(const Drawn& drawn) {
  const Bounds bounds(drawn.system);
  const Occurrences& mine = bounds.occurrences();
  const ::timing::Analysis reference(drawn.one.net);
  ASSERT_EQ(mine.events().size(), reference.nodes_.size());
  for (EventId y = 0; y < mine.events().size(); ++y) {
    const int z = static_cast<int>(y);
    ASSERT_EQ(mine.gap(y), same(reference.gap[y])) << "event " << y;
    ASSERT_EQ(mine.first(y), same(reference.first[y])) << "event " << y;
    ASSERT_EQ(mine.wait(y), same(reference.wait[y])) << "event " << y;
    ASSERT_EQ(mine.since_start(y), same(reference.since_start[y])) << "event " << y;
    ASSERT_EQ(mine.timeout_never_fires(y), reference.never_fires(z)) << "event " << y;
  }
  for (std::uint32_t i = 0; i < drawn.system.subsystems.size(); ++i) {
    ASSERT_EQ(mine.response(i), same(reference.response(static_cast<int>(i))));
    ASSERT_EQ(mine.periodic(i), reference.periodic[i] != 0) << "subsystem " << i;
  }
  for (std::uint32_t c = 0; c < drawn.system.channels.size(); ++c) {
    ASSERT_EQ(bounds.staleness(c), same(reference.staleness(static_cast<int>(c)))) << "channel " << c;
    ASSERT_EQ(mine.first_value(c), same(reference.first_value(static_cast<int>(c)))) << "channel " << c;
  }
  for (const ::timing::Chain& chain : drawn.one.chains) {
    const ::timing::ChainBound best = reference.bound(chain), sum = reference.bound(chain, false);
    const ChainBound found = bounds.chain(chain_of(chain)), summed = bounds.sum(chain_of(chain));
    ASSERT_EQ(found, (ChainBound{same(best.age), same(best.reaction), same(best.start), best.enumerated}));
    if (found.reaction < unbounded) {
      const ChainSteps steps = steps_of(bounds, {chain_of(chain)});
      ASSERT_EQ(total_of(steps.age), found.age);
      ASSERT_EQ(total_of(steps.reaction), found.reaction);
    }
    ASSERT_EQ(summed, (ChainBound{same(sum.age), same(sum.reaction), same(sum.start), false}));
  }
}

/// A simulation by the reference, beside the bounds.
class Shown {
 public:
  Shown(const Drawn& drawn, const Bounds& bounds, std::uint64_t seed)
      : drawn_(drawn), bounds_(bounds), all_(bounds.occurrences()), certain_(bounds) {
    Time until = 30;
    for (const ::timing::Subsystem& one : drawn.one.net.subsystems)
      until = std::max({until, one.period, one.wcet});
    until *= 40;
    const Time all = pattern_of_all(bounds, longest_pattern);
    is_long_enough_ = all < longest_pattern;
    if (is_long_enough_) until += 3 * all;
    seen_ = ::timing::Simulation(drawn.one.net, drawn.one.chains, ::timing::draw_run(drawn.one, seed, until))
                .run();
  }

  /// Returns how many timeouts must fire.
  std::uint64_t judge() {
    for (std::uint32_t i = 0; i < drawn_.system.subsystems.size(); ++i) judge_subsystem(i);
    for (std::uint32_t c = 0; c < drawn_.system.channels.size(); ++c) judge_channel(c);
    for (std::size_t c = 0; c < drawn_.one.chains.size(); ++c) {
      const ChainBound bound = bounds_.chain(chain_of(drawn_.one.chains[c]));
      EXPECT_LE(seen_.age[c], bound.age) << "chain " << c;
      EXPECT_LE(seen_.reaction[c], bound.reaction) << "chain " << c;
      EXPECT_LE(seen_.start[c], bound.start) << "chain " << c;
    }
    return must_fire_;
  }

 private:
  void judge_subsystem(std::uint32_t i) const {
    const Subsystem& one = drawn_.system.subsystems[i];
    if (one.processor >= 0) EXPECT_LE(seen_.response[i], plus(all_.response(i), drawn_.system.latency));
    if (one.period == 0 || all_.begins_late(i)) return;
    EXPECT_LE(seen_.release_gap[i], bounds_.between_iterations(i)) << "subsystem " << i;
    if (all_.periodic(i)) EXPECT_LE(seen_.release_gap[i], one.period) << "subsystem " << i;
    if (all_.never_overruns(i)) EXPECT_EQ(seen_.overruns[i], 0) << "subsystem " << i;
  }
  void judge_channel(std::uint32_t c) {
    SCOPED_TRACE("channel " + std::to_string(c));
    const Events& events = all_.events();
    const Channel& one = drawn_.system.channels[c];
    EXPECT_LE(seen_.write_gap[c], all_.gap(events.write(c)));
    EXPECT_LE(seen_.read_gap[c], all_.gap(events.read(c)));
    EXPECT_LE(seen_.staleness[c], bounds_.staleness(c));
    EXPECT_LE(seen_.first_value[c], all_.first_value(c));
    EXPECT_LE(certain_.staleness(c), bounds_.staleness(c));
    if (is_long_enough_ && seen_.staleness[c] > 0) EXPECT_GE(seen_.staleness[c], certain_.staleness(c));
    if (one.send_blocks) judge_wait(events.acked(c), seen_.send_wait[c], seen_.send_timeouts[c]);
    if (one.receive_blocks) judge_wait(events.read(c), seen_.receive_wait[c], seen_.receive_timeouts[c]);
  }
  void judge_wait(EventId z, Time longest, Time fired) {
    EXPECT_LE(longest, plus(all_.wait(z), all_.wake_up(z)));
    const Time timeout = all_.timeout_of(z), certain = certain_.wait(z);
    if (timeout > 0 && all_.timeout_never_fires(z)) {
      EXPECT_EQ(fired, 0);
      EXPECT_FALSE(certain_.times_out(z));
    }
    if (!is_long_enough_) return;
    EXPECT_GE(longest, timeout > 0 ? std::min(timeout, certain) : certain);
    if (!certain_.times_out(z)) return;
    ++must_fire_;
    EXPECT_GT(fired, 0);
  }

  const Drawn& drawn_;
  const Bounds& bounds_;
  const Occurrences& all_;
  const Certain certain_;
  ::timing::Observed seen_;
  bool is_long_enough_ = false;
  std::uint64_t must_fire_ = 0;
};

// TESSERA_TIMING_SYSTEMS=200000 tries so many.
std::uint64_t systems_asked(std::uint64_t usual) {
  const char* const asked = std::getenv("TESSERA_TIMING_SYSTEMS");
  return asked == nullptr ? usual : std::strtoull(asked, nullptr, 10);
}

TEST(Reference, HasTheSameBounds) {
  const std::uint64_t systems = systems_asked(2000);
  for (std::uint64_t seed = 1; seed <= systems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_FATAL_FAILURE(compare(Drawn(draw_family(seed))));
  }
}

TEST(Reference, HasTheSameBoundsForOtherShapes) {
  const std::uint64_t systems = systems_asked(1200);
  for (std::uint64_t seed = 1; seed <= systems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_FATAL_FAILURE(compare(Drawn(draw_shape(seed, {.may_be_late = true}))));
  }
}

TEST(Reference, ItsSimulationExceedsNoBoundOfOtherShapes) {
  const std::uint64_t systems = systems_asked(1200);
  std::uint64_t must_fire = 0;
  for (std::uint64_t seed = 1; seed <= systems && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Drawn drawn(draw_shape(seed, {.may_be_late = seed % 2 == 0}));
    const Bounds bounds(drawn.system);
    must_fire += Shown(drawn, bounds, seed).judge();
  }
  EXPECT_GT(must_fire, systems / 50);
}

}  // namespace
}  // namespace tessera::timing
