// Projects of others whose sensor is dead, from the test data.
#include <gmock/gmock.h>

#include <cstdlib>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct DeadSensors : Command {
  void SetUp() override {
    if (std::getenv("TESSERA_TEST_DATA") == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  }
  /// The output of a simulated run of 3 s.
  std::string simulated(const std::string& name) const {
    const fs::path from = fs::path(std::getenv("TESSERA_TEST_DATA")) / "field/projects" / name;
    fs::copy(from, folder_ / name, fs::copy_options::recursive);
    fs::permissions(folder_ / name, fs::perms::owner_write, fs::perm_options::add);
    const project::Exit done =
        shell("cd " + name + " && " + TESSERA_BINARY_DIR + "/tessera simulate --for 3s");
    EXPECT_EQ(done.code, 0) << done.text;
    return done.text;
  }
};

TEST_F(DeadSensors, ADeviceThatThrowsEndsABehaviourByTheAgeOfItsInput) {
  const std::string text = simulated("age_of_dead_sensor");
  const std::size_t failed = text.find("USB device has gone");
  ASSERT_NE(failed, std::string::npos) << text;
  const std::size_t stop = text.find("STOP");
  ASSERT_NE(stop, std::string::npos) << text;
  EXPECT_GT(stop, failed);
  EXPECT_THAT(text.substr(stop), Not(HasSubstr("drive:"))) << text;
  EXPECT_THAT(text, HasSubstr("valid no, fresh no, age 500 ms")) << "the age of the last valid value";
}

TEST_F(DeadSensors, AReadingThatNeverCameEntersNoBehaviour) {
  const std::string text = simulated("no_reading_sent_as_valid");
  EXPECT_THAT(text, HasSubstr("wait"));
  EXPECT_THAT(text, Not(HasSubstr("drive")));
}

}  // namespace
}  // namespace tessera::cli_test
