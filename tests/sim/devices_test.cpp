// Receptors of general worlds: their values, and the buffers they fit.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "small_worlds.hpp"
#include "tessera/fields.hpp"
#include "tessera/large_array.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {

struct Flat {
  float heading = 0;  // in an order, and with a padding, of its own
  double x = 0, y = 0;
  TESSERA_FIELDS(Flat, heading, x, y)
};

namespace {

TEST(Devices, JointsAndSensorsAgree) {
  const auto world = open_text("joints", workshop);
  const auto drive =
      effector<std::array<double, 2>>(*world, {"a.m.c", "actuator", {"shoulder", "wrist"}, {}});
  EXPECT_TRUE(write_as(*drive, std::array{0.5, 0.05}));
  world->advance_to(Time(2s));
  const auto both =
      receptor<std::array<double, 2>>(*world, {"a.s.p", "joint_position", {"shoulder", "wrist"}, {}});
  const auto position = read_as<std::array<double, 2>>(*both);
  EXPECT_NEAR(position[0], 0.5, 0.01);
  EXPECT_NEAR(position[1], 0.05, 0.005);
  const auto speed = receptor<float>(*world, {"a.s.v", "joint_velocity", {"shoulder"}, {}});
  EXPECT_NEAR(read_as<float>(*speed), 0, 0.05);
  const auto sensor = receptor<double>(*world, {"a.s.s", "sensor", {"shoulder"}, {}});
  EXPECT_EQ(read_as<double>(*sensor), position[0]);
}

TEST(Devices, BallAndFreeJointsHaveSoManyNumbers) {
  const auto world = open_text("ball", workshop);
  const auto ball = receptor<std::array<double, 4>>(*world, {"a.s.b", "joint_position", {"swing"}, {}});
  EXPECT_EQ((read_as<std::array<double, 4>>(*ball)), (std::array<double, 4>{1, 0, 0, 0}));
  const auto free = receptor<std::array<double, 7>>(*world, {"a.s.f", "joint_position", {"box"}, {}});
  EXPECT_EQ((read_as<std::array<double, 7>>(*free)), (std::array<double, 7>{1, 0, 0.1, 1, 0, 0, 0}));
  const auto speeds =
      receptor<std::array<double, 9>>(*world, {"a.s.v", "joint_velocity", {"swing", "box"}, {}});
  EXPECT_EQ((read_as<std::array<double, 9>>(*speeds)), (std::array<double, 9>{}));
}

TEST(Devices, SensorsOfAListStandOneAfterTheOther) {
  const auto world = open_text("list", workshop);
  const auto all =
      receptor<std::array<float, 8>>(*world, {"a.s.all", "sensor", {"shoulder", "acceleration", "turn"}, {}});
  const auto numbers = read_as<std::array<float, 8>>(*all);
  EXPECT_EQ(numbers[0], 0);
  EXPECT_NEAR(numbers[3], 9.81, 1e-3) << "the accelerometer at rest feels gravity";
  EXPECT_EQ(numbers[4], 1);
}

TEST(Devices, ALargeArrayIsFilledToo) {
  using Many = LargeArray<float, 3>;
  const auto world = open_text("large", workshop);
  const auto device = receptor<Many>(*world, {"a.s.g", "sensor", {"acceleration"}, {}});
  Many value;
  ASSERT_TRUE(device->read({reinterpret_cast<std::byte*>(&value), sizeof value}));
  EXPECT_NEAR(value[2], 9.81, 1e-3);
}

TEST(Devices, APoseFillsSevenNumbersOrTheFieldsOfAStructure) {
  const auto world = open_text("pose", workshop);
  const auto drive = effector<double>(*world, {"a.m.c", "actuator", {"shoulder"}, {}});
  EXPECT_TRUE(write_as(*drive, 1.0));
  world->advance_to(Time(3s));
  const auto flat = read_as<Flat>(*receptor<Flat>(*world, {"a.s.f", "pose", {"hand"}, {}}));
  EXPECT_NEAR(flat.heading, 1, 0.01);
  EXPECT_NEAR(flat.x, 0.3 * std::cos(flat.heading), 1e-2);
  EXPECT_NEAR(flat.y, 0.3 * std::sin(flat.heading), 1e-2);
  using Seven = std::array<double, 7>;
  const auto seven = read_as<Seven>(*receptor<Seven>(*world, {"a.s.p", "pose", {"tip"}, {}}));
  EXPECT_NEAR(2 * std::atan2(seven[6], seven[3]), flat.heading, 1e-6);
  EXPECT_NEAR(seven[2], 0.5, 1e-3);
}

TEST(Devices, AContactIsWithWhatIsNamed) {
  const auto world = open_text("contact", workshop);
  const auto touch = [&](const std::string& name, std::map<std::string, WorldOption> options) {
    return read_as<bool>(*receptor<bool>(*world, {"a.s." + name, "contact", {name}, std::move(options)}));
  };
  world->advance_to(Time(100ms));
  EXPECT_TRUE(touch("box", {}));
  EXPECT_TRUE(touch("box", {{"with", "floor"}}));
  EXPECT_FALSE(touch("box", {{"with", std::vector<WorldValue>{"arm", "gate"}}}));
  EXPECT_FALSE(touch("arm", {}));
  EXPECT_FALSE(touch("tip", {}));
}

TEST(Devices, ASiteFeelsContactsWithinItsVolume) {
  const auto world = open_text("touch", workshop);
  const auto put = effector<std::array<double, 7>>(*world, {"a.m.p", "place", {"box"}, {}});
  const auto inside = receptor<bool>(*world, {"a.s.t", "contact", {"tip"}, {{"with", "box"}}});
  EXPECT_TRUE(write_as(*put, std::array<double, 7>{0.475, 0, 0.5, 1, 0, 0, 0}));  // 5 mm into the palm
  world->advance_to(Time(2ms));
  EXPECT_FALSE(read_as<bool>(*inside)) << "the corners of the palm are outside of the sphere";
  EXPECT_TRUE(read_as<bool>(*receptor<bool>(*world, {"a.s.h", "contact", {"hand"}, {{"with", "box"}}})));
}

TEST(Devices, NoiseIsThatOfTheModelUnlessAnOptionSaysOtherwise) {
  const auto readings = [](std::map<std::string, WorldOption> options, std::uint64_t seed) {
    const auto world = open_text("noise", workshop, seed);
    const auto device =
        receptor<std::array<double, 3>>(*world, {"a.s.g", "sensor", {"gyro"}, std::move(options)});
    std::vector<double> values;
    for (int i = 0; i < 500; ++i) values.push_back(read_as<std::array<double, 3>>(*device)[0]);
    return values;
  };
  const auto deviation = [](const std::vector<double>& values) {
    double squares = 0;
    for (const double value : values) squares += value * value / static_cast<double>(values.size());
    return std::sqrt(squares);
  };
  const auto of_model = readings({}, 1);
  EXPECT_NEAR(deviation(of_model), 0.1, 0.015);
  EXPECT_EQ(of_model, readings({}, 1));
  EXPECT_NE(of_model, readings({}, 2));
  EXPECT_EQ(deviation(readings({{"noise", 0}}, 1)), 0);
  EXPECT_NEAR(deviation(readings({{"noise", 0.5}}, 1)), 0.5, 0.07);
  const auto cut = readings({{"noise", 100}}, 1);
  EXPECT_LE(*std::max_element(cut.begin(), cut.end()), 3) << "the model's cutoff";
}

/// Reads every receptor, at every instant or never; returns the bits of the state at the end.
std::vector<std::uint64_t> end_of_run(bool reading, std::uint64_t seed) {
  const auto world = open_text("disturb", workshop, seed);
  const auto drive =
      effector<std::array<double, 2>>(*world, {"a.m.c", "actuator", {"shoulder", "wrist"}, {}});
  const auto put = effector<std::array<double, 7>>(*world, {"a.m.p", "place", {"box"}, {}});
  const auto sensors = receptor<std::array<double, 10>>(
      *world, {"a.s.a", "sensor", {"acceleration", "gyro", "turn"}, {{"noise", 0.1}}});
  const auto rays = receptor<std::array<double, 16>>(*world, {"a.s.r", "scan", {"tip"}, {}});
  const auto touch = receptor<bool>(*world, {"a.s.c", "contact", {"box"}, {}});
  const auto pose = receptor<std::array<double, 7>>(*world, {"a.s.p", "pose", {"lamp"}, {}});
  const double sway = 0.01 * static_cast<double>(seed);
  EXPECT_TRUE(write_as(*put, std::array<double, 7>{1, 0, 0.4, 0.9, 0.3, 0.1 + sway, 0}));
  for (int step = 0; step < 200; ++step) {
    EXPECT_TRUE(write_as(*drive, std::array{std::sin(step * 0.1), 0.05 + 0.04 * std::cos(step * 0.3)}));
    world->advance_to(Time(step * 5ms));
    if (!reading) continue;
    static_cast<void>(read_as<std::array<double, 10>>(*sensors));
    static_cast<void>(read_as<std::array<double, 16>>(*rays));
    static_cast<void>(read_as<bool>(*touch));
    static_cast<void>(read_as<std::array<double, 7>>(*pose));
  }
  using All = std::array<double, 13>;
  const auto all = read_as<All>(
      *receptor<All>(*world, {"a.s.j", "joint_position", {"shoulder", "wrist", "box", "swing"}, {}}));
  std::vector<std::uint64_t> bits;
  for (const double number : all) bits.push_back(std::bit_cast<std::uint64_t>(number));
  return bits;
}

TEST(Devices, ReadingDoesNotDisturbASingleBitOfBallsAndFreeJoints) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) EXPECT_EQ(end_of_run(true, seed), end_of_run(false, seed));
}

TEST(Devices, AReadingDoesNotDependOnWhatWasReadOrCommandedBeforeAtTheInstant) {
  const auto reading = [](bool others_first) {
    const auto world = open_text("order", workshop);
    const auto drive = effector<double>(*world, {"a.m.c", "actuator", {"shoulder"}, {}});
    const auto pose = receptor<std::array<double, 7>>(*world, {"a.s.p", "pose", {"lamp"}, {}});
    const auto sensor = receptor<std::array<double, 3>>(*world, {"a.s.a", "sensor", {"acceleration"}, {}});
    EXPECT_TRUE(write_as(*drive, 1.0));
    world->advance_to(Time(300ms));
    if (others_first) {
      static_cast<void>(read_as<std::array<double, 7>>(*pose));
      EXPECT_TRUE(write_as(*drive, -1.0));
    }
    return read_as<std::array<double, 3>>(*sensor);
  };
  EXPECT_EQ(reading(true), reading(false));
}

TEST(Devices, NamesAreLookedUpInTheAgentsOwnModelFirst) {
  const auto world = open_text("names", R"(<mujoco><worldbody>
    <body name="robot[1]/base" pos="1 0 0"><geom size="0.1"/></body>
    <body name="robot[2]/base" pos="2 0 0"><geom size="0.1"/></body>
    <body name="base" pos="9 0 0"><geom size="0.1"/></body></worldbody></mujoco>)");
  const auto x_of = [&](const std::string& agent, const std::string& name) {
    using Seven = std::array<double, 7>;
    return read_as<Seven>(*receptor<Seven>(*world, {agent + ".s.p", "pose", {name}, {}}))[0];
  };
  EXPECT_EQ(x_of("robot[1]", "base"), 1);
  EXPECT_EQ(x_of("robot[2]", "base"), 2);
  EXPECT_EQ(x_of("robot[3]", "base"), 9);
  EXPECT_EQ(x_of("robot[1]", "/base"), 9);
  EXPECT_EQ(x_of("robot[1]", "robot[2]/base"), 2);
}

}  // namespace
}  // namespace tessera::testing
