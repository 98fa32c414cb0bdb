// examples/04_arm: only `tessera run` opens its real drivers; drivers get their options.

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

/// One build of the example for all tests; its real drivers leave the file "made" as soon as they are made.
class Drivers : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder() = fs::temp_directory_path() / ("tessera_drivers_" + std::to_string(getpid()));
    fs::remove_all(folder());
    fs::copy(fs::path(TESSERA_SOURCE_DIR) / "examples/04_arm", folder(), fs::copy_options::recursive);
    fs::remove_all(folder() / ".tessera");
    for (const char* start : {"class Motor final : public tessera::Effector<double> {\n",
                              "class JointBus final : public tessera::Effector<arm::joints::Real> {\n",
                              "class EncoderBus final : public tessera::Receptor<arm::encoders::Real> {\n"})
      replace(folder() / "src/drivers.hpp", start,
              std::string(start) + "  std::ofstream made_{\"made\", std::ios::app};\n");
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }
  void SetUp() override {
    for (const std::string& file : device_files) fs::remove(folder() / file);
  }

  static fs::path& folder() {
    static fs::path path;
    return path;
  }
  static project::Exit tessera(const std::string& arguments) {
    return project::capture(
        {"sh", "-c", "cd '" + folder().string() + "' && '" + TESSERA_BINARY_DIR + "/tessera' " + arguments});
  }
  /// The files that drivers have made, "made" among them.
  static std::vector<std::string> touched() {
    std::vector<std::string> found;
    std::ranges::copy_if(device_files, std::back_inserter(found),
                         [](const std::string& file) { return fs::exists(folder() / file); });
    return found;
  }
  static std::vector<std::string> lines_of(const std::string& file) {
    std::istringstream text(content_of(folder() / file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
  static const inline std::vector<std::string> device_files{
      "made", "arm_joints.bus", "cart_0.pwm", "cart_1.pwm", "cart_2.pwm", "arm_encoders.bus"};
};

TEST_F(Drivers, NoSimulatedRunTouchesAReal) {
  // The error of the refused command has no successor, so that run ends early and fails.
  for (const auto& [how, code] :
       {std::pair("simulate --for 1s", 0), std::pair("simulate --for 200ms --interleave", 0),
        std::pair("schedules 3 --for 100ms", 0), std::pair("rerun .tessera/last/recording.tsr", 0),
        std::pair("run --world --for 200ms", 0),
        std::pair("simulate --for 1s --inject device:arm.joints@100ms..300ms", 1)}) {
    const project::Exit done = tessera(how);
    EXPECT_EQ(done.code, code) << how << '\n' << done.text;
    EXPECT_EQ(touched(), std::vector<std::string>()) << how;
  }
}

TEST_F(Drivers, ARealRunTellsEachDriverWhoItIsAndEndsWithTheSafeCommand) {
  write(folder() / "arm_encoders.bus", "0.1 0.2 0.3 0.4 0.5 0.6\n");
  const project::Exit done = tessera("run --for 1s --report page");
  ASSERT_EQ(done.code, 0) << done.text;
  EXPECT_NE(content_of(folder() / "page/index.html").find("arm.encoders"), std::string::npos);
  EXPECT_EQ(touched(), device_files);
  for (const auto& [file, pin, sign] : {std::tuple("cart_0.pwm", "pin 4 duty ", ""),
                                        {"cart_1.pwm", "pin 17 duty ", ""},
                                        {"cart_2.pwm", "pin 27 duty ", "-"}}) {
    const std::vector<std::string> lines = lines_of(file);
    ASSERT_GE(lines.size(), 3U) << file;
    EXPECT_EQ(lines.front(), pin + std::string(sign) + "0") << "the safe command comes first";
    EXPECT_EQ(lines.back(), pin + std::string(sign) + "0") << "and last";
    EXPECT_EQ(std::ranges::count(lines, pin + std::string(sign) + "0.25") > 0, true) << file;
  }
  const std::vector<std::string> telegrams = lines_of("arm_joints.bus");
  EXPECT_GT(std::ranges::count(telegrams, "alive"), 2);
  EXPECT_GT(std::ranges::count(telegrams, "-0.4 -0.4 -0.4 -0.4 -0.4 -0.4 ") +
                std::ranges::count(telegrams, "0.4 0.4 0.4 0.4 0.4 0.4 "),
            0);
}

TEST_F(Drivers, HardwareInTheLoopOpensWhatIsNamedOnly) {
  const project::Exit done = tessera("simulate --for 200ms --hardware 'cart[1].motor'");
  EXPECT_EQ(done.code, 0) << done.text;
  EXPECT_EQ(touched(), (std::vector<std::string>{"made", "cart_1.pwm"}));
  EXPECT_EQ(tessera("schedules 2 --hardware 'cart[1].motor'").code, 2);
}

TEST_F(Drivers, ADeviceThatIsNotThereKeepsTheRunFromStarting) {
  ASSERT_EQ(tessera("simulate --for 100ms").code, 0);
  const auto runs = [] {
    std::set<fs::path> all;
    for (const auto& entry : fs::directory_iterator(folder() / ".tessera/runs")) all.insert(entry.path());
    return all;
  };
  const std::set<fs::path> before = runs();
  const fs::path last = fs::read_symlink(folder() / ".tessera/last");
  const project::Exit done = tessera("run --for 100ms");
  EXPECT_EQ(done.code, 1) << done.text;
  EXPECT_NE(done.text.find("the device of arm.encoders cannot be opened"), std::string::npos) << done.text;
  for (const char* file : {"cart_0.pwm", "cart_1.pwm", "cart_2.pwm"})
    EXPECT_EQ(lines_of(file).size(), 1U) << "opened before: the safe command and nothing else, " << file;
  EXPECT_EQ(fs::read_symlink(folder() / ".tessera/last"), last) << "it still shows what has run";
  EXPECT_EQ(runs(), before);
}

/// In a folder of its own, which is never built.
TEST_F(Drivers, BuffersWithoutADriverAreAllNamedBeforeAnythingIsBuilt) {
  const fs::path bare = folder() / "bare";
  fs::create_directories(bare);
  const std::string text = content_of(folder() / "spec.yaml");
  write(bare / "spec.yaml", text.substr(0, text.find("\nsimulation:")));
  const project::Exit simulated = tessera("simulate bare");
  EXPECT_EQ(simulated.code, 1);
  for (const char* buffer : {"arm.encoders.q1", "arm.encoders.q6", "arm.joints.v3", "cart[2].motor.duty"})
    EXPECT_NE(simulated.text.find(std::string("the real buffer ") + buffer + " has no simulated driver"),
              std::string::npos)
        << simulated.text;
  EXPECT_NE(simulated.text.find("--hardware arm.encoders.q1"), std::string::npos) << simulated.text;
  write(bare / "spec.yaml", text.substr(0, text.find("\ndrivers:")));
  const project::Exit real = tessera("run bare");
  EXPECT_EQ(real.code, 1);
  EXPECT_NE(real.text.find("the real buffer cart[2].motor.duty has no driver"), std::string::npos)
      << real.text;
  EXPECT_FALSE(fs::exists(bare / ".tessera")) << "nothing is generated";
}

}  // namespace
}  // namespace tessera::cli_test
