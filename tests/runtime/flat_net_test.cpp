#include "nets/flat_net.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "nets.hpp"
#include "tessera/net_hash.hpp"
#include "test_system.hpp"

namespace tessera::testing {
namespace {

constexpr named::Place tiny_places[] = {{"in"}, {"out"}};
const named::Transition tiny_send[] = {{"t", {"in", "x/empty"}, {"out", "x/full"}}};
const named::Transition tiny_receive[] = {{"t", {"in", "x/full"}, {"out", "x/empty"}, if_elapsed}};
constexpr Port send_port[] = {{"x", Side::send, "x"}};
constexpr Port receive_port[] = {{"x", Side::receive, "x"}};
const SubsystemNet sender = numbered({}, send_port, tiny_places, tiny_send);
const SubsystemNet receiver = numbered({}, receive_port, tiny_places, tiny_receive);

TEST(FlatNet, IsTheSubsystemsTheirChannelsAndTheUpperLayers) {
  TestSystem system;
  const auto a = system.add("left.a", sender, {});
  const auto b = system.add("right.b", receiver, {});
  system.connect(a, "x", b, "x", buffered);
  NetHash expected;
  for (const char* place : {"out", "left.in", "left.out", "right.in", "right.out", "left.a.in", "left.a.out",
                            "right.b.in", "right.b.out", "left.a.x->right.b.x.full"})
    expected.place(place, 0);
  expected.place("in", 1);
  expected.place("left.a.x->right.b.x.empty", 1);
  expected.transition("t_in", {"in"}, {"left.in", "right.in"}, "");
  expected.transition("t_out", {"left.out", "right.out"}, {"out"}, "");
  expected.transition("left.t_in", {"left.in"}, {"left.a.in"}, "");
  expected.transition("left.t_out", {"left.a.out"}, {"left.out"}, "");
  expected.transition("right.t_in", {"right.in"}, {"right.b.in"}, "");
  expected.transition("right.t_out", {"right.b.out"}, {"right.out"}, "");
  expected.transition("left.a.t", {"left.a.in", "left.a.x->right.b.x.empty"},
                      {"left.a.out", "left.a.x->right.b.x.full"}, "");
  expected.transition("right.b.t", {"right.b.in", "left.a.x->right.b.x.full"},
                      {"right.b.out", "left.a.x->right.b.x.empty"}, "elapsed");
  EXPECT_EQ(net_of(system.system()).hash(), expected.hex());
}

TEST(FlatNet, AChannelNobodyUsesHasNoPlaces) {
  TestSystem system;
  const auto a = system.add("robot.a", nets::alone, {});
  const std::size_t places = net_of(system.system()).places.size();
  system.connect(a, "", a, "", buffered);
  EXPECT_EQ(net_of(system.system()).places.size(), places);
}

TEST(FlatNet, AnotherNetIsRefused) {
  TestSystem system;
  system.add("robot.a", nets::alone, {});
  System changed = system.system();
  changed.net_hash = "0123";
  std::string error;
  EXPECT_FALSE(execute(changed, simulated(Duration(1)), error));
  EXPECT_TRUE(error.starts_with("this controller's tables are not the net that was verified")) << error;
}

TEST(FlatNet, AnotherVersionOfTheTablesIsRefused) {
  TestSystem system;
  system.add("robot.a", nets::alone, {});
  System changed = system.system();
  changed.tables_version = tables_version + 1;
  std::string error;
  EXPECT_FALSE(execute(changed, simulated(Duration(1)), error));
  EXPECT_NE(error.find("version"), std::string::npos) << error;
}

}  // namespace
}  // namespace tessera::testing
