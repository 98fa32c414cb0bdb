// Effectors of general worlds.

#include <gtest/gtest.h>

#include <cmath>

#include "small_worlds.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using Seven = std::array<double, 7>;

Seven pose_of(World& world, const std::string& name) {
  return read_as<Seven>(*receptor<Seven>(world, {"a.look." + name, "pose", {name}, {}}));
}

/// The refusal of a command; empty: it is accepted.
template <class T>
std::string refusal(RealEffector& device, const T& value) {
  try {
    return write_as(device, value) ? "" : "without a reason";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(Actuators, RefuseWhatIsBeyondTheirRangeOrClampIt) {
  const auto world = open_text("range", workshop);
  const auto strict = effector<double>(*world, {"a.m.c", "actuator", {"shoulder"}, {}});
  EXPECT_TRUE(write_as(*strict, 1.5));
  EXPECT_EQ(refusal(*strict, 1.6), "a.m.c: actuator 'shoulder' takes -1.5 to 1.5, not 1.6");
  EXPECT_FALSE(write_as(*strict, std::nan("")));
  const auto single = effector<float>(*world, {"a.m.d", "velocity", {"wrist"}, {}});
  EXPECT_TRUE(write_as(*single, 0.1F)) << "the limit, rounded to float32, is a little more";
  EXPECT_EQ(refusal(*single, 0.11F), "a.m.d: actuator 'wrist' takes 0 to 0.1, not 0.11");
  const auto lenient = effector<double>(*world, {"a.m.c", "actuator", {"shoulder"}, {{"outside", "clamp"}}});
  EXPECT_TRUE(write_as(*lenient, 99.0));
  world->advance_to(Time(3s));
  const auto angle = receptor<double>(*world, {"a.s.p", "joint_position", {"shoulder"}, {}});
  EXPECT_NEAR(read_as<double>(*angle), 1.5, 0.02);
}

TEST(Actuators, CommandsAndReadingsAreConvertedToTheDeclaredUnit) {
  const auto world = open_text("units", workshop);
  using Two = std::array<double, 2>;
  DriverRequest command{"a.m.c", "actuator", {"shoulder", "wrist"}, {}};
  command.units = {"deg", "mm"};
  EXPECT_TRUE(write_as(*effector<Two>(*world, std::move(command)), Two{60.0, 50.0}));
  world->advance_to(Time(3s));
  DriverRequest reading{"a.s.p", "joint_position", {"shoulder", "wrist"}, {}};
  const Two bare = read_as<Two>(*receptor<Two>(*world, reading));
  EXPECT_NEAR(bare[0], 1.047, 0.02) << "60 deg in rad";
  EXPECT_NEAR(bare[1], 0.05, 0.005) << "50 mm in m";
  reading.units = {"deg", "cm"};
  const Two declared = read_as<Two>(*receptor<Two>(*world, reading));
  EXPECT_DOUBLE_EQ(declared[0], bare[0] * 180 / std::acos(-1.0));
  EXPECT_DOUBLE_EQ(declared[1], bare[1] * 100);
}

TEST(Actuators, AListIsTakenAsAWholeOrNotAtAll) {
  const auto world = open_text("whole", workshop);
  const auto both = effector<std::array<double, 2>>(*world, {"a.m.c", "actuator", {"shoulder", "wrist"}, {}});
  EXPECT_EQ(refusal(*both, std::array{1.0, 5.0}), "a.m.c: actuator 'wrist' takes 0 to 0.1, not 5");
  world->advance_to(Time(1s));
  const auto angle = receptor<double>(*world, {"a.s.p", "joint_position", {"shoulder"}, {}});
  EXPECT_NEAR(read_as<double>(*angle), 0, 1e-9);
}

TEST(Actuators, HaveOneWriter) {
  const auto world = open_text("writers", workshop);
  const auto problem = [&](DriverRequest request, const auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    const auto found = world->problem_with(request_for<Value>(std::move(request)), true);
    return found ? std::string(found->second_writer ? "second: " : "") + found->text : "";
  };
  using Two = std::array<double, 2>;
  using Pose = std::array<double, 7>;
  using Colour = std::array<double, 4>;
  EXPECT_EQ(problem({"robot[0].m.a", "actuator", {"shoulder"}, {}}, 0.0), "");
  EXPECT_EQ(problem({"robot[0].m.a", "actuator", {"shoulder"}, {}}, 0.0), "") << "it asks again";
  EXPECT_EQ(problem({"robot[1].m.a", "velocity", {"/shoulder"}, {}}, 0.0),
            "second: actuator '/shoulder' is driven by robot[0].m.a and by robot[1].m.a");
  EXPECT_EQ(problem({"arm.m.both", "actuator", {"wrist", "shoulder"}, {}}, Two{}),
            "second: actuator 'shoulder' is driven by robot[0].m.a and by arm.m.both");
  EXPECT_EQ(problem({"arm.m.twice", "actuator", {"wrist", "wrist"}, {}}, Two{}),
            "second: actuator 'wrist' stands twice in the list of arm.m.twice");
  EXPECT_EQ(problem({"arm.m.wrist", "actuator", {"wrist"}, {}}, 0.0), "") << "a refused device has none";
  EXPECT_EQ(problem({"a.m.grip", "weld", {"grip"}, {}}, false), "");
  EXPECT_EQ(problem({"b.m.grip", "weld", {"grip"}, {}}, false),
            "second: equality 'grip' is driven by a.m.grip and by b.m.grip");
  EXPECT_EQ(problem({"a.m.box", "place", {"box"}, {}}, Pose{}), "");
  EXPECT_EQ(problem({"b.m.box", "place", {"box"}, {}}, Pose{}),
            "second: body 'box' is driven by a.m.box and by b.m.box");
  EXPECT_EQ(problem({"a.m.gate", "mocap", {"gate"}, {}}, Pose{}), "");
  EXPECT_EQ(problem({"b.m.gate", "mocap", {"gate"}, {}}, Pose{}),
            "second: body 'gate' is driven by a.m.gate and by b.m.gate");
  EXPECT_EQ(problem({"a.m.lamp", "colour", {"bulb"}, {}}, Colour{}), "");
  EXPECT_EQ(problem({"b.m.lamp", "colour", {"bulb"}, {}}, Colour{}),
            "second: geom 'bulb' is driven by a.m.lamp and by b.m.lamp");
  std::string error;
  EXPECT_EQ(world->effector(request_for<double>({"b.m.a", "actuator", {"shoulder"}, {}}), error), nullptr);
  EXPECT_EQ(
      error,
      "b.m.a: actuator 'shoulder' is driven by robot[0].m.a and by b.m.a; let one subsystem command it, "
      "and send it what the others wish");
}

TEST(Actuators, AWeldTakesThePoseOfTheMoment) {
  const auto world = open_text("weld", workshop);
  const auto put = effector<Seven>(*world, {"a.m.p", "place", {"box"}, {}});
  const auto grip = effector<bool>(*world, {"a.m.g", "weld", {"grip"}, {}});
  const auto drive = effector<double>(*world, {"a.m.c", "actuator", {"shoulder"}, {}});
  EXPECT_TRUE(write_as(*put, Seven{0.5, 0.05, 0.5, std::cos(0.4), 0, 0, std::sin(0.4)}));
  world->advance_to(Time(2ms));
  EXPECT_TRUE(write_as(*grip, true));
  EXPECT_TRUE(write_as(*drive, 0.5));
  world->advance_to(Time(3s));
  const Seven box = pose_of(*world, "box");
  EXPECT_NEAR(box[2], 0.5, 0.02) << "it did not fall";
  const double angle =
      read_as<double>(*receptor<double>(*world, {"a.s.p", "joint_position", {"shoulder"}, {}}));
  EXPECT_GT(angle, 0.3);
  EXPECT_NEAR(box[0], 0.5 * std::cos(angle) - 0.05 * std::sin(angle), 0.02);
  EXPECT_NEAR(box[1], 0.5 * std::sin(angle) + 0.05 * std::cos(angle), 0.02);
  EXPECT_NEAR(2 * std::atan2(box[6], box[3]), 0.8 + angle, 0.05);
  EXPECT_TRUE(write_as(*grip, false));
  world->advance_to(Time(5s));
  EXPECT_NEAR(pose_of(*world, "box")[2], 0.1, 0.01);
}

TEST(Actuators, ObstaclesMoveAndThingsAreBroughtBack) {
  const auto world = open_text("mocap", workshop);
  const auto gate = effector<Seven>(*world, {"a.m.g", "mocap", {"gate"}, {}});
  EXPECT_TRUE(write_as(*gate, Seven{0, 3, 1, 2, 0, 0, 0})) << "the quaternion is normalised";
  EXPECT_TRUE(write_as(*gate, Seven{})) << "seven zeros leave it where it is";
  EXPECT_FALSE(write_as(*gate, Seven{1, 1, 1, 0, 0, 0, 0})) << "no direction";
  EXPECT_EQ(pose_of(*world, "gate")[1], 2) << "a reading is that of the instant";
  world->advance_to(Time(2ms));
  EXPECT_EQ(pose_of(*world, "gate")[1], 3);
  const auto box = effector<Seven>(*world, {"a.m.b", "place", {"box"}, {}});
  EXPECT_TRUE(write_as(*box, Seven{-1, -1, 0.1, 1, 0, 0, 0}));
  world->advance_to(Time(500ms));
  EXPECT_NEAR(pose_of(*world, "box")[0], -1, 0.01);
}

TEST(Actuators, ColoursAreFromZeroToOne) {
  const auto world = open_text("colour", workshop);
  const auto lamp = effector<std::array<float, 4>>(*world, {"a.m.l", "colour", {"bulb"}, {}});
  EXPECT_TRUE(write_as(*lamp, std::array{1.0F, 0.5F, 0.0F, 1.0F}));
  EXPECT_FALSE(write_as(*lamp, std::array{1.0F, 1.5F, 0.0F, 1.0F}));
}

TEST(Actuators, ABeltGoesBackByItsWrapAndCarriesOn) {
  const auto world = open_text("belt", R"(<mujoco>
    <worldbody>
      <body name="belt" pos="0 0 0.1"><joint name="infeed" type="slide" axis="1 0 0" armature="50"/>
        <geom type="box" size="1 0.2 0.05" mass="10"/></body>
      <body name="box" pos="-0.5 0 0.2"><freejoint/><geom type="box" size="0.05 0.05 0.05" mass="0.1"/></body>
    </worldbody>
    <actuator><velocity name="belt" joint="infeed" kv="2000"/></actuator></mujoco>)");
  std::string error;
  const auto with_wrap = [&](double wrap) {
    return world->effector(request_for<double>({"a.b.c", "actuator", {"belt"}, {{"wrap", wrap}}}), error);
  };
  EXPECT_EQ(with_wrap(0), nullptr);
  EXPECT_NE(error.find("option 'wrap' must be more than 0"), std::string::npos) << error;
  const auto belt = with_wrap(0.1);
  const auto at = receptor<double>(*world, {"a.d.e", "joint_position", {"infeed"}, {}});
  EXPECT_TRUE(write_as(*belt, 0.2));
  world->advance_to(Time(1s));
  const double before = pose_of(*world, "box")[0];
  world->advance_to(Time(4s));
  EXPECT_NEAR(pose_of(*world, "box")[0] - before, 0.6, 0.005);
  EXPECT_LE(std::abs(read_as<double>(*at)), 0.1);
}

}  // namespace
}  // namespace tessera::testing
