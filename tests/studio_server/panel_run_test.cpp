// A robot that an operator drives from the page.
#include "running.hpp"

namespace tessera::server_test {

class TeleoperationInTheStudio : public RunOfTheStudio {
 protected:
  TeleoperationInTheStudio()
      : RunOfTheStudio("tests/studio_teleoperation", "studio/web/tests/e2e/projects/teleoperation") {}
  Reply operate(const std::string& run, const json& inputs, const std::string& who = "page 1",
                const std::string& path = "robot.console.drive") {
    json request{{"command", "panel"}, {"path", path}, {"operator", who}};
    if (!inputs.is_null()) request["inputs"] = inputs;
    return post("/api/runs/" + run + "/control", request);
  }
  /// Whether the left wheel comes to turn so fast.
  bool left_wheel_turns(const std::string& run, double speed) {
    return !await_info(run, [&](const json& now) {
              const json& values = now.at("values");
              return values.contains("robot.control.wheels") &&
                     std::abs(values.at("robot.control.wheels").at("left").get<double>() - speed) < 1e-6;
            }).is_null();
  }
};

TEST_F(TeleoperationInTheStudio, AnInputThatTheNetworkHasHeldBackIsNotUsed) {
  const std::string run = start({{"kind", "simulate"}, {"for", "1000s"}, {"speed", 1}});
  ASSERT_FALSE(await_state(run, "running").is_null());
  const auto operators = [&] { return json::parse(get("/api/runs/" + run + "/operators").body); };
  const auto drive = [&](double forward, double after) {
    return post("/api/runs/" + run + "/control", {{"command", "panel"},
                                                  {"path", "robot.console.drive"},
                                                  {"operator", "page 1"},
                                                  {"inputs", {{"forward", forward}}},
                                                  {"after", after},
                                                  {"within", 5}});
  };
  ASSERT_TRUE(eventually([&] { return drive(0.3, operators().at("stamp")).status == 200; }));
  EXPECT_EQ(operators().at("operators"), (json{{{"path", "robot.console.drive"}, {"operator", "page 1"}}}));
  EXPECT_TRUE(left_wheel_turns(run, 0)) << "nobody has repeated it";
  const double now = operators().at("stamp");
  const Reply late = drive(-0.3, now - 6);
  EXPECT_EQ(late.status, 200);
  EXPECT_EQ(json::parse(late.body).at("late"), true);
  EXPECT_GE(json::parse(late.body).at("stamp").get<double>(), now);
  EXPECT_FALSE(json::parse(drive(0.15, now).body).contains("late"));
  EXPECT_TRUE(left_wheel_turns(run, 5));
  EXPECT_EQ(operate(run, nullptr).status, 200);
  EXPECT_EQ(operators().at("operators"), json::array());
  ASSERT_EQ(control(run, {{"command", "stop"}}), 200);
}

TEST_F(TeleoperationInTheStudio, TheRobotMovesWhileSomebodyOperatesItAndStopsByItself) {
  const std::string run = start({{"kind", "simulate"}, {"for", "1000s"}, {"speed", 1}});
  ASSERT_FALSE(await_state(run, "running").is_null());
  const json panels = info(run).at("panels");
  ASSERT_EQ(panels.size(), 2U) << panels;
  EXPECT_EQ(panels[0].at("path"), "robot.console.drive");
  EXPECT_EQ(panels[0].at("controls")[0], (json{{"field", "turn"},
                                               {"control", "stick_x"},
                                               {"unit", "rad/s"},
                                               {"minimum", -2},
                                               {"maximum", 2},
                                               {"whole", false}}));
  EXPECT_EQ(panels[0].at("controls")[2].at("minimum"), nullptr) << "a button";
  EXPECT_EQ(panels[1].at("controls")[0].at("field"), "value");

  ASSERT_TRUE(eventually([&] { return operate(run, {{"forward", 0.3}, {"gear", 2}}).status == 200; }));
  EXPECT_TRUE(left_wheel_turns(run, 10));
  const Reply second = [&] {
    EXPECT_EQ(operate(run, {{"forward", 0.3}}).status, 200);
    return operate(run, {{"forward", -0.3}}, "page 2");
  }();
  EXPECT_EQ(second.status, 409);
  EXPECT_THAT(second.body, HasSubstr("another operator has the panel"));
  EXPECT_TRUE(left_wheel_turns(run, 0)) << "nobody has repeated it";
  EXPECT_EQ(operate(run, {{"forward", -0.3}}, "page 2").status, 200);
  EXPECT_TRUE(left_wheel_turns(run, -10));
  EXPECT_EQ(operate(run, nullptr, "page 2").status, 200);
  EXPECT_TRUE(left_wheel_turns(run, 0)) << "let go";

  EXPECT_EQ(operate(run, {{"forward", 3}}).status, 409) << "out of its range";
  EXPECT_EQ(operate(run, {{"forward", true}}).status, 409);
  EXPECT_EQ(operate(run, {{"forward", 0.1}}, "page 1", "robot.console").status, 409);
  EXPECT_EQ(operate(run, {{"forward", "fast"}}).status, 400);
  EXPECT_EQ(operate(run, json::array({1})).status, 400);
  ASSERT_EQ(control(run, {{"command", "stop"}}), 200);
  ASSERT_FALSE(await_state(run, "ended").is_null());
  EXPECT_EQ(operate(run, {{"forward", 0.1}}).status, 409);
}

}  // namespace tessera::server_test
