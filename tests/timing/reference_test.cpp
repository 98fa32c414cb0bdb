// Bounds of random systems beside those of the reference, and beside what its simulation of them shows.
#include "reference.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "timing/steps.hpp"

namespace tessera::timing {
namespace {

/// One number for "none", whoever computed it.
Time same(::timing::Tick time) { return time >= ::timing::unbounded ? unbounded : time; }

struct Drawn {
  explicit Drawn(std::uint64_t seed)
      : one(::timing::draw(
            seed, static_cast<::timing::Family>(seed % static_cast<std::uint64_t>(::timing::Family::count)))),
        system(system_of(one.net)) {}
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

// TESSERA_TIMING_SYSTEMS=200000 compares so many.
TEST(Reference, HasTheSameBounds) {
  const char* const asked = std::getenv("TESSERA_TIMING_SYSTEMS");
  const std::uint64_t systems = asked == nullptr ? 2000 : std::strtoull(asked, nullptr, 10);
  for (std::uint64_t seed = 1; seed <= systems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Drawn drawn(seed);
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
}

}  // namespace
}  // namespace tessera::timing
