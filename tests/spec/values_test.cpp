#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

std::string with_parameters(const std::string& parameters) {
  return "tessera: 1\nsystem: demo\ntypes: { Pose: { x: float64, y: float64 }, Path: { poses: \"Pose[2]\" } "
         "}\n"
         "parameters: { " +
         parameters +
         " }\n"
         "agents: { robot: { control: { rate: 1 Hz, behaviours: { run: {} } } } }\n";
}

struct Value {
  std::string written, literal;
};

class Parameters : public testing::TestWithParam<Value> {};

TEST_P(Parameters, BecomeLiteralsOfCpp) {
  const Reading reading(with_parameters("p: " + GetParam().written));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(reading.model->parameters[0].initial, GetParam().literal);
}

INSTANTIATE_TEST_SUITE_P(
    Values, Parameters,
    testing::Values(
        Value{"2", "2.0"}, Value{"0.2 m/s", "0.2"}, Value{"-1.5", "-1.5"}, Value{"1e-7 m", "1e-07"},
        Value{"+3", "3.0"}, Value{".5", "0.5"}, Value{"1e22", "1e+22"}, Value{"true", "true"},
        Value{"'it''s'", "\"it's\""}, Value{R"("tab\there")", "\"tab\\011here\""},
        Value{R"("say \"hi\" \\")", R"("say \"hi\" \\")"}, Value{"\"0.2 m/s\"", "\"0.2 m/s\""},
        Value{"{ type: int32, default: 007 }", "7"}, Value{"{ type: int8, default: -128 }", "-128"},
        Value{"{ type: int64, default: -9223372036854775808 }", "-9223372036854775807 - 1"},
        Value{"{ type: uint64, default: 18446744073709551615 }", "18446744073709551615U"},
        Value{"{ type: float32, default: 0.1 }", "0.1F"}, Value{"{ type: float32, default: 3 }", "3.0F"},
        Value{"{ type: string<=3, default: abc }", "\"abc\""},
        Value{"{ type: float64 m, default: 3 m, min: 1, max: 4 m }", "3.0"}));

TEST(Parameters, KnowTypeAndRange) {
  const Reading reading(with_parameters("p: { type: int32, default: 3, min: -1, max: 9, unit: m }"));
  ASSERT_TRUE(reading.model) << reading.report();
  const Parameter& parameter = reading.model->parameters[0];
  EXPECT_EQ(parameter.type.scalar, Scalar::int32);
  EXPECT_EQ(parameter.type.unit, "m");
  EXPECT_EQ(parameter.minimum, -1.0);
  EXPECT_EQ(parameter.maximum, 9.0);
}

TEST(Subsystems, ReceiveLastUnlessTheySayFirst) {
  const Reading reading(golden("valid/convoy.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& subsystems = reading.model->definitions[0].subsystems;
  EXPECT_TRUE(subsystems[0].receive_first);
  EXPECT_FALSE(subsystems[1].receive_first);
}

TEST(Memory, StructuresAndArraysBecomeInitialisers) {
  const Reading reading(golden("valid/convoy.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& memory = reading.model->definitions[0].subsystems[0].memory;
  ASSERT_EQ(memory.size(), 6U);
  EXPECT_EQ(memory[0].initial, "1.5");
  EXPECT_EQ(memory[1].initial, "");
  EXPECT_EQ(memory[2].initial, ".x = 1.0, .y{}, .heading = 90.0F");
  EXPECT_EQ(memory[3].initial, "{{.x = 1.0, .y{}, .heading{}}, {.x{}, .y{}, .heading{}}}");
  EXPECT_EQ(memory[4].initial, "{1.0, -2.5, 1e-07}");
  EXPECT_EQ(memory[5].initial, "\"none\"");
}

TEST(Types, ComeInAnOrderInWhichEachUsesOnlyEarlierOnes) {
  const Reading reading(golden("valid/convoy.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const auto& structures = reading.model->structures;
  ASSERT_EQ(structures.size(), 3U);
  for (const StructureId i : structures.ids()) {
    for (const Field& field : structures[i].fields) {
      if (field.type.kind == Type::Kind::structure) {
        EXPECT_LT(field.type.structure, i);
      }
    }
  }
  const auto scan = std::find_if(structures.begin(), structures.end(),
                                 [](const Structure& one) { return one.name == "Scan"; });
  ASSERT_NE(scan, structures.end());
  EXPECT_EQ(scan->fields[0].type.extent, 8U);
  EXPECT_EQ(scan->fields[0].type.unit, "m");
  EXPECT_EQ(structures[scan->fields[1].type.structure].name, "Pose");
  EXPECT_EQ(scan->fields[2].type.capacity, 16U);
}

struct Time {
  std::string written;
  std::chrono::nanoseconds meant;
};

class Durations : public testing::TestWithParam<Time> {};

TEST_P(Durations, AreReadWithTheirUnit) {
  const Reading reading(
      "tessera: 1\nsystem: demo\nagents: { robot: { control: { behaviours: { run: { takes: " +
      GetParam().written + " } } } } }\n");
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(reading.model->subsystem({0}).behaviours[0].takes, (Takes{GetParam().meant, GetParam().meant}));
}

INSTANTIATE_TEST_SUITE_P(
    Units, Durations,
    testing::Values(Time{"200 ms", std::chrono::milliseconds(200)}, Time{"3s", std::chrono::seconds(3)},
                    Time{"50 us", std::chrono::microseconds(50)}, Time{"1 min", std::chrono::minutes(1)},
                    Time{"0.5 h", std::chrono::minutes(30)}, Time{"7 ns", std::chrono::nanoseconds(7)},
                    Time{"1.5 \u00b5s", std::chrono::nanoseconds(1500)}));

struct Range {
  std::string written;
  std::chrono::nanoseconds shortest, longest;
};

class TimeRanges : public testing::TestWithParam<Range> {};

TEST_P(TimeRanges, HaveOneUnitOrTwo) {
  const Reading reading(
      "tessera: 1\nsystem: demo\nagents: { robot: { control: { rate: 1 Hz, behaviours: { run: { takes: " +
      GetParam().written + " } } } } }\n");
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(reading.model->subsystem({0}).behaviours[0].takes,
            (Takes{GetParam().shortest, GetParam().longest}));
}

INSTANTIATE_TEST_SUITE_P(
    Forms, TimeRanges,
    testing::Values(Range{"1..3 ms", std::chrono::milliseconds(1), std::chrono::milliseconds(3)},
                    Range{"0.5..1.5ms", std::chrono::microseconds(500), std::chrono::microseconds(1500)},
                    Range{"500 us .. 2 ms", std::chrono::microseconds(500), std::chrono::milliseconds(2)},
                    Range{"0..7 ns", std::chrono::nanoseconds(0), std::chrono::nanoseconds(7)},
                    Range{"2..2 s", std::chrono::seconds(2), std::chrono::seconds(2)}));

}  // namespace
}  // namespace tessera::spec
