// The first example in a scene: its own controller, from the specification to the recording.
#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "command.hpp"
#include "scene_server.hpp"

namespace tessera::cli_test {
namespace {

using ::testing::HasSubstr;
using testing::SceneServer;

const std::string oval = TESSERA_SOURCE_DIR "/share/tessera/tracks/oval.png";

/// The line follower with a section `coppelia` in place of world and track, and otherwise unchanged.
class InCoppelia : public Command {
 protected:
  InCoppelia() : project_(example("01_line_follower")) {}

  void use(const SceneServer& server) { use(server.address().port); }
  void use(std::uint16_t port) {
    const fs::path spec = project_ / "spec.yaml";
    std::string text = content_of(fs::path(TESSERA_SOURCE_DIR) / "examples/01_line_follower/spec.yaml");
    const std::size_t begin = text.find("  world: line_world.xml"), end = text.find("  drivers:", begin);
    ASSERT_NE(end, std::string::npos);
    text.replace(begin, end - begin,
                 "  coppelia: { host: 127.0.0.1, port: " + std::to_string(port) + ", timeout: 2 s }\n");
    text.erase(text.find("  checks:"));  // scenes have none
    write(spec, text);
  }

  fs::path project_;
};

TEST_F(InCoppelia, TheLineFollowerKeepsToItsLine) {
  SceneServer server({.track = oval, .start = {{1.2, 0.1}, 0}, .step_s = 0.01});
  use(server);
  const project::Exit checked = tessera("check 01_line_follower");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_TRUE(server.calls().empty()) << "check calls no server";

  const nlohmann::json run = json("simulate 01_line_follower --for 60s");
  EXPECT_EQ(run.at("failed"), false);
  const auto track = sim::Track::load(oval, 0.005);
  const sim::LineMetrics metrics = measure(skeleton(*track), server.trace());
  EXPECT_GT(metrics.laps, 1.5);
  EXPECT_LT(metrics.longest_loss_s, 1);
  EXPECT_NEAR(server.trace().points.back().t_s, 60, 0.1) << "in lock-step";
  EXPECT_FALSE(server.is_running());
  EXPECT_EQ(server.joint("/robot/wheel_left"), 0) << "the safe command";
  EXPECT_EQ(tessera("replay 01_line_follower/.tessera/last/recording.tsr --check").code, 0);

  const project::Exit schedules = tessera("schedules 3 01_line_follower --for 500ms");
  EXPECT_EQ(schedules.code, 0) << schedules.text;
  EXPECT_FALSE(server.is_running());

  const project::Exit listed = tessera("world 01_line_follower");
  EXPECT_EQ(listed.code, 0) << listed.text;
  EXPECT_THAT(listed.text, HasSubstr("CoppeliaSim at 127.0.0.1:"));
  EXPECT_THAT(listed.text, HasSubstr("robot.motors.wheel_left: { actuator: wheel_left }"));
}

TEST_F(InCoppelia, AMissingServerAndADyingOneAreToldInOneSentence) {
  std::uint16_t port = 0;
  {
    SceneServer server({.track = oval});
    port = server.address().port;
    use(server);
    std::thread killer([&] {
      while (server.trace().points.size() < 100) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      server.stop();
    });
    const project::Exit dying = tessera("simulate 01_line_follower --for 10min");
    killer.join();
    EXPECT_EQ(dying.code, 1);
    EXPECT_THAT(dying.text, HasSubstr("the server at 127.0.0.1:" + std::to_string(port) + " has gone"));
  }
  const project::Exit absent = tessera("simulate 01_line_follower --for 1s");
  EXPECT_EQ(absent.code, 1);
  EXPECT_THAT(absent.text, HasSubstr("no program listens at 127.0.0.1:" + std::to_string(port)));
}

TEST_F(InCoppelia, WhatIsWrongWithADriverHasItsLine) {
  use(1);
  replace(project_ / "spec.yaml", "{ reflectance: eye_left }", "{ reflectance: eye_left, footprint: 8 mm }");
  const project::Exit checked = tessera("check 01_line_follower");
  EXPECT_EQ(checked.code, 1);
  EXPECT_THAT(checked.text, HasSubstr("error E311: 'reflectance' has no option 'footprint'"));
}

TEST_F(InCoppelia, ASceneThatIsNoFileIsToldByCheck) {
  use(1);
  replace(project_ / "spec.yaml", "port: 1,", "port: 1, scene: hall.ttt,");
  EXPECT_THAT(tessera("check 01_line_follower").text, HasSubstr("error E310: there is no scene 'hall.ttt'"));
}

}  // namespace
}  // namespace tessera::cli_test
