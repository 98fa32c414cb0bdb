// Devices that do not fit: refused when they are made, with what would fit.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "small_worlds.hpp"
#include "tessera/fields.hpp"

namespace tessera::testing {

struct Mixed {
  double a = 0;
  std::int32_t b = 0;
  TESSERA_FIELDS(Mixed, a, b)
};

namespace {

template <class T>
std::string refusal(World& world, DriverRequest request, bool is_effector = false) {
  const auto problem = world.problem_with(request_for<T>(std::move(request)), is_effector);
  return problem ? problem->text + " | " + problem->hint + " | " + problem->subject : "";
}

TEST(RefusedDevices, SayWhatWouldFit) {
  const auto world = open_text("refused", workshop);
  using Two = std::array<double, 2>;
  using Three = std::array<double, 3>;
  using Seven = std::array<double, 7>;
  using TwoSingle = std::array<float, 2>;
  EXPECT_EQ(refusal<TwoSingle>(*world, {"a.s.g", "sensor", {"gyro"}, {}}),
            "sensor 'gyro' gives 3 numbers, and the buffer is float32[2] | make the buffer float64[3] or "
            "float32[3], or a structure of 3 such numbers | ");
  EXPECT_EQ(refusal<Three>(*world, {"a.s.g", "sensor", {"gyr"}, {}}),
            "the world has no sensor 'gyr' | did you mean 'gyro'? the world has: shoulder, acceleration, "
            "gyro, turn, own | gyr");
  EXPECT_EQ(refusal<Two>(*world, {"a.s.o", "sensor", {"own"}, {}}),
            "sensor 'own' is of the type `user`, which gives nothing |  | own");
  EXPECT_EQ(
      refusal<Mixed>(*world, {"a.s.m", "joint_position", {"shoulder", "wrist"}, {}}),
      "these joints give 2 numbers, and the buffer is {a: float64, b: int32} | make the buffer float64[2] "
      "or float32[2], or a structure of 2 such numbers | ");
  EXPECT_EQ(refusal<double>(*world, {"a.s.c", "contact", {"box"}, {}}),
            "a contact is true or false, and the buffer is float64 | make the buffer bool | ");
  EXPECT_EQ(
      refusal<bool>(*world, {"a.s.c", "contact", {"box"}, {{"with", "flor"}}}),
      "the world has no body or geom 'flor' | did you mean 'floor'? the world has: world, arm, hand, box, "
      "lamp, gate, floor, upper, palm, crate, bulb, bar | with");
  EXPECT_EQ(refusal<Three>(*world, {"a.s.p", "pose", {"box"}, {}}),
            "a pose is 7 numbers (x y z, quaternion w x y z), and the buffer is float64[3] | make the buffer "
            "float64[7], or a structure with the fields x, y and heading | ");
  EXPECT_EQ(refusal<Three>(*world, {"a.s.r", "scan", {"tip"}, {{"reach", WorldValue(3, "s")}}}),
            "option 'reach' must be a length, such as 4 m |  | reach");
  EXPECT_EQ(refusal<Three>(*world, {"a.s.r", "scan", {"tip", "tip"}, {}}),
            "'scan' has one target, not a list |  | ");
  EXPECT_EQ(refusal<Three>(*world, {"a.m.m", "actuator", {"shoulder"}, {}}, true),
            "actuator 'shoulder' takes 1 number, and the buffer is float64[3] | make the buffer float64 or "
            "float32 | ");
  EXPECT_EQ(refusal<double>(*world, {"a.m.m", "actuator", {"shoulder"}, {{"outside", "ignore"}}}, true),
            "option 'outside' must be clamp or refuse |  | outside");
  EXPECT_EQ(
      refusal<Seven>(*world, {"a.m.m", "mocap", {"box"}, {}}, true),
      "body 'box' is no mocap body | give it mocap=\"true\" in the model; `place` moves bodies with a free "
      "joint | box");
  EXPECT_EQ(refusal<Seven>(*world, {"a.m.m", "place", {"arm"}, {}}, true),
            "body 'arm' has no free joint, so it cannot be put anywhere | `mocap` moves bodies with "
            "mocap=\"true\" | arm");
  EXPECT_EQ(refusal<Three>(*world, {"a.s.g", "sensor", {"gyro"}, {{"noise", 0.1}}}), "");
}

DriverRequest in_units(DriverRequest request, std::vector<std::string> units) {
  request.units = std::move(units);
  return request;
}

TEST(RefusedDevices, AUnitOfAnotherQuantityIsRefused) {
  const auto world = open_text("units_refused", workshop);
  EXPECT_EQ(
      refusal<double>(*world, in_units({"a.m.c", "actuator", {"shoulder"}, {}}, {"m"}), true),
      "the command of an actuator is in rad, and the buffer in m | declare it in rad, or in another unit of "
      "that quantity | ");
  EXPECT_EQ(
      refusal<double>(*world, in_units({"a.s.p", "joint_position", {"wrist"}, {}}, {"deg"})),
      "the position of a joint is in m, and the buffer in deg | declare it in m, or in another unit of that "
      "quantity | ");
  using Two = std::array<double, 2>;
  EXPECT_EQ(
      refusal<Two>(*world, in_units({"a.s.p", "joint_velocity", {"shoulder", "wrist"}, {}}, {"deg/s", "px"})),
      "the velocity of a joint is in m/s, and '[1]' of the buffer in px | declare it in m/s, or in another "
      "unit of that quantity | ");
  using Three = std::array<double, 3>;
  EXPECT_EQ(
      refusal<Three>(*world, in_units({"a.s.g", "sensor", {"gyro"}, {}}, {"rad/s", "deg/s", "turns"})),
      "a sensor of the world is in rad/s, and '[2]' of the buffer in turns | declare it in rad/s, or in "
      "another unit of that quantity | ");
  EXPECT_NE(refusal<Three>(*world, in_units({"a.s.r", "scan", {"tip"}, {}}, {"s", "s", "s"})), "");
  EXPECT_EQ(refusal<double>(*world, in_units({"a.s.p", "joint_position", {"wrist"}, {}}, {"mm"})), "");
}

TEST(RefusedDevices, ATypeWithoutADescriptionIsRefused) {
  const auto world = open_text("blob", workshop);
  std::string error;
  EXPECT_EQ(world->receptor({"a.s.g", "sensor", {"gyro"}, {}}, error), nullptr);
  EXPECT_EQ(error,
            "a.s.g: a device of the world cannot serve a buffer of this type; its size is not fixed, or its "
            "fields are unknown");
}

}  // namespace
}  // namespace tessera::testing
