// One sink has one writer, as far as a specification tells; and numbers of commands that may be NaN.
#include <cstdlib>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

/// The codes about two carts with these drivers, whose base has the number `command`.
std::string codes_of(const std::string& drivers, const std::string& more = "") {
  return Reading(
             "tessera: 1\nsystem: pair\ntemplates:\n  rover:\n"
             "    control: { rate: 10 Hz, outputs: { v: float64 }, behaviours: { go: {} } }\n"
             "    effectors:\n"
             "      base: { rate: 10 Hz, inputs: { v: float64 }, real: { command: float64 }, stale: 1 s, "
             "behaviours: { drive: {} } }\n"
             "agents: { a: { use: rover, count: 2 }, b: { use: rover } }\n"
             "channels: [ \"a[i].control.v -> a[i].base.v\", b.control.v -> b.base.v ]\n"
             "drivers:\n" +
             drivers + more)
      .codes();
}

TEST(Writers, OfOneTopicAreTold) {
  const std::string to = ": { type: std_msgs/msg/Float64, ros2: ";
  EXPECT_EQ(codes_of("  a[*].base.command" + to + "/v }\n"), "W338");
  EXPECT_EQ(codes_of("  a[*].base.command" + to + "\"/a{i}/v\" }\n"), "");
  EXPECT_EQ(codes_of("  a[0].base.command" + to + "v }\n  b.base.command" + to + "/v }\n"), "W338")
      << "by either name";
  EXPECT_EQ(codes_of("  a[0].base.command" + to + "/v, domain: 3 }\n  b.base.command" + to + "/v }\n"), "");
  EXPECT_EQ(codes_of("  a[0].base.command" + to + "/v, interface: eth0 }\n  b.base.command" + to + "/v }\n"),
            "");
  EXPECT_EQ(codes_of("  a[*].base.command" + to + "/v, interface: eth0 }\n"), "W338");
}

TEST(Writers, OnMachinesOfTheirOwnHaveALoopbackEach) {
  const std::string driver = "  a[*].base.command: { ros2: /v, type: std_msgs/msg/Float64";
  const std::string two =
      "deploy: { processes: { one: { agents: \"a[0]\", host: left }, two: { agents: \"a[1]\", host: right }, "
      "desk: b } }\n";
  EXPECT_EQ(codes_of(driver + " }\n", two), "");
  EXPECT_EQ(codes_of(driver + ", interface: eth0 }\n", two), "W338");
  const std::string one = "deploy: { processes: { \"a[*]\": \"a[*]\", desk: b } }\n";
  EXPECT_EQ(codes_of(driver + " }\n", one), "W338") << "they may share one machine";
}

TEST(Writers, OfOnePortInOneProcessAreTold) {
  const std::string driver = "  a[*].base.command: { cpp: Base, port: /dev/ttyUSB0 }\n";
  EXPECT_EQ(codes_of(driver), "W339");
  EXPECT_EQ(codes_of("  a[*].base.command: { cpp: Base, port: \"/dev/ttyUSB{i}\" }\n"), "");
  EXPECT_EQ(codes_of("  a[*].base.command: { cpp: Base }\n"), "") << "nothing says what they drive";
  EXPECT_EQ(codes_of("  a[0].base.command: { cpp: Base, device: /dev/can0, id: 1 }\n"
                     "  a[1].base.command: { cpp: Base, device: /dev/can0, id: 2 }\n"),
            "")
      << "two devices on one bus";
  EXPECT_EQ(codes_of(driver, "deploy: { processes: { \"a[*]\": \"a[*]\", desk: b } }\n"), "")
      << "each process has a device of that name";
}

/// The codes about an effector whose real buffer is { position: float32[3], yaw: float64, mode: uint8 }.
std::string codes_of_command(const std::string& keys) {
  return Reading(
             "tessera: 1\nsystem: copter\n"
             "types: { Setpoint: { position: \"float32[3]\", yaw: float64, mode: uint8 } }\n"
             "agents:\n  drone:\n"
             "    control: { rate: 10 Hz, outputs: { v: float64 }, behaviours: { go: {} } }\n"
             "    effectors:\n      pilot:\n        inputs: { v: float64 }\n        rate: 10 Hz\n"
             "        real: { setpoint: Setpoint }\n        stale: 1 s\n        behaviours: { fly: {} }\n" +
             keys + "channels: [ drone.control.v -> drone.pilot.v ]\n")
      .codes();
}

TEST(NonFinite, IsAllowedByTheNearestRule) {
  const std::string all = "        safe: { setpoint: { position: [.nan, .NAN, .inf], yaw: -.inf } }\n";
  EXPECT_EQ(codes_of_command(all), "E216 E216 E216 E216");
  EXPECT_EQ(codes_of_command(all + "        non_finite: allowed\n"), "");
  EXPECT_EQ(codes_of_command(all + "        limits: { setpoint: { non_finite: allowed } }\n"), "");
  EXPECT_EQ(codes_of_command(all + "        limits: { setpoint.position: { non_finite: allowed } }\n"),
            "E216");
  EXPECT_EQ(codes_of_command(all + "        non_finite: allowed\n"
                                   "        limits: { setpoint.yaw: { non_finite: fault } }\n"),
            "E216");
  EXPECT_EQ(
      codes_of_command(all + "        limits: { setpoint: { non_finite: fault }, setpoint.position: { "
                             "non_finite: allowed }, setpoint.yaw: { non_finite: allowed, min: -3 } }\n"),
      "");
  EXPECT_EQ(codes_of_command("        safe: { setpoint: { mode: .nan } }\n        non_finite: allowed\n"),
            "E203 W340")
      << "an integer is never NaN";
}

TEST(NonFinite, ThatTheSafeCommandDoesNotMentionIsTold) {
  EXPECT_EQ(codes_of_command("        non_finite: allowed\n"), "W340");
  EXPECT_EQ(codes_of_command("        limits: { setpoint.yaw: { non_finite: allowed } }\n"), "W340");
  EXPECT_EQ(codes_of_command("        non_finite: allowed\n        safe: { setpoint: { yaw: .nan } }\n"),
            "W340");
  EXPECT_EQ(codes_of_command("        limits: { setpoint.yaw: { non_finite: allowed } }\n"
                             "        safe: { setpoint: { yaw: 0 } }\n"),
            "");
}

/// Small inputs from the field (see CONTRIBUTING.md).
class FieldSpecification : public testing::Test {
 protected:
  void SetUp() override {
    const char* const data = std::getenv("TESSERA_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
    folder_ = std::string(data) + "/field/specs/";
  }
  [[nodiscard]] std::string text(const std::string& file) const {
    std::string content = text_of_file(folder_ + file);
    EXPECT_FALSE(content.empty()) << folder_ + file;
    return content;
  }

 private:
  std::string folder_;
};

TEST_F(FieldSpecification, FleetOnOneTopicIsTold) {
  const Reading reading(text("two_writers/spec.yaml"));
  EXPECT_EQ(reading.codes(), "W338") << reading.report();
  EXPECT_TRUE(reading.model);
}

TEST_F(FieldSpecification, CommandsOfPx4MayBeNaNInSafeToo) {
  std::string copter = text("px4_nan/spec.yaml");
  EXPECT_EQ(Reading(copter).codes(), "W340") << "zero is a setpoint";
  const std::string stale = "        stale: 1 s\n";
  ASSERT_NE(copter.find(stale), std::string::npos);
  copter.insert(
      copter.find(stale),
      "        safe: { setpoint: { position: [.nan, .nan, .nan], velocity: [0, 0, 0], yaw: .nan } }\n");
  const Reading reading(copter);
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(reading.report(), "");
  const auto& subsystems = reading.model->definitions.at(0).subsystems;
  const auto pilot = std::ranges::find(subsystems, "pilot", &Subsystem::name);
  ASSERT_NE(pilot, subsystems.end());
  EXPECT_EQ(pilot->safe.at(0),
            ".position{{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN(), "
            "std::numeric_limits<float>::quiet_NaN()}}, .velocity{{0.0F, 0.0F, 0.0F}}, "
            ".yaw = std::numeric_limits<float>::quiet_NaN()");
}

}  // namespace
}  // namespace tessera::spec
