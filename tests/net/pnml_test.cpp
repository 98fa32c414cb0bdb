#include "net/pnml.hpp"

#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <set>

namespace tessera::net {
namespace {

Net sample() {
  Net net;
  net.add(Place{.name = "robot[0].in", .tokens = 1});
  net.add(Place{.name = "a.y->b.x <\"&\x01>"});
  const std::vector<Arc> one{{PlaceId{0}, 1}}, two{{PlaceId{1}, 2}};
  net.add(Transition{.name = "t"}, one, two);
  net.add(Transition{.name = "u"}, two, one);
  return net;
}

pugi::xml_node parse(pugi::xml_document& document, const std::string& text) {
  const pugi::xml_parse_result result = document.load_string(text.c_str());
  EXPECT_TRUE(result) << result.description();
  return document.child("pnml").child("net");
}

TEST(Pnml, DeclaresAPlaceTransitionNet) {
  pugi::xml_document document;
  const pugi::xml_node net = parse(document, to_pnml(sample(), {.name = "line & follower"}));
  EXPECT_STREQ(document.child("pnml").attribute("xmlns").value(),
               "http://www.pnml.org/version-2009/grammar/pnml");
  EXPECT_STREQ(net.attribute("type").value(), "http://www.pnml.org/version-2009/grammar/ptnet");
  EXPECT_STREQ(net.child("name").child_value("text"), "line & follower");
}

TEST(Pnml, KeepsNamesAndMarkings) {
  pugi::xml_document document;
  const pugi::xml_node page = parse(document, to_pnml(sample())).child("page");
  std::vector<std::string> places;
  for (const pugi::xml_node place : page.children("place"))
    places.push_back(std::string(place.child("name").child_value("text")) + " " +
                     place.child("initialMarking").child_value("text"));
  EXPECT_EQ(places, (std::vector<std::string>{"robot[0].in 1", "a.y->b.x <\"&?> "}));
  std::vector<std::string> transitions;
  for (const pugi::xml_node transition : page.children("transition"))
    transitions.emplace_back(transition.child("name").child_value("text"));
  EXPECT_EQ(transitions, (std::vector<std::string>{"t", "u"}));
}

TEST(Pnml, KeepsArcsAndWeights) {
  pugi::xml_document document;
  const pugi::xml_node page = parse(document, to_pnml(sample())).child("page");
  std::vector<std::string> arcs;
  for (const pugi::xml_node arc : page.children("arc"))
    arcs.push_back(std::string(arc.attribute("source").value()) + ">" + arc.attribute("target").value() +
                   " " + arc.child("inscription").child_value("text"));
  EXPECT_EQ(arcs, (std::vector<std::string>{"p0>t0 ", "t0>p1 2", "p1>t1 2", "t1>p0 "}));
}

TEST(Pnml, GivesEveryElementAnIdOfItsOwn) {
  pugi::xml_document document;
  const pugi::xml_node net = parse(document, to_pnml(sample()));
  std::set<std::string> ids{net.attribute("id").value(), net.child("page").attribute("id").value()};
  for (const pugi::xml_node element : net.child("page").children())
    EXPECT_TRUE(ids.insert(element.attribute("id").value()).second) << element.attribute("id").value();
  EXPECT_EQ(ids.size(), 2U + 2 + 2 + 4);
}

}  // namespace
}  // namespace tessera::net
