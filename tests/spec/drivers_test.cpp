// Options, paths and limits of drivers as the model has them.

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

std::string with_drivers(const std::string& real, const std::string& simulated = "") {
  return "tessera: 1\nsystem: demo\n"
         "templates: { cart: { control: { rate: 1 Hz, outputs: { x: float64 }, behaviours: { run: {} } },\n"
         "  effectors: { motor: { rate: 1 Hz, inputs: { x: float64 }, real: { left: float32, right: float32 "
         "},\n"
         "    behaviours: { drive: {} } } } } }\n"
         "agents: { cart: { use: cart, count: 3 } }\n"
         "channels: [ \"cart[i].control.x -> cart[i].motor.x\" ]\n"
         "drivers: { " +
         real + " }\n" + (simulated.empty() ? "" : "simulation: { drivers: { " + simulated + " } }\n");
}

struct Option {
  std::string written;
  DriverOption meant;
};

class DriverOptions : public testing::TestWithParam<Option> {};

TEST_P(DriverOptions, AreNumbersTextsAndBooleans) {
  const Reading reading(
      with_drivers("\"cart[1].motor.left\": { cpp: Motor, option: " + GetParam().written + " }"));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(reading.model->drivers.at(0).options.at("option"), GetParam().meant);
}

INSTANTIATE_TEST_SUITE_P(Values, DriverOptions,
                         testing::Values(Option{"4", {4.0, ""}}, Option{"-0.5", {-0.5, ""}},
                                         Option{"33 mm", {33.0, "mm"}}, Option{"33mm", {33.0, "mm"}},
                                         Option{"2 V/rad", {2.0, "V/rad"}}, Option{"0x40", {64.0, ""}},
                                         Option{"true", {true, ""}}, Option{"false", {false, ""}},
                                         Option{"yes", {std::string("yes"), ""}},
                                         Option{"/dev/ttyUSB0", {std::string("/dev/ttyUSB0"), ""}},
                                         Option{"192.168.0.1", {std::string("192.168.0.1"), ""}},
                                         Option{"8N1", {std::string("8N1"), ""}},
                                         Option{"3rd floor", {std::string("3rd floor"), ""}},
                                         Option{"'4'", {std::string("4"), ""}},
                                         Option{"0xyz", {std::string("0xyz"), ""}},
                                         Option{"\"bus_{i}\"", {std::string("bus_1"), ""}}));

TEST(Drivers, OfAWholeSubsystemServeAllItsBuffers) {
  const Reading reading(
      with_drivers("\"cart[*].motor\": { cpp: Bus }", "\"cart[0].motor.left\": { cpp: Wheel }"));
  ASSERT_TRUE(reading.model) << reading.report();
  const Model& model = *reading.model;
  ASSERT_EQ(model.drivers.size(), 3U);
  EXPECT_FALSE(model.drivers[1].real.valid());
  EXPECT_EQ(model.driver_path(model.drivers[1]), "cart[1].motor");
  EXPECT_EQ(model.without_driver(model.drivers), std::vector<std::string>());
  EXPECT_EQ(model.driver_path(model.simulation->drivers[0]), "cart[0].motor.left");
  EXPECT_EQ(model.without_driver(model.simulation->drivers),
            (std::vector<std::string>{"cart[0].motor.right", "cart[1].motor.left", "cart[1].motor.right",
                                      "cart[2].motor.left", "cart[2].motor.right"}));
}

TEST(Drivers, OfTheWorldHaveNumbersInMetres) {
  const std::string text = golden("valid/line_follower.yaml");
  const std::string from = "{ reflectance: eye_left }";
  ASSERT_NE(text.find(from), std::string::npos);
  std::string with_option = text;
  with_option.replace(text.find(from), from.size(),
                      "{ reflectance: eye_left, noise: 0.02, footprint: 12 mm }");
  const Reading reading(with_option);
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& options = reading.model->simulation->drivers[0].options;
  EXPECT_EQ(options.at("noise"), (DriverOption{0.02, ""}));
  EXPECT_EQ(options.at("footprint"), (DriverOption{0.012, "m"}));
}

TEST(Limits, AreClampedUnlessAFaultIsAskedFor) {
  const Reading reading(golden("valid/arm.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto joints = std::find_if(reading.model->definitions[0].subsystems.begin(),
                                   reading.model->definitions[0].subsystems.end(),
                                   [](const Subsystem& one) { return !one.limits.empty(); });
  ASSERT_NE(joints, reading.model->definitions[0].subsystems.end());
  const Limit& limit = joints->limits.front();
  EXPECT_EQ(limit.field, "");
  EXPECT_EQ(limit.real.value, 0U);
  EXPECT_TRUE(limit.per_second);
  EXPECT_FALSE(limit.fault);
}

TEST(Layout, IsWrittenAsInRecordings) {
  const Reading reading(
      "tessera: 1\nsystem: demo\n"
      "types: { Flat: { x: float64, ok: bool }, Row: { all: \"Flat[3]\", name: string<=8 } }\n"
      "agents: { a: { control: { rate: 1 Hz, memory: { m: Row, n: \"uint8[6]\" }, behaviours: { run: {} } } "
      "} }\n");
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& memory = reading.model->subsystem({0}).memory;
  EXPECT_EQ(reading.model->layout_of(memory[0].type), "{all: {x: float64, ok: bool}[3], name: string(8)}");
  EXPECT_EQ(reading.model->layout_of(memory[1].type), "uint8[6]");
}

TEST(Panels, HaveTheControlsThatTheSpecificationNames) {
  using Kind = PanelControl::Kind;
  const Reading reading(golden("valid/panels.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const Panel& drive = reading.model->drivers.at(0).panel.value();
  EXPECT_EQ(drive.stale, std::chrono::milliseconds(300));
  ASSERT_EQ(drive.controls.size(), 6U);
  EXPECT_EQ(drive.controls[0].kind, Kind::stick_y);
  EXPECT_EQ(drive.controls[0].field, "forward");
  EXPECT_EQ(drive.controls[0].unit, "m/s");
  EXPECT_EQ(drive.controls[0].minimum, -0.5);
  EXPECT_EQ(drive.controls[0].maximum, 0.5);
  EXPECT_EQ(drive.controls[1].minimum, -1) << "a stick without a range";
  EXPECT_TRUE(drive.controls[3].whole);
  EXPECT_EQ(drive.controls[4].field, "arm.lift");
  EXPECT_EQ(drive.controls[5].kind, Kind::switch_over);
  EXPECT_EQ(reading.model->drivers.at(1).panel.value().controls.at(0).field, "value");
}

TEST(Panels, HaveOneControlForEachNumberAndBoolByDefault) {
  using Kind = PanelControl::Kind;
  const Reading reading(golden("valid/panels.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const Panel& drive = reading.model->simulation->drivers.at(0).panel.value();
  std::string fields;
  for (const PanelControl& one : drive.controls) {
    fields += one.field + " ";
    EXPECT_EQ(one.kind, one.field == "horn" || one.field == "arm.grip" ? Kind::button : Kind::slider);
    const double least = one.is_number() && one.field != "gear" ? -1 : 0;
    EXPECT_EQ(one.minimum, least) << one.field;
  }
  EXPECT_EQ(fields, "forward turn horn gear arm.lift arm.grip ");
  EXPECT_EQ(drive.stale, std::chrono::milliseconds(500));
}

}  // namespace
}  // namespace tessera::spec
