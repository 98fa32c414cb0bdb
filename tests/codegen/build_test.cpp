#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "generated.hpp"

namespace tessera::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A project built the way a user's is, with more warnings, and every one an error.
class Build {
 public:
  explicit Build(const fs::path& project) {
    folder_.write(generate_file(project / "spec.yaml").files);
    const std::string sanitize = TESSERA_SANITIZE;
    const std::string launcher = TESSERA_LAUNCHER;
    configured_ =
        run(TESSERA_CMAKE " -G Ninja -S " + folder_.path().string() + " -B " + build().string() +
            " -DCMAKE_CXX_COMPILER=" TESSERA_CXX " -Dtessera_DIR=" TESSERA_PACKAGE " -DTESSERA_PROJECT_DIR=" +
            project.string() + " -DCMAKE_CXX_FLAGS='-Wpedantic -Wconversion -Wshadow -Werror" +
            (sanitize.empty() ? "'" : " -fsanitize=" + sanitize + "' -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O0") +
            (launcher.empty() ? "" : " -DCMAKE_CXX_COMPILER_LAUNCHER=" + launcher));
    if (configured_.exit_code == 0)
      built_ = run(TESSERA_CMAKE " --build " + build().string() + " -j2 -t all tests");
  }

  [[nodiscard]] fs::path build() const { return folder_.path() / "build"; }
  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }
  void expect_built() const {
    ASSERT_EQ(configured_.exit_code, 0) << configured_.output;
    ASSERT_EQ(built_.exit_code, 0) << built_.output;
  }

 private:
  Folder folder_;
  Ran configured_, built_;
};

/// Runs the controller of a project with a simulated robot for a second, in a world without physics.
void expect_runs_in_fake_world(const Build& build) {
  std::string drivers;
  for (const char* buffer : {"sensor.left", "sensor.middle", "sensor.right"})
    drivers += std::string(" --driver robot.") + buffer + "=reflectance:eye";
  for (const char* buffer : {"motor.left", "motor.right"})
    drivers += std::string(" --driver robot.") + buffer + "=velocity:wheel";
  const fs::path summary = build.folder() / "summary.json";
  const Ran ran =
      run((build.build() / "controller").string() + " simulate --for 1s --world none.xml --world-library " +
          TESSERA_FAKE_WORLD + drivers + " --summary " + summary.string());
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(read_file(summary), HasSubstr("robot.motor"));
}

void expect_tests_pass(const Build& build) {
  const Ran ran = run((build.build() / "tests").string());
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("PASSED"));
}

TEST(Build, LineFollowerCompilesWithoutWarningsRunsAndPassesItsTests) {
  const Build build(source_folder / "examples/01_line_follower");
  build.expect_built();
  if (HasFatalFailure()) return;
  expect_runs_in_fake_world(build);
  expect_tests_pass(build);
}

TEST(Build, GapCompilesWithoutWarningsRunsAndPassesItsTests) {
  const Build build(source_folder / "examples/02_gap");
  build.expect_built();
  if (HasFatalFailure()) return;
  expect_runs_in_fake_world(build);
  expect_tests_pass(build);
}

TEST(Build, EveryFeatureCompilesWithoutWarningsAndRuns) {
  const Build build(features_spec.parent_path());
  build.expect_built();
  if (HasFatalFailure()) return;
  expect_tests_pass(build);
  const Ran ran = run((build.build() / "controller").string() + " simulate --for 1s");
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
}

}  // namespace
}  // namespace tessera::test
