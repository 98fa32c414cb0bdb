// From a specification to the definitions in the tables of the controller.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "project/files/ros2_messages.hpp"
#include "spec/parser.hpp"

namespace tessera::ros2 {
namespace {

namespace fs = std::filesystem;

const fs::path shipped = fs::path(TESSERA_SOURCE_DIR) / "share/tessera/ros2";

/// The report about a robot with this driver of its base, whose real buffer is { v, omega } of float64.
std::string report_of_folders(const std::string& driver, const std::vector<fs::path>& folders) {
  diagnostics::Diagnostics out("spec.yaml", R"(tessera: 1
system: demo
types: { Motion: { v: float64, omega: float64 } }
agents:
  robot:
    control: { rate: 1 Hz, outputs: { motion: Motion }, behaviours: { wait: {} } }
    effectors:
      base: { rate: 1 Hz, inputs: { motion: Motion }, real: { command: Motion }, stale: 1 s, behaviours: { drive: {} } }
channels: [robot.control.motion -> robot.base.motion]
drivers:
  robot.base.command: { ros2: /cmd_vel, )" + driver +
                                                " }\n");
  auto model = spec::parse(out);
  EXPECT_TRUE(model.has_value()) << render(out);
  if (!model) return "";
  const bool good = project::find_messages_in(*model, folders, out);
  EXPECT_EQ(good, !out.has_errors());
  EXPECT_TRUE(!good || model->drivers.at(0).options.contains("definition"));
  return render(out);
}

std::string report_of(const std::string& driver, const fs::path& own = "/nowhere") {
  return report_of_folders(driver, {own, shipped});
}

TEST(Specification, WithATopicHasTheDefinitionOfItsMessage) {
  EXPECT_EQ(report_of("type: geometry_msgs/Twist, fields: { linear.x: v, angular.z: omega }"), "");
}

void write_text(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

TEST(Specification, UsesTheProjectsDefinitionThenThatOfAnInstallationThenItsOwn) {
  const fs::path scratch = fs::temp_directory_path() / ("tessera-definitions-" + std::to_string(getpid()));
  const fs::path own = scratch / "msg", installed = scratch / "prefix/share", other = scratch / "other/share";
  const std::string driver = "type: pkg/Some, fields: { a: v, b: omega }";
  const auto report = [&] {
    std::string text = report_of_folders(driver, {own, other, installed, shipped});
    for (std::size_t at = 0; (at = text.find((scratch / "").string())) != std::string::npos;)
      text.erase(at, (scratch / "").string().size());
    return text;
  };
  EXPECT_NE(report().find(
                "\nhint: write its definition into msg/pkg/msg/Some.msg beside the specification, or source "
                "a ROS 2 installation that has it; looked in msg, other/share, prefix/share, and "
                "Tessera's own\n"),
            std::string::npos)
      << report();
  for (const fs::path& one : {installed, other})
    write_text(one / "ament_index/resource_index/rosidl_interfaces/pkg", "msg/Some.msg\n");
  write_text(installed / "pkg/msg/Some.msg", "float64 a\nfloat64 b # and a comment\n");
  EXPECT_EQ(report(), "");
  write_text(own / "pkg/msg/Some.msg", "float64 a\n\nfloat64   b 0.5\nint8 C=1\n");
  EXPECT_EQ(report(), "") << "the same bytes";
  write_text(own / "pkg/msg/Some.msg", "float64 a\nfloat64 b\nfloat64 c\n");
  EXPECT_EQ(
      report(),
      R"(spec.yaml:11:47: warning W341: the definition in msg beside the specification is not that of prefix/share/pkg/msg/Some.msg
   11 |   robot.base.command: { ros2: /cmd_vel, type: pkg/Some, fields: { a: v, b: omega } }
      |                                               ^~~~~~~~
hint: nodes of that installation drop or misread the messages: make both equal
1 warning
)");
  write_text(other / "pkg/msg/Some.msg", "float64 a\nfloat64 b\nfloat64 c\n");
  EXPECT_EQ(report(), "") << "the first installation counts, as in ROS 2";
  write_text(other / "geometry_msgs/msg/Twist.msg", "Vector3 linear\n");
  EXPECT_EQ(report_of_folders("type: geometry_msgs/Twist, fields: { linear.x: v, angular.z: omega }",
                              {own, other, shipped}),
            "")
      << "such as one of ROS 1";
  write_text(own / "geometry_msgs/msg/Twist.msg", "float64 a\nfloat64 b\n");
  EXPECT_EQ(report_of_folders("type: geometry_msgs/Twist, fields: { a: v, b: omega }", {own, other, shipped}),
            "");
  fs::remove_all(scratch);
}

TEST(Specification, WithAnUnknownMessageIsRefused) {
  EXPECT_EQ(report_of("type: geometry_msgs/Twits, fields: { linear.x: v, angular.z: omega }"),
            R"(spec.yaml:11:47: error E320: there is no message 'geometry_msgs/Twits'
   11 |   robot.base.command: { ros2: /cmd_vel, type: geometry_msgs/Twits, fields: { linear.x: v, angular.z: omega } }
      |                                               ^~~~~~~~~~~~~~~~~~~
hint: did you mean 'geometry_msgs/Twist'?
1 error
)");
}

TEST(Specification, WithFieldsThatDoNotFitIsRefused) {
  EXPECT_EQ(report_of("type: geometry_msgs/Twist, fields: { linear.xx: v, angular: omega }"),
            R"(spec.yaml:11:78: error E321: 'geometry_msgs/msg/Vector3' has no field 'xx'
   11 |   robot.base.command: { ros2: /cmd_vel, type: geometry_msgs/Twist, fields: { linear.xx: v, angular: omega } }
      |                                                                              ^~~~~~~~~
hint: did you mean 'x'?
spec.yaml:11:92: error E321: the buffer's 'omega' of type float64 does not fit 'angular' of type geometry_msgs/Vector3
   11 |   robot.base.command: { ros2: /cmd_vel, type: geometry_msgs/Twist, fields: { linear.xx: v, angular: omega } }
      |                                                                                            ^~~~~~~
hint: map its fields one by one, or give the buffer a structure
2 errors
)");
}

/// The report about a base whose forward speed is declared in `unit`, behind a message of that type.
std::string report_of_unit(const std::string& unit, const std::string& driver) {
  diagnostics::Diagnostics out("spec.yaml", "tessera: 1\nsystem: demo\ntypes: { Motion: { v: float64 " +
                                                unit +
                                                R"( } }
agents:
  robot:
    control: { rate: 1 Hz, outputs: { motion: Motion }, behaviours: { wait: {} } }
    effectors:
      base: { rate: 1 Hz, inputs: { motion: Motion }, real: { command: Motion }, stale: 1 s, behaviours: { drive: {} } }
channels: [robot.control.motion -> robot.base.motion]
drivers:
  robot.base.command: { ros2: /out, )" + driver +
                                                " }\n");
  auto model = spec::parse(out);
  EXPECT_TRUE(model.has_value()) << render(out);
  if (!model) return "";
  EXPECT_EQ(project::find_messages_in(*model, {"/nowhere", shipped}, out), !out.has_errors());
  return render(out);
}

TEST(Specification, WithPublishersOfAnEffectorIsRefused) {
  EXPECT_EQ(
      report_of("type: geometry_msgs/Twist, fields: { linear.x: v, angular.z: omega }, publishers: one"),
      R"(spec.yaml:11:123: error E321: an effector has no 'publishers'
   11 | ...r.x: v, angular.z: omega }, publishers: one }
      |                                            ^~~
hint: it publishes itself; the controller warns of others (docs/use/ros2.md)
1 error
)");
}

TEST(Specification, WithUnitsThatTheMessagesOfAPackageDoNotHaveIsRefused) {
  const std::string twist = "type: geometry_msgs/Twist, fields: { linear.x: v }";
  EXPECT_EQ(report_of_unit("m/s", twist), "");
  EXPECT_EQ(report_of_unit("furlong/fortnight", twist), "") << "it is not known, and may be right";
  EXPECT_EQ(
      report_of_unit("cm/s", twist),
      R"(spec.yaml:11:43: error E218: messages of geometry_msgs are in SI units, and command.v is declared in cm/s
   11 |   robot.base.command: { ros2: /out, type: geometry_msgs/Twist, fields: { linear.x: v } }
      |                                           ^~~~~~~~~~~~~~~~~~~
hint: declare it in m/s, and convert it in the transition function
1 error
)");
  EXPECT_EQ(report_of_unit("deg", "type: sensor_msgs/NavSatFix, fields: { latitude: v }"), "");
  EXPECT_EQ(report_of_unit("mm", "type: std_msgs/Float64, fields: { data: v }"), "");
}

std::string text_in(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

const fs::path goldens = fs::path(TESSERA_SOURCE_DIR) / "tests/golden/ros2";

/// The messages of the look-up about a specification that is right in itself.
std::string report_of_golden(const fs::path& file, bool expected) {
  diagnostics::Diagnostics out(file.filename().string(), text_in(file));
  auto model = spec::parse(out);
  EXPECT_TRUE(model.has_value()) << render(out);
  if (!model) return "";
  EXPECT_EQ(project::find_messages_in(*model, {goldens / "msg", shipped}, out), expected);
  std::string report = render(out);
  for (std::size_t at = 0; (at = report.find(goldens.string() + "/")) != std::string::npos;)
    report.erase(at, goldens.string().size() + 1);
  return report;
}

/// TESSERA_UPDATE_GOLDEN=1 writes the present messages; read the difference before you keep it.
TEST(Specification, WithWrongMessagesOrServicesIsRefused) {
  const std::string catalogue = text_in(fs::path(TESSERA_SOURCE_DIR) / "docs/reference/diagnostics.md");
  for (const auto& file : fs::directory_iterator(goldens / "wrong")) {
    if (file.path().extension() != ".yaml") continue;
    const std::string report = report_of_golden(file, false);
    const fs::path expected = fs::path(file).replace_extension(".expected");
    if (std::getenv("TESSERA_UPDATE_GOLDEN") != nullptr) std::ofstream(expected) << report;
    EXPECT_EQ(report, text_in(expected));
  }
  for (const std::string code : {"E320", "E321", "E322", "E371"})
    EXPECT_NE(catalogue.find("| " + code + " |"), std::string::npos) << code;
}

TEST(Specification, WithServicesHasTheirDefinitions) {
  for (const auto& file : fs::directory_iterator(goldens / "valid"))
    EXPECT_EQ(report_of_golden(file, true), "");
}

/// The hint names `fields` that are right.
TEST(Specification, OfTheFieldIsRightOnceTheHintIsFollowed) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const fs::path file = fs::path(data) / "field/specs/array_hint.yaml";
  const std::string report = report_of_golden(file, false);
  const std::string before = "hint: say which fields correspond: ", with = "fields: detections";
  const std::size_t hint = report.find(before);
  ASSERT_NE(hint, std::string::npos) << report;
  const std::size_t first = hint + before.size();
  std::string text = text_in(file);
  ASSERT_NE(text.find(with), std::string::npos);
  text.replace(text.find(with), with.size(), report.substr(first, report.find('\n', first) - first));
  const fs::path followed = fs::path(testing::TempDir()) / ("followed_" + std::to_string(getpid()) + ".yaml");
  std::ofstream(followed) << text;
  EXPECT_EQ(report_of_golden(followed, true), "") << text;
  fs::remove(followed);
}

TEST(Specification, SeesTheMistakesOfItsOwnMessages) {
  const fs::path own = fs::path(testing::TempDir()) / ("msg_" + std::to_string(getpid()));
  fs::create_directories(own / "my_robot/msg");
  std::ofstream(own / "my_robot/msg/Drive.msg") << "# of our base\nfloat64 v\nflaot64 omega\n";
  const std::string report = report_of("type: my_robot/msg/Drive", own);
  EXPECT_NE(
      report.find("error E320: " + (own / "my_robot/msg/Drive.msg").string() + ":3: unknown type 'flaot64'"),
      std::string::npos)
      << report;
  EXPECT_NE(report.find("hint: did you mean 'float64'?"), std::string::npos) << report;
  std::ofstream(own / "my_robot/msg/Drive.msg") << "float64 v\nfloat64 omega\n";
  EXPECT_EQ(report_of("type: my_robot/msg/Drive", own), "");
  fs::remove_all(own);
}

}  // namespace
}  // namespace tessera::ros2
