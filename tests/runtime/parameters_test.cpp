#include "parameters/parameters.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "nets.hpp"
#include "test_system.hpp"

namespace tessera::testing {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

/// Three subsystems with the parameters of a Script; what each saw when it was called.
struct Parameters : ::testing::Test {
  TestSystem system;
  std::vector<ScriptState> seen;
  Parameters() {
    Script script;
    script.call = [this](ScriptState& state) { seen.push_back(state); };
    script.decide = [](const ScriptState&) { return Outcome::terminal; };
    for (const char* path : {"robot[0].a", "robot[1].a", "robot[1].b"}) system.add(path, nets::alone, script);
  }
  /// "": accepted, otherwise the complaint.
  std::string set(Values values) {
    RunOptions options;
    options.parameters = std::move(values);
    std::string error;
    seen.clear();
    return execute(system.system(), options, error) ? "" : error;
  }
  [[nodiscard]] std::vector<double> gains() {
    std::vector<double> result;
    for (const ScriptState& state : seen) result.push_back(state.gain);
    std::sort(result.begin(), result.end());
    return result;
  }
};

TEST_F(Parameters, PathsReachEverySubsystemTheyMatch) {
  EXPECT_EQ(set({{"gain", "2"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{2, 2, 2}));
  EXPECT_EQ(set({{"robot[1].a.gain", "2"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{1, 1, 2}));
  EXPECT_EQ(set({{"robot[*].a.gain", "2"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{1, 2, 2}));
}

TEST_F(Parameters, APathMayNameAnAgent) {
  EXPECT_EQ(set({{"robot[1].gain", "2"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{1, 2, 2}));
  EXPECT_EQ(set({{"robot[*].gain", "2"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{2, 2, 2}));
  EXPECT_EQ(set({{"robot[2].gain", "2"}}),
            "unknown parameter 'robot[2].gain'; did you mean 'robot[0].a.gain'?");
}

TEST_F(Parameters, OfArraysAreLists) {
  using Points = std::array<double, 3>;
  EXPECT_EQ(set({{"points", "[0.5, 1e1,7]"}}), "");
  EXPECT_EQ(seen.at(0).points, (Points{0.5, 10, 7}));
  EXPECT_EQ(set({{"points", " 4, 5, 6"}}), "");
  EXPECT_EQ(seen.at(0).points, (Points{4, 5, 6}));
  EXPECT_EQ(set({{"points", "[1, 2]"}}),
            "parameter points = [1, 2]: [1, 2] has 2 elements, and the parameter has 3: write [1, 2, 3]");
  EXPECT_EQ(set({{"points", "[1, 2, x]"}}),
            "parameter points = [1, 2, x]: [1, 2, x] is wrong: element 2 (x) is no number");
  EXPECT_EQ(set({{"points", "[1, -2, 3]"}}),
            "parameter points = [1, -2, 3]: [1, -2, 3] is wrong: element 1 (-2) is out of range 0 to inf");
  EXPECT_NE(set({{"points", ""}}), "");
}

TEST_F(Parameters, AnyUnitOfTheQuantityIsConverted) {
  EXPECT_EQ(set({{"gain", "50 cm/s"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{0.5, 0.5, 0.5}));
  EXPECT_EQ(set({{"gain", "3.6 km/h"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(set({{"gain", "2m/s"}}), "");
  EXPECT_EQ(set({{"points", "[50 cm, 2 m, 3]"}}), "");
  EXPECT_EQ(seen.at(0).points, (std::array<double, 3>{0.5, 2, 3}));
  EXPECT_EQ(set({{"gain", "3 kg"}}),
            "parameter gain = 3 kg: 3 kg has another unit: the parameter is in m/s; write a number in m/s");
  EXPECT_EQ(set({{"gain", "20 m/s"}}), "parameter gain = 20 m/s: 20 m/s is out of range 0 to 10");
  EXPECT_EQ(
      set({{"level", "30 cm"}}),
      "parameter level = 30 cm: 30 cm has a unit, and the parameter has none; write the number alone: 0.3 "
      "if it is in m");
}

TEST_F(Parameters, TheLastOneCounts) {
  EXPECT_EQ(set({{"gain", "2"}, {"gain", "0.5"}}), "");
  EXPECT_EQ(gains(), (std::vector<double>{0.5, 0.5, 0.5}));
}

TEST_F(Parameters, AllKindsAreRead) {
  EXPECT_EQ(set({{"level", "-7"}, {"flag", "true"}, {"label", "red"}, {"gain", "1e-3"}}), "");
  EXPECT_EQ(seen.at(0).level, -7);
  EXPECT_TRUE(seen.at(0).flag);
  EXPECT_EQ(seen.at(0).label, "red");
  EXPECT_EQ(seen.at(0).gain, 1e-3);
}

TEST_F(Parameters, WhatIsWrongIsSaid) {
  EXPECT_EQ(set({{"robot[1].a.gian", "2"}}),
            "unknown parameter 'robot[1].a.gian'; did you mean 'robot[1].a.gain'?");
  EXPECT_EQ(set({{"gain", "fast"}}), "parameter gain = fast: fast is no number");
  EXPECT_EQ(set({{"gain", "11"}}), "parameter gain = 11: 11 is out of range 0 to 10");
  EXPECT_EQ(set({{"gain", "nan"}}), "parameter gain = nan: nan is not finite");
  EXPECT_EQ(set({{"level", "2.5"}}), "parameter level = 2.5: 2.5 is no whole number");
  EXPECT_EQ(set({{"level", "3000000000"}}), "parameter level = 3000000000: 3000000000 does not fit its type");
  EXPECT_EQ(set({{"flag", "maybe"}}), "parameter flag = maybe: maybe is neither true nor false");
  EXPECT_EQ(set({{"label", "far too long"}}),
            "parameter label = far too long: far too long is longer than 8 bytes");
  EXPECT_EQ(set({{"gain", ""}}), "parameter gain = : nothing is no number");
}

TEST_F(Parameters, AllMistakesAreSaidAtOnce) {
  const std::string error = set({{"gain", "fast"}, {"flag", "maybe"}});
  EXPECT_NE(error.find('\n'), std::string::npos) << error;
}

TEST(ParameterFile, HasAPathAndAValueALine) {
  const std::string file = scratch_file("params");
  std::ofstream(file) << "# tuned on Monday\n\n gain = 2  # fast\nrobot.a.label=a = b\n";
  Values values;
  std::string error;
  ASSERT_TRUE(read_parameter_file(file, values, error)) << error;
  EXPECT_EQ(values, (Values{{"gain", "2"}, {"robot.a.label", "a = b"}}));
}

TEST(ParameterFile, NamesTheLineItDoesNotUnderstand) {
  const std::string file = scratch_file("params");
  std::ofstream(file) << "gain = 2\ngain 3\n";
  Values values;
  std::string error;
  EXPECT_FALSE(read_parameter_file(file, values, error));
  EXPECT_EQ(error, file + ":2: expected 'path = value'");
  EXPECT_FALSE(read_parameter_file(file + ".missing", values, error));
}

}  // namespace
}  // namespace tessera::testing
