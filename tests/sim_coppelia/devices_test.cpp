#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "scene_server.hpp"
#include "tessera/world_state.hpp"
#include "world_library.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Time at(Duration time) { return Time(time); }

struct InAScene : ::testing::Test {
  SceneServer server{{.start = {{1, 2}, 0.5}, .step_s = 0.01}};
  std::unique_ptr<World> world = open();

  std::unique_ptr<World> open() {
    std::string error;
    auto opened = open_world({.server = server.address()}, error);
    if (!opened) throw std::runtime_error(error);
    return opened;
  }
  template <class T>
  std::unique_ptr<RealReceptor> receptor(DriverRequest request) {
    std::string error;
    auto made = world->receptor(request_for<T>(std::move(request)), error);
    if (!made) throw std::runtime_error(error);
    return made;
  }
  template <class T>
  std::unique_ptr<RealEffector> effector(DriverRequest request) {
    std::string error;
    auto made = world->effector(request_for<T>(std::move(request)), error);
    if (!made) throw std::runtime_error(error);
    return made;
  }
};

template <class T>
T read(RealReceptor& receptor) {
  T value{};
  if (!receptor.read(std::as_writable_bytes(std::span(&value, 1)))) throw std::runtime_error("no value");
  return value;
}
template <class T>
bool write(RealEffector& effector, const T& value) {
  return effector.write(std::as_bytes(std::span(&value, 1)));
}

TEST_F(InAScene, StepsOnceBeforeTheStartAndThenInLockStep) {
  world->advance_to(at(0s));
  EXPECT_EQ(server.trace().points.size(), 1u);
  world->advance_to(at(9999us));
  EXPECT_EQ(server.trace().points.size(), 1u);
  world->advance_to(at(10ms));
  EXPECT_EQ(server.trace().points.size(), 2u);
  world->advance_to(at(50ms));
  EXPECT_EQ(server.trace().points.size(), 6u);
  EXPECT_EQ(world->state("robot")->time(), 50ms);
  std::string error;
  EXPECT_TRUE(world->finish(error)) << error;
  EXPECT_FALSE(server.is_running());
}

TEST_F(InAScene, SensorsGiveTheirNumbers) {
  const auto bumper = receptor<double>({"robot.s.a", "sensor", {"bumper"}, {}});
  const auto both = receptor<std::array<float, 7>>({"robot.s.b", "sensor", {"/bumper", "/wrist"}, {}});
  world->advance_to(at(0s));
  EXPECT_EQ(read<double>(*bumper), 0.25);
  EXPECT_THAT((read<std::array<float, 7>>(*both)), ElementsAre(0.25F, 1, 2, 3, 4, 5, 6));
  world->advance_to(at(200ms));
  EXPECT_EQ(read<double>(*bumper), -1) << "as a range finder of MuJoCo that hits nothing";
}

TEST_F(InAScene, BeforeTheFirstStepAnEyeHasNoValueAndAProximitySensorDetectsNothing) {
  const auto bumper = receptor<double>({"robot.s.a", "sensor", {"bumper"}, {}});
  const auto eye = receptor<double>({"robot.s.b", "reflectance", {"eye_left"}, {}});
  double value = 7;
  EXPECT_EQ(read<double>(*bumper), -1) << "as CoppeliaSim 4.9.0 answers";
  EXPECT_FALSE(eye->read(std::as_writable_bytes(std::span(&value, 1))));
  EXPECT_EQ(value, 7);
}

struct Flat {
  double heading = 0, y = 0, x = 0;
};

TEST_F(InAScene, PosesHaveTheQuaternionOfOurOrder) {
  const auto pose = receptor<std::array<double, 7>>({"robot.s.pose", "pose", {"/robot"}, {}});
  world->advance_to(at(0s));
  const auto all = read<std::array<double, 7>>(*pose);
  EXPECT_THAT(all, ElementsAre(1, 2, 0.03, ::testing::DoubleEq(std::cos(0.25)), 0, 0,
                               ::testing::DoubleEq(std::sin(0.25))));
}

TEST_F(InAScene, CommandsActFromTheNextStepOn) {
  const auto wheels =
      effector<std::array<float, 2>>({"robot.m.w", "velocity", {"wheel_left", "wheel_right"}, {}});
  const auto angles =
      receptor<std::array<double, 2>>({"robot.s.w", "joint_position", {"wheel_left", "wheel_right"}, {}});
  const auto speed = receptor<double>({"robot.s.v", "joint_velocity", {"/robot/wheel_right"}, {}});
  EXPECT_TRUE(write(*wheels, std::array<float, 2>{0, 0}));
  world->advance_to(at(0s));
  EXPECT_TRUE(write(*wheels, std::array<float, 2>{3, 3}));
  EXPECT_TRUE(write(*wheels, std::array<float, 2>{2, -4}));
  EXPECT_EQ(server.joint("/robot/wheel_left"), 0);
  EXPECT_THAT((read<std::array<double, 2>>(*angles)), ElementsAre(0, 0));
  world->advance_to(at(10ms));
  EXPECT_THAT((read<std::array<double, 2>>(*angles)), ElementsAre(0.02, -0.04));
  EXPECT_EQ(read<double>(*speed), -4);
  EXPECT_FALSE(write(*wheels, std::array<float, 2>{NAN, 0}));
  EXPECT_TRUE(write(*wheels, std::array<float, 2>{0, 0})) << "the safe command at the end";
  std::string error;
  EXPECT_TRUE(world->finish(error));
  EXPECT_EQ(server.joint("/robot/wheel_right"), 0) << "is sent although no step comes any more";
}

TEST_F(InAScene, TheModeOfAJointSaysWhatItsCommandMeans) {
  const auto arm =
      effector<std::array<double, 3>>({"arm.m.all", "actuator", {"servo", "torque", "slide"}, {}});
  EXPECT_TRUE(write(*arm, std::array<double, 3>{0.5, -2, 0.25}));
  world->advance_to(at(0s));
  EXPECT_EQ(server.joint("/arm/servo"), 0.5);
  EXPECT_EQ(server.joint("/arm/torque"), -2);
  EXPECT_EQ(server.joint("/arm/slide"), 0.25);
  EXPECT_THAT(server.calls(), ::testing::IsSupersetOf({"sim.setJointTargetPosition",
                                                       "sim.setJointTargetForce", "sim.setJointPosition"}));
}

TEST_F(InAScene, PicturesBeginAtTheTop) {
  using Colours = std::array<std::uint8_t, 36>;
  using Depths = std::array<float, 12>;
  const auto camera = receptor<Colours>({"robot.s.c", "camera", {"/camera"}, {{"width", 4}, {"height", 3}}});
  const auto depth = receptor<Depths>({"robot.s.d", "depth", {"/camera"}, {}});
  world->advance_to(at(0s));
  const Colours picture = read<Colours>(*camera);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 12; ++column)
      EXPECT_EQ(picture.at(12 * row + column), 12 * (2 - row) + column);
  EXPECT_THAT(read<Depths>(*depth), ElementsAre(4, 4.5, 5, 5.5, 2, 2.5, 3, 3.5, 0, 0.5, 1, 1.5));
}

TEST_F(InAScene, NoiseComesFromTheSeedAndThePath) {
  const auto values = [this](const char* path, std::uint64_t seed) {
    std::string error;
    const auto other = open_world({.seed = seed, .server = server.address()}, error);
    const auto eye = other->receptor(
        request_for<double>({path, "reflectance", {"/robot/eye_left"}, {{"noise", 0.1}}}), error);
    other->advance_to(at(0s));
    std::vector<double> read_values;
    for (int i = 0; i < 5; ++i) read_values.push_back(read<double>(*eye));
    EXPECT_TRUE(other->finish(error)) << error;
    return read_values;
  };
  world.reset();
  EXPECT_EQ(values("robot.s.a", 1), values("robot.s.a", 1));
  EXPECT_NE(values("robot.s.a", 1), values("robot.s.a", 2));
  EXPECT_NE(values("robot.s.a", 1), values("robot.s.b", 1));
}

TEST_F(InAScene, OwnDevicesSeeTheScene) {
  const auto state = world->state("robot");
  world->advance_to(at(0s));
  EXPECT_EQ(state->body("/robot").position_m[1], 2);
  EXPECT_DOUBLE_EQ(state->site("/goal").quaternion[0], std::cos(0.25));
  EXPECT_THAT(state->sensor("wrist"), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_TRUE(state->touch("/robot", "/goal"));
  state->command("wheel_left", 5);
  world->advance_to(at(10ms));
  EXPECT_THAT(state->joint_velocity("wheel_left"), ElementsAre(5));
  EXPECT_THAT(state->joint_position("wheel_left"), ElementsAre(0.05));
  EXPECT_THROW(static_cast<void>(state->body("nowhere")), WorldError);
  EXPECT_THROW(state->command("/arm/free", 1), WorldError);
  EXPECT_THROW(state->push("/robot", {1, 0, 0}), WorldError);
}

}  // namespace
}  // namespace tessera::testing
