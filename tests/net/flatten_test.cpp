#include "net/flatten.hpp"

#include <gmock/gmock.h>

namespace tessera::net {
namespace {

using diagnostics::Diagnostics;
using testing::ElementsAre;

PageTransition bar(const char* name, std::vector<std::uint32_t> inputs, std::vector<std::uint32_t> outputs) {
  return {.name = name, .inputs = std::move(inputs), .outputs = std::move(outputs)};
}

/// Root: in -> [work] -> out, where work stands for page 1: in -> out.
HierarchicalNet nested() {
  HierarchicalNet net;
  net.pages.push_back({.name = "",
                       .input = 0,
                       .output = 2,
                       .nodes = {Node{.name = "in", .tokens = 1}, Node{.name = "work", .page = PageId{1}},
                                 Node{.name = "out"}},
                       .transitions = {bar("enter", {0}, {1}), bar("leave", {1}, {2})}});
  net.pages.push_back({.name = "work",
                       .layer = Layer::agent,
                       .parent = PageId{0},
                       .subsystem = {7},
                       .input = 0,
                       .output = 1,
                       .nodes = {Node{.name = "in"}, Node{.name = "out"}},
                       .transitions = {bar("t", {0}, {1})},
                       .span = {4, 2, 1}});
  return net;
}

std::vector<std::string> place_names(const Net& net) {
  std::vector<std::string> names;
  for (const Place& place : net.places()) names.push_back(place.name);
  return names;
}

/// "t: a + b*2 -> c"
std::vector<std::string> firings(const Net& net) {
  const auto sum = [&](std::span<const Arc> arcs) {
    std::string text;
    for (const Arc& arc : arcs)
      text += (text.empty() ? "" : " + ") + net[arc.place].name +
              (arc.weight > 1 ? "*" + std::to_string(arc.weight) : "");
    return text;
  };
  std::vector<std::string> lines;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    lines.push_back(net[id].name + ": " + sum(net.preset(id)) + " -> " + sum(net.postset(id)));
  }
  return lines;
}

TEST(Flatten, ReplacesAPageByItsNet) {
  Diagnostics out("n", "");
  const std::optional<Net> net = flatten(nested(), out);
  ASSERT_TRUE(net);
  EXPECT_THAT(place_names(*net), ElementsAre("in", "out", "work.in", "work.out"));
  EXPECT_THAT(firings(*net),
              ElementsAre("enter: in -> work.in", "leave: work.out -> out", "work.t: work.in -> work.out"));
  EXPECT_EQ(net->places()[0].tokens, 1U);
}

TEST(Flatten, KeepsTheOriginOfEveryElement) {
  Diagnostics out("n", "");
  const std::optional<Net> net = flatten(nested(), out);
  ASSERT_TRUE(net);
  EXPECT_EQ(net->places()[2].page, PageId{1});
  EXPECT_EQ(net->places()[2].layer, Layer::agent);
  EXPECT_EQ(net->places()[2].subsystem, SubsystemId{7});
  EXPECT_EQ(net->places()[2].span, (Span{4, 2, 1}));
  EXPECT_EQ(net->transitions()[2].page, PageId{1});
  EXPECT_FALSE(net->places()[2].fused());
}

TEST(Flatten, EntersAPageWhoseInputIsAPage) {
  HierarchicalNet net = nested();
  net.pages[1].nodes[0].page = PageId{2};
  net.pages[1].nodes[0].name = "deep";
  net.pages.push_back({.name = "deep",
                       .parent = PageId{1},
                       .input = 1,
                       .output = 0,
                       .nodes = {Node{.name = "last"}, Node{.name = "first"}},
                       .transitions = {bar("t", {1}, {0})}});
  Diagnostics out("n", "");
  const std::optional<Net> flat = flatten(net, out);
  ASSERT_TRUE(flat);
  EXPECT_THAT(firings(*flat), ElementsAre("enter: in -> work.deep.first", "leave: work.out -> out",
                                          "work.t: work.deep.last -> work.out",
                                          "work.deep.t: work.deep.first -> work.deep.last"));
}

/// nested() with a fused place `lock` (one token) in both nets, after which `t` and `enter` wait.
HierarchicalNet locked() {
  HierarchicalNet net = nested();
  net.fusions.push_back({"lock", 1, ChannelId{3}, {9, 1, 1}});
  for (Page& page : net.pages) {
    page.nodes.push_back(Node{.name = "lock", .fusion = FusionId{0}, .tokens = 1});
    page.transitions[0].inputs.push_back(static_cast<std::uint32_t>(page.nodes.size() - 1));
  }
  return net;
}

TEST(Flatten, MergesAFusionSetIntoOnePlaceAtTheEnd) {
  HierarchicalNet drawn = locked();
  drawn.pages[1].nodes.back().operation.kind = Operation::Kind::write;
  Diagnostics out("n", "");
  const std::optional<Net> net = flatten(drawn, out);
  ASSERT_TRUE(net);
  EXPECT_THAT(place_names(*net), ElementsAre("in", "out", "work.in", "work.out", "lock"));
  EXPECT_THAT(firings(*net), ElementsAre("enter: in + lock -> work.in", "leave: work.out -> out",
                                         "work.t: work.in + lock -> work.out"));
  const Place& lock = net->places().back();
  EXPECT_TRUE(lock.fused());
  EXPECT_EQ(lock.channel, ChannelId{3});
  EXPECT_EQ(lock.operation.kind, Operation::Kind::write);
  EXPECT_FALSE(lock.page.valid());
}

TEST(Flatten, FusedPlaceKeepsInitialMarking) {
  Diagnostics out("n", "");
  const std::optional<Net> net = flatten(locked(), out);
  ASSERT_TRUE(net);
  EXPECT_EQ(net->places().back().tokens, 1U);
}

TEST(Flatten, TwoArcsToOneFusedPlaceBecomeAHeavierOne) {
  HierarchicalNet drawn = locked();
  drawn.pages[0].nodes.push_back(Node{.name = "lock again", .fusion = FusionId{0}, .tokens = 1});
  drawn.pages[0].transitions[0].inputs.push_back(4);
  Diagnostics out("n", "");
  const std::optional<Net> net = flatten(drawn, out);
  ASSERT_TRUE(net);
  EXPECT_EQ(firings(*net)[0], "enter: in + lock*2 -> work.in");
}

TEST(Flatten, AFusionSetWithoutMembersIsNoPlace) {
  HierarchicalNet drawn = nested();
  drawn.fusions.push_back({"nobody", 1, ChannelId{0}, {}});
  Diagnostics out("n", "");
  ASSERT_TRUE(flatten(drawn, out));
  EXPECT_EQ(flatten(drawn, out)->places().size(), 4U);
}

struct Mistake {
  const char* name;
  void (*make)(HierarchicalNet&);
  std::vector<std::string> complaints;
};

const std::vector<Mistake> mistakes{
    {"no pages", [](HierarchicalNet& net) { net.pages.clear(); }, {"E401 the net has no pages"}},
    {"a page without a net",
     [](HierarchicalNet& net) { net.pages[0].nodes[1].page = PageId{5}; },
     {"E401 page 'work' has no net", "E404 no net draws page 'work'"}},
    {"an empty page",
     [](HierarchicalNet& net) {
       net.pages[1].nodes.clear();
       net.pages[1].transitions.clear();
     },
     {"E401 page 'work' has no net with an input and an output place"}},
    {"an arc out of the net",
     [](HierarchicalNet& net) { net.pages[1].transitions[0].outputs[0] = 9; },
     {"E401 an arc of 't' leads out of its net"}},
    {"disagreement",
     [](HierarchicalNet& net) { net.pages[1].nodes.back().tokens = 0; },
     {"E402 place 'lock' starts with 0 tokens, its fusion set 'lock' with 1"}},
    {"no such set",
     [](HierarchicalNet& net) { net.pages[1].nodes.back().fusion = FusionId{4}; },
     {"E402 place 'lock' is a member of no fusion set"}},
    {"two operations",
     [](HierarchicalNet& net) {
       for (Page& page : net.pages) page.nodes.back().operation.kind = Operation::Kind::read;
     },
     {"E403 two members of fusion set 'lock' have an operation"}},
    {"a page drawn twice",
     [](HierarchicalNet& net) { net.pages[0].nodes.push_back(Node{.name = "work", .page = PageId{1}}); },
     {"E404 page 'work' is reached twice"}},
    {"a page within itself",
     [](HierarchicalNet& net) { net.pages[1].nodes.push_back(Node{.name = "again", .page = PageId{1}}); },
     {"E404 page 'again' is reached twice"}},
    {"a marked page",
     [](HierarchicalNet& net) { net.pages[0].nodes[1].tokens = 1; },
     {"E405 page 'work' is fused, marked or has an operation, which only places may"}},
    {"two mistakes at once",
     [](HierarchicalNet& net) {
       net.pages[0].nodes[1].tokens = 1;
       net.pages[1].nodes.back().tokens = 0;
     },
     {"E405 page 'work' is fused, marked or has an operation, which only places may",
      "E402 place 'lock' starts with 0 tokens, its fusion set 'lock' with 1"}},
};

TEST(Flatten, RefusesWhatStandsForNoNet) {
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.name);
    HierarchicalNet net = locked();
    mistake.make(net);
    Diagnostics out("n", "");
    EXPECT_FALSE(flatten(net, out));
    std::vector<std::string> complaints;
    for (const auto& diagnostic : out.sorted())
      complaints.push_back(diagnostic.code + " " + diagnostic.message);
    EXPECT_EQ(complaints, mistake.complaints);
  }
}

}  // namespace
}  // namespace tessera::net
