#include "net/net.hpp"

#include <gmock/gmock.h>

namespace tessera::net {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Net, KeepsTheArcsOfEachTransition) {
  Net net;
  const PlaceId a = net.add(Place{.name = "a"}), b = net.add(Place{.name = "b"});
  const std::vector<Arc> in{{a, 1}, {b, 2}}, out{{b, 1}};
  const TransitionId t = net.add(Transition{.name = "t"}, in, out);
  const TransitionId sink = net.add(Transition{.name = "sink"}, out, {});
  EXPECT_THAT(net.preset(t), ElementsAre(Arc{a, 1}, Arc{b, 2}));
  EXPECT_THAT(net.postset(t), ElementsAre(Arc{b, 1}));
  EXPECT_THAT(net.preset(sink), ElementsAre(Arc{b, 1}));
  EXPECT_THAT(net.postset(sink), IsEmpty());
  EXPECT_EQ(net.arc_count(), 4U);
  EXPECT_EQ(net[t].name, "t");
  EXPECT_EQ(net[b].name, "b");
}

HierarchicalNet two_levels() {
  HierarchicalNet net;
  net.pages.resize(3);
  net.pages[0].nodes = {Node{.name = "robot[1]", .page = PageId{1}}};
  net.pages[1] =
      Page{.name = "robot[1]", .parent = PageId{0}, .nodes = {Node{.name = "control", .page = PageId{2}}}};
  net.pages[2] = Page{.name = "control", .parent = PageId{1}};
  return net;
}

TEST(HierarchicalNet, NamesPagesByPaths) {
  const HierarchicalNet net = two_levels();
  EXPECT_EQ(net.path(PageId{0}), "");
  EXPECT_EQ(net.path(PageId{1}), "robot[1]");
  EXPECT_EQ(net.path(PageId{2}), "robot[1].control");
}

TEST(HierarchicalNet, FindsPagesByPaths) {
  const HierarchicalNet net = two_levels();
  EXPECT_EQ(net.find(""), PageId{0});
  EXPECT_EQ(net.find("robot[1].control"), PageId{2});
  EXPECT_FALSE(net.find("robot[1].sensor").valid());
  EXPECT_FALSE(net.find("control").valid());
  EXPECT_FALSE(HierarchicalNet{}.find("").valid());
}

}  // namespace
}  // namespace tessera::net
