#include "net/pnml_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "net/pnml.hpp"

namespace tessera::net {
namespace {

using testing::ElementsAre;

/// The net of a document with this inside its only net.
std::optional<Net> read(const std::string& inside, std::string* complaints = nullptr) {
  diagnostics::Diagnostics out(
      "net.pnml",
      "<pnml><net id='n' type='http://www.pnml.org/version-2009/grammar/ptnet'>" + inside + "</net></pnml>");
  std::optional<Net> net = read_pnml(out);
  if (complaints != nullptr) *complaints = render(out);
  return net;
}

std::vector<std::string> place_names(const Net& net) {
  std::vector<std::string> names;
  for (const Place& place : net.places()) names.push_back(place.name);
  return names;
}

TEST(ReadPnml, PlacesTransitionsMarkingsAndWeights) {
  const auto net = read(
      "<page id='g'><place id='a'><name><text>start</text></name><initialMarking><text> 3 "
      "</text></initialMarking>"
      "</place><place id='b'/><transition id='t'><name><text>go</text></name></transition>"
      "<arc id='x' source='a' target='t'><inscription><text>2</text></inscription></arc>"
      "<arc id='y' source='t' target='b'/></page>");
  ASSERT_TRUE(net);
  EXPECT_THAT(place_names(*net), ElementsAre("start", "b"));
  EXPECT_EQ(net->places()[0].tokens, 3U);
  EXPECT_EQ(net->places()[1].tokens, 0U);
  EXPECT_EQ(net->transitions()[0].name, "go");
  EXPECT_THAT(net->preset(TransitionId{0}), ElementsAre(Arc{PlaceId{0}, 2}));
  EXPECT_THAT(net->postset(TransitionId{0}), ElementsAre(Arc{PlaceId{1}, 1}));
}

TEST(ReadPnml, PagesMayBeNestedAndArcsMayComeFirst) {
  const auto net = read(
      "<page id='g'><arc id='x' source='a' target='t'/><page id='h'><place id='a'/><page "
      "id='i'/></page></page>"
      "<page id='j'><transition id='t'/></page>");
  ASSERT_TRUE(net);
  EXPECT_THAT(net->preset(TransitionId{0}), ElementsAre(Arc{PlaceId{0}, 1}));
}

TEST(ReadPnml, ReferencesAreReplacedByWhatTheyReferTo) {
  const auto net = read(
      "<place id='a'/><transition id='t'/><referencePlace id='r' ref='s'/><referencePlace id='s' ref='a'/>"
      "<referenceTransition id='u' ref='t'/><arc id='x' source='r' target='u'/><arc id='y' source='u' "
      "target='s'/>");
  ASSERT_TRUE(net);
  EXPECT_EQ(net->places().size(), 1U);
  EXPECT_THAT(net->preset(TransitionId{0}), ElementsAre(Arc{PlaceId{0}, 1}));
  EXPECT_THAT(net->postset(TransitionId{0}), ElementsAre(Arc{PlaceId{0}, 1}));
}

TEST(ReadPnml, ParallelArcsAddUp) {
  const auto net = read(
      "<place id='a'/><transition id='t'/><arc id='x' source='a' target='t'/>"
      "<arc id='y' source='a' target='t'><inscription><text>4</text></inscription></arc>");
  ASSERT_TRUE(net);
  EXPECT_THAT(net->preset(TransitionId{0}), ElementsAre(Arc{PlaceId{0}, 5}));
}

TEST(ReadPnml, TheIdStandsForANameThatIsMissingOrNotItsOwn) {
  const auto net = read(
      "<place id='a'><name><text>same</text></name></place><place "
      "id='b'><name><text>same</text></name></place>"
      "<place id='c'/><place id='d'><name><text>a</text></name></place>");
  ASSERT_TRUE(net);
  EXPECT_THAT(place_names(*net), ElementsAre("a", "b", "c", "d"));
}

TEST(ReadPnml, ToolSpecificPartsAndGraphicsAreIgnored) {
  const auto net = read(
      "<place id='a'><toolspecific tool='x' version='1'><place id='a'/><initialMarking><text>-1</text>"
      "</initialMarking></toolspecific><graphics><position x='1' y='2'/></graphics></place>"
      "<toolspecific tool='x' version='1'><place id='b'/></toolspecific>");
  ASSERT_TRUE(net);
  EXPECT_THAT(place_names(*net), ElementsAre("a"));
}

TEST(ReadPnml, PrefixedNamesAndPlainDoctypesAreFine) {
  diagnostics::Diagnostics out("net.pnml",
                               "<?xml version='1.0'?><!DOCTYPE pnml><p:pnml xmlns:p='http://www.pnml.org/'>"
                               "<p:net id='n' type='ptnet'><p:place id='a'/></p:net></p:pnml>");
  const auto net = read_pnml(out);
  ASSERT_TRUE(net) << render(out);
  EXPECT_EQ(net->places().size(), 1U);
}

TEST(ReadPnml, SpansPointIntoTheDocument) {
  diagnostics::Diagnostics out("net.pnml", "<pnml>\n<net id='n'>\n  <place id='a'/>\n</net></pnml>\n");
  const auto net = read_pnml(out);
  ASSERT_TRUE(net) << render(out);
  EXPECT_EQ(net->places()[0].span, (Span{3, 4, 5}));
}

TEST(ReadPnml, AMillionNestedPagesAreNoProblem) {
  std::string inside;
  constexpr int depth = 1'000'000;
  for (int level = 0; level < depth; ++level) inside += "<page>";
  inside += "<place id='deep'/>";
  for (int level = 0; level < depth; ++level) inside += "</page>";
  const auto net = read(inside);
  ASSERT_TRUE(net);
  EXPECT_EQ(net->places().size(), 1U);
}

TEST(ReadPnml, ALongChainOfReferencesIsFollowedOnce) {
  std::string inside = "<place id='r0'/>";
  constexpr int length = 100'000;
  for (int link = length; link > 0; --link)
    inside += "<referencePlace id='r" + std::to_string(link) + "' ref='r" + std::to_string(link - 1) + "'/>";
  EXPECT_TRUE(read(inside));
}

TEST(ReadPnml, ReadsWhatToPnmlWrites) {
  Net net;
  Place place;
  place.name = "a < b & \"c\"";
  place.tokens = 2;
  net.add(place);
  place.name = "other";
  place.tokens = 0;
  net.add(place);
  Transition transition;
  transition.name = "t";
  const std::vector<Arc> inputs{{PlaceId{0}, 3}}, outputs{{PlaceId{0}, 1}, {PlaceId{1}, 2}};
  net.add(transition, inputs, outputs);
  diagnostics::Diagnostics out("net.pnml", to_pnml(net));
  const auto again = read_pnml(out);
  ASSERT_TRUE(again) << render(out);
  EXPECT_EQ(to_pnml(*again), to_pnml(net));
}

}  // namespace
}  // namespace tessera::net
