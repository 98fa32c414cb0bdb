#include <gtest/gtest.h>

#include "reduce/fleet_nets.hpp"
#include "reduce/reduce.hpp"

namespace tessera::test {
namespace {

using reduce::Preserve;
using reduce::Reduced;

/// The properties that goes_on needs.
Preserve every_subsystem(const net::Net& net) { return {.sets = per_subsystem(net), .safe = true}; }

TEST(Reduce, AsynchronousSubsystemsFallApart) {
  const net::Net net = fleet_net({2, Mix::async, Mix::async, Topology::ring, Form::one_template});
  const Reduced reduced = reduce::reduce(net, every_subsystem(net));
  for (const net::Place& place : reduced.net.places()) EXPECT_FALSE(place.fused()) << place.name;
  EXPECT_GT(reduced.statistics.constant_places, 0U);
  EXPECT_LT(10 * reduced.statistics.places_after, 2 * reduced.statistics.places_before);
}

TEST(Reduce, ObservedPlacesStay) {
  const net::Net net = fleet_net({1, Mix::both_block, Mix::both_block, Topology::alone, Form::one_template});
  Preserve what = every_subsystem(net);
  for (std::uint32_t place = 0; place < net.places().size(); place += 3) what.observed.push_back({place});
  const Reduced reduced = reduce::reduce(net, what);
  for (const net::PlaceId place : what.observed) {
    ASSERT_TRUE(reduced.find(place));
    EXPECT_EQ(reduced.net[*reduced.find(place)].name, net[place].name);
  }
  EXPECT_LT(reduced.statistics.places_after, reduced.statistics.places_before);
}

TEST(Fleet, WrittenOutItIsTheSameNet) {
  for (const std::string_view name : fleet_names) {
    Fleet fleet = *fleet_named(name, 3);
    const net::Net one = fleet_net(fleet);
    fleet.form = Form::written_out;
    const net::Net other = fleet_net(fleet);
    EXPECT_EQ(one.places().size(), other.places().size()) << name;
    EXPECT_EQ(one.transitions().size(), other.transitions().size()) << name;
    EXPECT_EQ(one.arc_count(), other.arc_count()) << name;
  }
}

TEST(Reduce, SizesAreLinearInTheFleet) {
  for (const std::string_view name : fleet_names) {
    const auto size = [&](unsigned agents) {
      const net::Net net = fleet_net(*fleet_named(name, agents));
      return reduce::reduce(net, every_subsystem(net)).net.places().size();
    };
    EXPECT_EQ(size(40) - size(30), size(30) - size(20)) << name;
  }
}

}  // namespace
}  // namespace tessera::test
