#include "drawing/picture.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "layers/models.hpp"

namespace tessera::drawing {
namespace {

using testing::ElementsAre;

std::vector<std::string> names(const auto& elements) {
  std::vector<std::string> all;
  for (const auto& element : elements) all.push_back(element.name.plain());
  return all;
}

Picture picture(const test::Built& built, const char* path, unsigned levels = 0) {
  Options options;
  options.levels = levels;
  return picture_of(built.pages, built.pages.find(path), options);
}

TEST(Picture, OfAPageShowsItsNodesAndTransitions) {
  const test::Built built = test::build(test::line_follower());
  const Picture drawn = picture(built, "robot.control.follow");
  EXPECT_EQ(drawn.title.plain(), "robot.control.follow");
  EXPECT_THAT(names(drawn.circles), ElementsAre("in", "snd", "2", "rcv", "out"));
  EXPECT_THAT(names(drawn.bars), ElementsAre("t1", "t2", "t3", "t4", "t5", "t6"));
  EXPECT_TRUE(drawn.circles[1].page);
  EXPECT_FALSE(drawn.circles[0].page);
  EXPECT_EQ(drawn.circles[0].path, "robot.control.follow.in");
  EXPECT_EQ(drawn.circles[0].details, (std::vector<Label>{Label("follow()")}));
  EXPECT_EQ(drawn.arrows.size(), 12U);
  EXPECT_TRUE(drawn.frames.empty());
}

TEST(Picture, PutsConditionsInSquareBrackets) {
  const test::Built built = test::build(test::line_follower());
  const Picture drawn = picture(built, "robot.motor.drive.rcv");
  ASSERT_EQ(names(drawn.bars).back(), "velocity.timeout");
  EXPECT_EQ(drawn.bars.back().details.at(0).plain(), "[200 ms]");
  const Picture drive = picture(built, "robot.motor.drive");
  EXPECT_EQ(drive.bars[3].fires, Fires::by_condition);
  EXPECT_EQ(drive.bars[4].fires, Fires::never);
  EXPECT_EQ(drive.bars[4].details.at(0).plain(), "[never]");
  EXPECT_EQ(drive.bars[5].fires, Fires::after_failure) << "a device may fail";
  EXPECT_EQ(drive.bars[5].details.at(0).plain(), "[failure]");
}

TEST(Picture, MarksFusedPlacesAndTokens) {
  const test::Built built = test::build(test::line_follower());
  const Picture drawn = picture(built, "robot.control.follow.snd");
  ASSERT_THAT(names(drawn.circles), ElementsAre("in", "motion.2", "out", "motion.empty", "motion.full"));
  EXPECT_TRUE(drawn.circles[3].fused);
  EXPECT_EQ(drawn.circles[3].tokens, 1U);
  EXPECT_EQ(drawn.circles[4].tokens, 0U);
  EXPECT_FALSE(drawn.circles[1].fused);
  EXPECT_EQ(drawn.circles[3].path, "robot.control.motion->robot.motor.velocity.empty");
}

TEST(Picture, KnowsWhichArrowsGoBack) {
  const test::Built built = test::build(test::line_follower());
  std::vector<std::string> back;
  for (const char* path : {"robot.control.follow", "robot.control.follow.snd"}) {
    const Picture drawn = picture(built, path);
    for (const Arrow& arrow : drawn.arrows)
      if (arrow.back)
        back.push_back(drawn.bars[arrow.bar].name.plain() + " -> " +
                       drawn.circles[arrow.circle].name.plain());
  }
  EXPECT_THAT(back, ElementsAre("t4 -> in", "motion.t2 -> motion.full"));
}

// With all levels opened, the picture is the flat net: the same places, transitions and arcs.
TEST(Picture, OfEverythingIsTheFlatNet) {
  for (const spec::Model& model : {test::line_follower(), test::fleet(2), test::random_model(5)}) {
    const test::Built built = test::build(model);
    const Picture drawn = picture(built, "", Options::all);
    EXPECT_EQ(drawn.circles.size(), built.net.places().size());
    EXPECT_EQ(drawn.bars.size(), built.net.transitions().size());
    EXPECT_EQ(drawn.arrows.size(), built.net.arc_count());
    std::vector<std::string> arrows, arcs;
    for (const Arrow& arrow : drawn.arrows)
      arrows.push_back(drawn.bars[arrow.bar].path + (arrow.to_bar ? " < " : " > ") +
                       drawn.circles[arrow.circle].path);
    for (std::uint32_t index = 0; index < built.net.transitions().size(); ++index) {
      const net::TransitionId id{index};
      for (const net::Arc& arc : built.net.preset(id))
        arcs.push_back(built.net[id].name + " < " + built.net[arc.place].name);
      for (const net::Arc& arc : built.net.postset(id))
        arcs.push_back(built.net[id].name + " > " + built.net[arc.place].name);
    }
    EXPECT_THAT(arrows, testing::UnorderedElementsAreArray(arcs));
  }
}

TEST(Picture, OpensAsManyLevelsAsAskedFor) {
  const test::Built built = test::build(test::line_follower());
  const Picture drawn = picture(built, "robot", 1);
  EXPECT_THAT(names(drawn.frames), ElementsAre("control", "sensor", "motor"));
  EXPECT_EQ(std::ranges::count_if(drawn.circles, &Circle::page), 4) << "init, follow, watch, drive";
}

TEST(Picture, PutsAFusedPlaceOutsideTheFramesThatShareIt) {
  const test::Built built = test::build(test::line_follower());
  const auto frame_of = [&](const char* root, const char* path) {
    const Picture drawn = picture(built, root, Options::all);
    const auto found = std::ranges::find(drawn.circles, path, &Circle::path);
    return found->frame.valid() ? drawn.frames[found->frame.value].name.plain() : "outside";
  };
  EXPECT_EQ(frame_of("", "robot.control.motion->robot.motor.velocity.full"), "robot");
  EXPECT_EQ(frame_of("robot", "robot.control.motion->robot.motor.velocity.full"), "outside");
  EXPECT_EQ(frame_of("robot.motor", "robot.control.motion->robot.motor.velocity.full"), "rcv");
}

}  // namespace
}  // namespace tessera::drawing
