#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "drawing.hpp"
#include "small_worlds.hpp"

namespace tessera::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Two balls on one rail: the left one rolls to the right at 1 m/s and meets the other after 0.8 s.
constexpr const char* rail = R"(<mujoco model="rail">
  <option timestep="0.002" gravity="0 0 0"/>
  <worldbody>
    <site name="goal" type="box" size="0.2 0.2 0.2" pos="1.7 0 0"/>
    <body name="ball[0]"><joint name="ball[0]/x" type="slide" axis="1 0 0"/>
      <geom name="ball[0]/skin" type="sphere" size="0.1" mass="1"/></body>
    <body name="ball[1]" pos="1 0 0"><joint name="ball[1]/x" type="slide" axis="1 0 0"/>
      <geom name="ball[1]/skin" type="sphere" size="0.1" mass="1"/></body>
    <body name="post" pos="0 3 0"><geom name="pole" type="sphere" size="0.1"/></body>
  </worldbody>
  <actuator><velocity name="push" joint="ball[0]/x" kv="50"/></actuator>
  <sensor><jointvel name="pace" joint="ball[0]/x"/><framepos name="where" objtype="body" objname="post"/></sensor>
</mujoco>)";

class JudgedWorld {
 public:
  explicit JudgedWorld(const json& checks, const json& measures = json::object()) {
    const json written{{"checks", checks}, {"measures", measures}};
    world_ = open({.world = file_with("rail.xml", rail), .checks = written.dump()});
    push_ = effector<double>(*world_, {.path = "a.b.c", .kind = "actuator", .targets = {"push"}});
    EXPECT_TRUE(write_as(*push_, 1.0));
  }
  std::vector<WorldFailure> run_to(double end_s) {
    world_->advance_to(Time(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(end_s))));
    return world_->take_failures();
  }
  json results() { return json::parse(world_->results()); }

 private:
  std::unique_ptr<World> world_;
  std::unique_ptr<RealEffector> push_;
};

json check(const char* when, const char* formula) {
  return {{"name", "it"}, {"when", when}, {"formula", formula}};
}

TEST(Judging, ACollisionIsAFailureWithItsTime) {
  JudgedWorld world(json::array({check("never", "contact(ball[*], ball[*])")}));
  EXPECT_TRUE(world.run_to(0.5).empty());
  const std::vector<WorldFailure> failures = world.run_to(3);
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(failures[0].check, "it");
  EXPECT_NEAR(failures[0].time_s, 0.82, 0.03);
  EXPECT_THAT(failures[0].text, HasSubstr("ball[0], ball[1] touch"));
  EXPECT_TRUE(world.run_to(4).empty());
}

TEST(Judging, AMeasureHasNoRunningIndex) {
  EXPECT_THROW(JudgedWorld(json::array(), {{"gap", "distance(ball[i], ball[i+1])"}}), std::runtime_error);
}

TEST(Judging, MeasuresTellWhenTheyWereLeast) {
  JudgedWorld world(json::array({check("eventually", "inside(ball[1], goal)")}),
                    {{"gap", "distance(ball[*], ball[*])"},
                     {"pace", "sensor(pace)"},
                     {"speed", "speed(ball[0])"},
                     {"post", "sensor(where, 1) + height(post)"}});
  EXPECT_TRUE(world.run_to(3).empty());
  const json results = world.results();
  EXPECT_EQ(results["checks"][0]["verdict"], "held");
  EXPECT_GT(results["checks"][0]["time_s"], 1);
  const json gap = results["measures"]["gap"];
  EXPECT_NEAR(gap["greatest"].get<double>(), 1, 0.01);
  EXPECT_NEAR(gap["least"].get<double>(), 0.2, 0.02);
  EXPECT_NEAR(gap["least_at_s"].get<double>(), 0.82, 0.1);
  EXPECT_EQ(results["measures"]["pace"]["greatest"], results["measures"]["speed"]["greatest"]);
  EXPECT_EQ(results["measures"]["post"]["mean"], 3);
}

TEST(Judging, WhatTheWorldLacksIsNamed) {
  const auto problem = [](const char* formula) -> std::string {
    try {
      JudgedWorld world(json::array({check("never", formula)}));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem("contact(bal[0], post)"),
              HasSubstr("check 'it': the world has no model, body or geom 'bal[0]'"));
  EXPECT_THAT(problem("inside(ball[0], gaol)"), HasSubstr("did you mean 'goal'?"));
  EXPECT_THAT(problem("sensor(where) > 1"), HasSubstr("gives 3 numbers"));
  EXPECT_THAT(problem("contact(goal)"), HasSubstr("no shape"));
  EXPECT_EQ(problem("contact(post)"), "");
}

/// The pose of a placed model would be that of the body it stands in, a constant.
TEST(PlacedModels, HaveNoPoseOfTheirOwnButTheirBodiesHave) {
  const std::string cart = file_with("posed.xml", R"(<mujoco><worldbody>
    <body name="base"><joint name="x" type="slide" axis="1 0 0"/><geom size="0.1"/></body>
    </worldbody></mujoco>)");
  const std::string hall = file_with("posed_hall.xml", "<mujoco><worldbody/></mujoco>");
  const json models = json::array({{{"instance", "cart"}, {"model", cart}, {"at_m", {3, 0, 0}}}});
  auto world = open({.world = hall, .models = models.dump()});
  using Pose = std::array<double, 7>;
  const auto pose_of = [&](const char* name) {
    return receptor<Pose>(*world, {.path = "cart.a.b", .kind = "pose", .targets = {name}});
  };
  EXPECT_EQ(read_as<Pose>(*pose_of("base"))[0], 3);
  try {
    pose_of("cart");
    FAIL() << "a constant pose";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("'cart' is the place of a model, which never moves"));
    EXPECT_THAT(error.what(), HasSubstr("such as 'base'"));
  }
}

/// A placed model stands in a body that never moves. The check means the robot in it.
TEST(Judging, APlacedModelIsWhereItsFirstBodyIs) {
  const std::string cart = file_with("cart.xml", R"(<mujoco><worldbody>
    <body name="cart" pos="0 0 0.1"><joint name="x" type="slide" axis="1 0 0"/>
      <geom name="box" type="box" size="0.1 0.1 0.1"/></body></worldbody>
    <actuator><velocity name="drive" joint="x" kv="200"/></actuator></mujoco>)");
  const std::string hall = file_with("hall.xml", R"(<mujoco><option gravity="0 0 0"/><worldbody>
    <site name="end" size="0.3 0.3 0.3" type="box" pos="1 0 0"/></worldbody></mujoco>)");
  const json models = json::array({{{"instance", "cart[0]"}, {"model", cart}, {"at_m", {0, 0, 0}}},
                                   {{"instance", "cart[1]"}, {"model", cart}, {"at_m", {0, 2, 0}}}});
  const json judged{
      {"checks",
       {check("eventually", "inside(cart[0], end)"),
        {{"name", "apart"}, {"when", "always"}, {"formula", "distance(cart[i], cart[i+1]) < 2.1"}}}},
      {"measures", {{"pace", "speed(cart[0])"}}}};
  auto world = open({.world = hall, .checks = judged.dump(), .models = models.dump()});
  auto drive = effector<double>(*world, {.path = "cart[0].a.b", .kind = "actuator", .targets = {"drive"}});
  EXPECT_TRUE(write_as(*drive, 1.0));
  world->advance_to(Time(std::chrono::milliseconds(1500)));
  const json results = json::parse(world->results());
  EXPECT_EQ(results["checks"][0]["verdict"], "held");
  EXPECT_EQ(results["checks"][1]["verdict"], "failed");
  EXPECT_NEAR(results["measures"]["pace"]["greatest"].get<double>(), 1, 0.05);
}

TEST(Judging, NothingIsJudgedOnAWorldWhosePhysicsHasFailed) {
  const std::string failing = file_with("failing.xml", R"(<mujoco><option timestep="0.01"/><worldbody>
    <body name="p"><joint type="slide" axis="1 0 0" stiffness="1e7" springref="0.1"/>
      <geom type="sphere" size="0.1" mass="0.01"/></body>
    <body name="q" pos="3 0 0"><freejoint/><geom size="0.1"/></body>
    <site name="goal" type="box" size="1000 1000 1000"/></worldbody></mujoco>)");
  const json judged{
      {"checks",
       {check("at_end", "inside(q, goal)"),
        check("never", "height(q) > 5"),
        check("always", "inside(q, goal)"),
        check("eventually", "height(q) < -4"),
        {{"name", "soon"}, {"when", "eventually"}, {"formula", "height(q) < 9"}, {"within_s", 2}}}}};
  auto world = open({.world = failing, .checks = judged.dump()});
  const auto drive = [&] { world->advance_to(Time(std::chrono::seconds(3))); };
  EXPECT_THROW(drive(), std::runtime_error);
  const json results = json::parse(world->results());
  for (const std::size_t index : {0U, 1U, 2U, 3U})
    EXPECT_EQ(results["checks"][index]["verdict"], "open") << index;
  EXPECT_EQ(results["checks"][4]["verdict"], "held") << "it was decided before";
  EXPECT_TRUE(world->take_failures().empty());
}

/// A robot that is pushed along a line 1 m long, with one eye, and leaves it.
TEST(Judging, HowARobotKeepsToTheLineIsMeasuredAndChecked) {
  const std::string sled = file_with("sled.xml", R"(<mujoco><option gravity="0 0 0"/><worldbody>
    <body name="sled[0]" pos="0.5 0.5 0.1"><joint name="x" type="slide" axis="1 0 0"/>
      <geom size="0.02"/><site name="eye"/></body>
    <body name="blind" pos="0 2 0"><joint type="slide" axis="1 0 0"/><geom size="0.02"/></body></worldbody>
    <actuator><velocity name="push" joint="x" kv="1"/></actuator></mujoco>)");
  const json checks = json::array({check("never", "line_lost(sled[0]) > 0.3")});
  const json judged{
      {"checks", checks},
      {"measures",
       {{"laps", "laps(sled[0])"}, {"off", "line_error(sled[0])"}, {"lost", "line_lost(sled[0])"}}}};
  const std::string floor =
      write_png(Drawing{.width_m = 2, .height_m = 1, .strokes = {{.points = {{0.5, 0.5}, {1.5, 0.5}}}}},
                "straight.png");
  auto world = open({.world = sled, .track = floor, .metres_per_pixel = 0.005, .checks = judged.dump()});
  auto eye = receptor<double>(*world, {.path = "sled[0].a.eye", .kind = "reflectance", .targets = {"eye"}});
  auto push = effector<double>(*world, {.path = "sled[0].a.b", .kind = "actuator", .targets = {"push"}});
  EXPECT_TRUE(write_as(*push, 1.0));
  world->advance_to(Time(std::chrono::seconds(2)));
  const json results = json::parse(world->results());
  EXPECT_EQ(results["checks"][0]["verdict"], "failed");
  EXPECT_NEAR(results["checks"][0]["time_s"].get<double>(), 1.4, 0.15);
  EXPECT_NEAR(results["measures"]["laps"]["greatest"].get<double>(), 1, 0.15);
  EXPECT_GT(results["measures"]["off"]["last"].get<double>(), 0.5);
  EXPECT_NEAR(results["measures"]["lost"]["last"].get<double>(), 0.9, 0.15);

  const auto problem = [&](const char* formula, const std::string& track) -> std::string {
    const json one{{"checks", json::array({check("never", formula)})}};
    try {
      open({.world = sled, .track = track, .metres_per_pixel = 0.005, .checks = one.dump()})
          ->advance_to(Time(std::chrono::milliseconds(10)));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem("laps(sled[0]) > 1", ""), HasSubstr("only a world with a track has a line to follow"));
  EXPECT_THAT(problem("laps(sleigh) > 1", floor), HasSubstr("the world has no model or body 'sleigh'"));
  EXPECT_THAT(problem("laps(blind) > 1", floor), HasSubstr("'blind' has no light sensor"));
}

/// Reading never disturbs: a judged run has the same bytes as one that is not.
/// A frame that stays, as a placed model has, and the parts of the model on it.
std::string cart(const std::string& parts) {
  return R"(<mujoco model="cart"><option gravity="0 0 0"/>
  <worldbody>
    <body name="cart" pos="1 0 0"><geom type="sphere" size="0.1"/>)" +
         parts + R"(</body>
    <body name="post"><geom type="sphere" size="0.1"/></body>
  </worldbody>
</mujoco>)";
}

const std::string cart_gap = json{{"measures", {{"gap", "distance(cart, post)"}}}}.dump();

/// The measured distance of the model `cart` from the post.
double gap_of_cart(const std::string& parts) {
  const auto world = open({.world = file_with("cart.xml", cart(parts)), .checks = cart_gap});
  world->advance_to(Time(std::chrono::seconds(1)));
  return json::parse(world->results())["measures"]["gap"]["last"].get<double>();
}

TEST(Judging, TheOriginOfAPlacedModelIsWhereItsBodyIs) {
  const std::string geom = R"(<geom type="sphere" size="0.1"/>)";
  EXPECT_NEAR(gap_of_cart(R"(<body name="cart/base" pos="2 0 0"><joint type="slide"/>)" + geom + "</body>"),
              3, 1e-6);
  EXPECT_NEAR(gap_of_cart(R"(<body name="cart/x"><joint type="slide" axis="1 0 0"/>
                             <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
                             <body name="cart/base" pos="3 0 0"><joint type="slide" axis="0 1 0"/>)" +
                          geom + "</body></body>"),
              4, 1e-6);
  EXPECT_NEAR(gap_of_cart(R"(<body name="cart/foot" pos="2 0 0"><body name="cart/arm" pos="2 0 0"><joint/>)" +
                          geom + "</body></body>"),
              1, 1e-6);
}

TEST(Judging, AModelOfSeveralMovingBodiesHasNoOrigin) {
  const std::string rest = R"(<joint type="slide"/><geom type="sphere" size="0.1"/></body>)";
  const std::string file = file_with("cart.xml", cart(R"(<body name="cart/left" pos="1 0 0">)" + rest +
                                                      R"(<body name="cart/right" pos="2 0 0">)" + rest));
  try {
    static_cast<void>(open({.world = file, .checks = cart_gap}));
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("'cart' has several bodies that move on their own"));
    EXPECT_THAT(error.what(), HasSubstr("such as 'cart/left'"));
  }
}

TEST(Judging, DoesNotChangeTheRun) {
  const auto last = [](const json& checks, const json& measures) {
    auto world = open({.world = file_with("rail.xml", rail),
                       .checks = json{{"checks", checks}, {"measures", measures}}.dump()});
    auto push = effector<double>(*world, {.path = "a.b.c", .kind = "actuator", .targets = {"push"}});
    EXPECT_TRUE(write_as(*push, 1.0));
    auto where =
        receptor<double>(*world, {.path = "a.b.d", .kind = "joint_position", .targets = {"ball[1]/x"}});
    world->advance_to(Time(std::chrono::seconds(2)));
    return read_as<double>(*where);
  };
  EXPECT_EQ(last(json::array(), json::object()),
            last(json::array({check("never", "contact(post)")}),
                 {{"pace", "sensor(pace)"}, {"speed", "speed(ball[0])"}}));
}

}  // namespace
}  // namespace tessera::testing
