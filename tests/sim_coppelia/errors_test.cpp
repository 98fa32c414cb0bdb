#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>

#include "../eventually.hpp"
#include "scene_server.hpp"
#include "world_library.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Why the world does not open. Empty: it opens.
std::string problem_with(const WorldServer& server) {
  std::string error;
  static_cast<void>(open_world({.server = server}, error));
  return error;
}

/// A program that listens, and whatever comes, never says a word or says `answer`.
class PlainServer {
 public:
  explicit PlainServer(std::string answer) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(socket_, 5) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("no socket");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, answer = std::move(answer)] {
      for (int client = accept(socket_, nullptr, nullptr); client >= 0;
           client = accept(socket_, nullptr, nullptr))
        static_cast<void>(!answer.empty() && send(client, answer.data(), answer.size(), MSG_NOSIGNAL) > 0);
    });
  }
  ~PlainServer() {
    shutdown(socket_, SHUT_RDWR);
    thread_.join();
    close(socket_);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  int socket_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

TEST(CoppeliaErrors, AServerThatIsAbsentIsNamedAtOnce) {
  std::uint16_t port = 0;
  { port = SceneServer({}).address().port; }  // was free a moment ago
  EXPECT_EQ(problem_with({"127.0.0.1", port, "", 5s}),
            "no program listens at 127.0.0.1:" + std::to_string(port) +
                "; is CoppeliaSim running, with its add-on 'ZMQ remote API server'?");
  EXPECT_THAT(problem_with({"no.such.host.invalid", 23000, "", 5s}),
              HasSubstr("the host 'no.such.host.invalid' is not known"));
}

TEST(CoppeliaErrors, AServerThatHangsIsGivenUp) {
  SceneServer server({.silent = {"zmqRemoteApi.info"}});
  WorldServer address = server.address();
  address.timeout = 200ms;
  EXPECT_THAT(problem_with(address), HasSubstr("has not answered for 1 s"));
}

TEST(CoppeliaErrors, OtherServersAreNamed) {
  const PlainServer web("HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n");
  const PlainServer silent(""), newer("\xff\1\1\1\1\1\1\1\1\x7f\3");
  for (const PlainServer* server : {&web, &silent, &newer})
    EXPECT_THAT(problem_with({"127.0.0.1", server->port(), "", 300ms}),
                HasSubstr("is it CoppeliaSim's remote API?"));
}

TEST(CoppeliaErrors, AnotherVersionIsNamed) {
  EXPECT_THAT(problem_with(SceneServer({.version = 40400}).address()),
              HasSubstr("has the version 4.4.0; Tessera needs 4.5 or newer"));
}

TEST(CoppeliaErrors, ASimulationOfSomebodyElseIsLeftAlone) {
  SceneServer server({.runs_already = true});
  EXPECT_THAT(problem_with(server.address()), HasSubstr("a simulation runs already"));
  EXPECT_TRUE(server.is_running());
  EXPECT_THAT(server.calls(), ::testing::Not(::testing::Contains("sim.stopSimulation")));
}

/// A run in a process of its own that is killed while it simulates.
std::string mark_of_a_killed_run(SceneServer& server, const std::string& scene) {
  const pid_t run = fork();
  if (run == 0) {
    WorldServer address = server.address();
    address.scene = scene;
    std::string error;
    const auto world = open_world({.server = address}, error);
    if (world != nullptr) world->advance_to(Time(20ms));
    kill(getpid(), SIGKILL);
  }
  EXPECT_TRUE(eventually([&] { return !server.signals().empty(); }));
  const auto signals = server.signals();
  while (waitid(P_PID, static_cast<id_t>(run), nullptr, WEXITED | WNOWAIT) != 0) {
  }
  EXPECT_EQ(problem_with(server.address()), "") << "a process that has ended is gone before it is collected";
  waitpid(run, nullptr, 0);
  return signals.empty() ? std::string() : signals.at("tessera.run");
}

TEST(CoppeliaErrors, ASimulationThatAKilledRunHasLeftIsStopped) {
  for (const char* scene : {"", "/tmp/hall.ttt"}) {
    SceneServer server({});
    const std::string mark = mark_of_a_killed_run(server, scene);
    EXPECT_THAT(mark, HasSubstr("\"process\":"));
    EXPECT_FALSE(server.is_running());
    EXPECT_EQ(std::ranges::count(server.calls(), "sim.closeScene"), *scene == '\0' ? 0 : 1);

    server.run_by_hand({{"tessera.run", mark}});
    EXPECT_EQ(problem_with(server.address()), "") << "the next run does so, too";
    EXPECT_FALSE(server.is_running());
  }
}

TEST(CoppeliaErrors, ARunThatLivesOrMayLiveIsLeftAlone) {
  SceneServer server({});
  std::string error;
  const auto world = open_world({.server = server.address()}, error);
  ASSERT_NE(world, nullptr) << error;
  world->advance_to(Time(20ms));
  const auto signals = server.signals();
  EXPECT_THAT(problem_with(server.address()), AllOf(HasSubstr("another run of Tessera"),
                                                    HasSubstr("process " + std::to_string(getpid()) + ";")));
  EXPECT_TRUE(server.is_running());
  EXPECT_TRUE(world->finish(error)) << error;
  EXPECT_TRUE(server.signals().empty());

  std::string elsewhere = signals.at("tessera.run");
  const std::size_t machine = elsewhere.find("\"machine\":\"");
  ASSERT_NE(machine, std::string::npos);
  elsewhere.insert(machine + 11, "not ");
  for (const auto& [mark, message] : {std::pair{elsewhere, "If it was killed, begin the next run there"},
                                      {std::string("nonsense"), "a simulation runs already"},
                                      {std::string("[]"), "a simulation runs already"}}) {
    server.run_by_hand({{"tessera.run", mark}});
    EXPECT_THAT(problem_with(server.address()), HasSubstr(message));
    EXPECT_TRUE(server.is_running());
  }
  server.stop_by_hand();
  server.run_by_hand({});
  EXPECT_THAT(problem_with(server.address()), HasSubstr("a simulation runs already"));
}

TEST(CoppeliaErrors, AServerThatTakesNoMarkIsUsedAllTheSame) {
  SceneServer server({.no_marks = true});
  std::string error;
  const auto world = open_world({.server = server.address()}, error);
  ASSERT_NE(world, nullptr) << error;
  world->advance_to(Time(20ms));
  EXPECT_TRUE(world->finish(error)) << error;
}

TEST(CoppeliaErrors, ASceneThatDoesNotLoadIsTold) {
  SceneServer server({});
  WorldServer address = server.address();
  address.scene = "/tmp/hall.txt";
  EXPECT_THAT(problem_with(address), AllOf(HasSubstr("/tmp/hall.txt"), HasSubstr("file could not be read")));
  EXPECT_THAT(server.scenes(), ::testing::ElementsAre(1)) << "the scene of the user is open as before";

  std::string error;
  const auto world = open_world({.server = server.address()}, error);
  ASSERT_NE(world, nullptr) << error;
  EXPECT_NE(world->receptor(request_for<double>({"robot.s.a", "reflectance", {"eye_left"}, {}}), error),
            nullptr)
      << error;
}

TEST(CoppeliaErrors, ASceneThatCannotBeSimulatedIsClosedAgain) {
  SceneServer without({.no_main_script = true});
  SceneServer too_fast({.step_s = 0});
  for (SceneServer* server : {&without, &too_fast}) {
    WorldServer address = server->address();
    address.scene = "/tmp/hall.ttt";
    EXPECT_THAT(problem_with(address),
                HasSubstr(server == &without ? "has no main script" : "unknown version"));
    EXPECT_THAT(server->scenes(), ::testing::ElementsAre(1));
  }
  EXPECT_THAT(problem_with(without.address()), HasSubstr("has no main script"));
}

struct WhileItRuns : ::testing::Test {
  SceneServer server{{}};
  std::string error;
  std::unique_ptr<World> world = open_world({.server = server.address()}, error);
  std::unique_ptr<RealReceptor> eye =
      world->receptor(request_for<double>({"robot.s.a", "reflectance", {"eye_left"}, {}}), error);

  std::string failure_of_reading() {
    double value = 0;
    try {
      static_cast<void>(eye->read(std::as_writable_bytes(std::span(&value, 1))));
    } catch (const std::exception& thrown) {
      return thrown.what();
    }
    return "";
  }
  std::string failure_of_run() {
    std::string why;
    EXPECT_FALSE(world->finish(why));
    return why;
  }
};

TEST_F(WhileItRuns, AServerThatEndsFailsTheRun) {
  world->advance_to(Time(20ms));
  server.stop();
  // Without waiting for the timeout, whose message is another.
  world->advance_to(Time(40ms));
  EXPECT_THAT(failure_of_reading(), HasSubstr("has gone"));
  EXPECT_THAT(failure_of_run(), HasSubstr("has gone"));
}

TEST_F(WhileItRuns, AServerThatEndsInAStepFailsTheRunAtOnce) {
  world->advance_to(Time(0s));
  std::thread killer([this] {
    std::this_thread::sleep_for(100ms);
    server.stop();
  });
  for (int step = 1; step <= 100000 && failure_of_reading().empty(); ++step)
    world->advance_to(Time(step * 10ms));
  killer.join();
  EXPECT_THAT(failure_of_reading(), HasSubstr("has gone"));
  EXPECT_THAT(failure_of_run(), HasSubstr("has gone"));
}

TEST(CoppeliaErrors, ASimulatorThatWasBusyForTooLongIsLeftStopped) {
  SceneServer server({.late = "sim.getSimulationTime", .lateness = 400ms});
  WorldServer address = server.address();
  address.timeout = 200ms;
  std::string error;
  const auto world = open_world({.server = address}, error);
  ASSERT_NE(world, nullptr) << error;
  world->advance_to(Time(0s));
  std::this_thread::sleep_for(400ms);
  EXPECT_TRUE(server.is_running());
  EXPECT_FALSE(world->finish(error));
  EXPECT_THAT(error, HasSubstr("has not answered"));
  EXPECT_FALSE(server.is_running());
}

TEST_F(WhileItRuns, ASimulationThatGoesOnByItselfFailsTheRun) {
  world->advance_to(Time(20ms));
  server.step_by_itself();
  world->advance_to(Time(40ms));
  EXPECT_THAT(failure_of_reading(), HasSubstr("has gone on by itself"));
  EXPECT_THAT(failure_of_run(), HasSubstr("has gone on by itself"));
  EXPECT_FALSE(server.is_running()) << "it is stopped all the same";
}

TEST_F(WhileItRuns, ASimulationThatIsStoppedFailsTheRun) {
  world->advance_to(Time(20ms));
  server.begin_to_stop_by_hand();
  world->advance_to(Time(40ms));
  EXPECT_THAT(failure_of_run(), HasSubstr("paused or stopped"));
}

TEST_F(WhileItRuns, ASimulationThatIsPausedFailsTheRun) {
  world->advance_to(Time(20ms));
  server.pause();
  world->advance_to(Time(40ms));
  EXPECT_THAT(failure_of_run(), HasSubstr("paused or stopped"));
}

TEST_F(WhileItRuns, WhatTheSceneDoesNotHaveIsNamedWithWhatItHas) {
  struct Case {
    DriverRequest request;
    bool receptor;
    std::string message;
  };
  for (const Case& c : {
           Case{{"robot.s.a", "reflectance", {"eye_lef"}, {}},
                true,
                "robot.s.a: the world has no vision sensor 'eye_lef'; the world has: /robot/eye_left, "
                "/robot/eye_middle, /robot/eye_right, /camera"},
           Case{{"robot.s.a", "joint_position", {"/robot/eye_left"}, {}},
                true,
                "robot.s.a: '/robot/eye_left' is a vision sensor, not a joint; the world has: "
                "/robot/wheel_left, /robot/wheel_right, /arm/servo, /arm/torque, /arm/free, /arm/slide"},
           Case{{"robot.s.a", "scan", {"laser"}, {}},
                true,
                "robot.s.a: worlds of CoppeliaSim have no receptor 'scan'; they have sensor, joint_position, "
                "joint_velocity, pose, camera, depth, reflectance"},
           Case{{"robot.m.a", "weld", {"x"}, {}},
                false,
                "robot.m.a: worlds of CoppeliaSim have no effector 'weld'; they have actuator, also called "
                "velocity"},
           Case{{"robot.s.a", "sensor", {"wrist"}, {}},
                true,
                "robot.s.a: sensor 'wrist' gives 6 numbers, and the buffer is float64; make the buffer "
                "float64[6] or float32[6], or a structure of 6 such numbers"},
           Case{{"robot.s.a", "reflectance", {"eye_left"}, {{"footprint", 0.01}}},
                true,
                "robot.s.a: 'reflectance' has no option 'footprint'; its options: noise"},
           Case{{"robot.m.a", "actuator", {"/arm/free"}, {}},
                false,
                "robot.m.a: joint '/arm/free' has no motor that could be commanded; set its mode in the "
                "scene: dynamic with velocity, position or force control, or kinematic"},
           Case{{"robot.s.a", "camera", {"/camera"}, {}},
                true,
                "robot.s.a: uint8[36] is 4 x 3 pixels, and the buffer is float64; make the buffer uint8[36]"},
       }) {
    std::string why;
    const DriverRequest request = request_for<double>(c.request);
    EXPECT_TRUE(c.receptor ? world->receptor(request, why) == nullptr
                           : world->effector(request, why) == nullptr);
    EXPECT_EQ(why, c.message);
  }
}

TEST(CoppeliaErrors, WhatNeedsNoServerIsJudgedWithoutOne) {
  std::string error;
  const auto world = open_world(
      {.server = WorldServer{"127.0.0.1", 1, "", std::chrono::seconds(10)}, .only_asked = true}, error);
  ASSERT_NE(world, nullptr) << error;
  const auto problem = [&](DriverRequest request, bool effector, std::string type) {
    request.type = std::move(type);
    const auto found = world->problem_with(request, effector);
    return found ? found->text : "";
  };
  EXPECT_EQ(problem({"a.b.c", "reflectance", {"eye"}, {}}, false, "float64"), "");
  EXPECT_EQ(problem({"a.b.c", "sensor", {"wrist"}, {}}, false, "float64[6]"), "");
  EXPECT_EQ(problem({"a.b.c", "camera", {"front"}, {}}, false, "uint8[36]"), "");
  EXPECT_EQ(problem({"a.b.c", "velocity", {"left", "right"}, {}}, true, "float32[2]"), "");
  EXPECT_THAT(problem({"a.b.c", "velocity", {"left", "right"}, {}}, true, "float64"), HasSubstr("2 numbers"));
  EXPECT_EQ(problem({"a.b.twice", "velocity", {"up", "up"}, {}}, true, "float32[2]"),
            "joint 'up' stands twice in the list of a.b.twice");
  EXPECT_EQ(problem({"a.d.e", "velocity", {"left"}, {}}, true, "float32"),
            "joint 'left' is driven by a.b.c and by a.d.e");
  EXPECT_EQ(problem({"z.d.e", "velocity", {"left"}, {}}, true, "float32"), "") << "the scene decides";
  EXPECT_THAT(problem({"a.b.c", "reflectance", {"eye"}, {{"nois", 1}}}, false, "float64"),
              HasSubstr("no option 'nois'"));
  EXPECT_THAT(problem({"a.b.c", "scan", {"eye"}, {}}, false, "float64[4]"), HasSubstr("no receptor 'scan'"));
  EXPECT_THAT(problem({"a.b.c", "camera", {"front"}, {{"width", 64}, {"height", 48}}}, false, "uint8[36]"),
              HasSubstr("uint8[9216] is 64 x 48"));
}

TEST(CoppeliaErrors, WhatOnlyMujocoHasIsRefused) {
  SceneServer server({});
  std::string error;
  EXPECT_EQ(open_world({.track = "oval.png", .server = server.address()}, error), nullptr);
  EXPECT_THAT(error, HasSubstr("for worlds of MuJoCo"));
  EXPECT_EQ(open_world({.checks = "{}", .server = server.address()}, error), nullptr);
  EXPECT_THAT(error, HasSubstr("no checks"));
  EXPECT_EQ(open_world({.world = "hall.xml"}, error), nullptr);
  EXPECT_THAT(error, HasSubstr("needs a server"));
}

}  // namespace
}  // namespace tessera::testing
