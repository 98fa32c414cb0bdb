#include <gmock/gmock.h>

#include "layers/layers.hpp"
#include "layers/models.hpp"

namespace tessera::test {
namespace {

using testing::ElementsAre;

TEST(Pages, OfTheLineFollowerAreDrawnAsInThePaper) {
  const Built built = build(line_follower());
  EXPECT_THAT(transitions_of(built.pages, ""), ElementsAre("t_in: in -> robot", "t_out: robot -> out"));
  EXPECT_THAT(transitions_of(built.pages, "robot"),
              ElementsAre("t_in: in -> control + sensor + motor", "t_out: control + sensor + motor -> out"));
  EXPECT_THAT(transitions_of(built.pages, "robot.control"),
              ElementsAre("t_in: in -> init", "t_init_1: init -> follow", "t_follow_1: follow -> out"));
  EXPECT_THAT(transitions_of(built.pages, "robot.motor.drive"),
              ElementsAre("t1: in -> snd", "t2: snd -> 2", "t3: 2 -> rcv", "t4: rcv -> in",
                          "t5: rcv -> out [never]", "t6: rcv -> out [failure]"));
  EXPECT_THAT(places_of(built.pages, "robot.control.follow"), ElementsAre("in", "2", "out"));
}

TEST(Pages, ComeAfterTheirParents) {
  const Built built = build(fleet(3));
  for (std::uint32_t page = 1; page < built.pages.pages.size(); ++page)
    EXPECT_LT(built.pages.pages[page].parent.value, page);
}

TEST(Pages, NameTheInstanceThatExecutesThem) {
  const Built built = build(fleet(2));
  const auto instance = [&](const char* path) {
    return built.pages.pages[built.pages.find(path).value].subsystem;
  };
  EXPECT_EQ(instance(""), net::SubsystemId{});
  EXPECT_EQ(instance("robot[1]"), net::SubsystemId{});
  EXPECT_EQ(instance("robot[0].motor"), net::SubsystemId{2});
  EXPECT_EQ(instance("robot[1].control"), net::SubsystemId{3});
  EXPECT_EQ(instance("robot[1].sensor.watch.snd"), net::SubsystemId{4});
}

TEST(Pages, OfABehaviourStartItsTransitionFunctionAndNextIteration) {
  const Built built = build(line_follower());
  const net::Page& follow = built.pages.pages[built.pages.find("robot.control.follow").value];
  EXPECT_EQ(follow.nodes[follow.input].operation,
            (net::Operation{net::Operation::Kind::transition_function, {1}}));
  EXPECT_EQ(follow.nodes[2].operation.kind, net::Operation::Kind::next_iteration);
}

TEST(Pages, OfASubsystemThatReceivesFirstHaveTheSameBlocksInAnotherOrder) {
  spec::Model model = line_follower();
  model.definitions[0].subsystems[0].receive_first = true;
  const Built built = build(model), usual = build(line_follower());
  EXPECT_THAT(transitions_of(built.pages, "robot.control.follow"),
              ElementsAre("t1: in -> rcv", "t2: rcv -> 2", "t3: 2 -> snd", "t4: snd -> in",
                          "t5: snd -> out [never]", "t6: snd -> out [failure]"));
  const net::Page& follow = built.pages.pages[built.pages.find("robot.control.follow").value];
  EXPECT_EQ(follow.nodes[follow.input].operation.kind, net::Operation::Kind::next_iteration);
  EXPECT_EQ(follow.nodes[2].operation, (net::Operation{net::Operation::Kind::transition_function, {1}}));
  EXPECT_EQ(follow.transitions[0].role, Step::begin_receiving);
  EXPECT_EQ(follow.transitions[1].role, Step::end_receiving);
  EXPECT_EQ(follow.transitions[2].role, Step::begin_sending);
  for (const char* page : {"robot.control.follow.snd", "robot.control.follow.rcv", "robot.motor.drive"})
    EXPECT_EQ(transitions_of(built.pages, page), transitions_of(usual.pages, page));
  EXPECT_EQ(built.net.places().size(), usual.net.places().size());
  EXPECT_EQ(built.net.transitions().size(), usual.net.transitions().size());
}

TEST(Pages, BeginWithTheStartBehaviour) {
  spec::Model model = line_follower();
  model.definitions[0].subsystems[0].start = {1};
  EXPECT_EQ(transitions_of(build(model).pages, "robot.control").front(), "t_in: in -> follow");
}

TEST(Pages, AreRefusedWhereNothingWouldRun) {
  spec::Model model;
  diagnostics::Diagnostics out("m.yaml", "");
  EXPECT_FALSE(layers::build(model, out));
  ASSERT_EQ(out.sorted().size(), 1U);
  EXPECT_EQ(out.sorted()[0].code, "E410");

  model = line_follower();
  model.definitions[0].subsystems[1].behaviours.clear();
  diagnostics::Diagnostics more("m.yaml", "");
  EXPECT_FALSE(layers::build(model, more));
  ASSERT_EQ(more.sorted().size(), 1U);
  EXPECT_EQ(more.sorted()[0].message, "subsystem 'sensor' has no behaviours");
}

}  // namespace
}  // namespace tessera::test
