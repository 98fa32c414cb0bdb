// Failures of user code in runs of controllers, on projects of the test data.

#include <cstdlib>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

class FailedRuns : public Command {
 protected:
  void SetUp() override {
    const char* data = std::getenv("TESSERA_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
    projects_ = fs::path(data) / "field/projects";
    ASSERT_TRUE(fs::is_directory(projects_)) << projects_;
  }
  void project(const std::string& name) const {
    fs::copy(projects_ / name, folder_ / name, fs::copy_options::recursive);
  }
  static bool has(const project::Exit& done, const std::string& text) {
    return done.text.find(text) != std::string::npos;
  }

  fs::path projects_;
};

TEST_F(FailedRuns, LeadNowhereUntilAnEntryNamesTheFailure) {
  project("failure_counts_as_success");
  const project::Exit failed = tessera("simulate failure_counts_as_success --for 2s");
  EXPECT_EQ(failed.code, 1) << failed.text;
  EXPECT_TRUE(has(failed, "gripper has lost its air")) << failed.text;
  EXPECT_TRUE(has(failed, "ended by an error that no `next` leads to another behaviour")) << failed.text;
  EXPECT_FALSE(has(failed, "lift, closed")) << failed.text;
  const project::Exit legal = tessera("replay failure_counts_as_success/.tessera/last --check");
  EXPECT_EQ(legal.code, 0) << legal.text;
  EXPECT_EQ(tessera("migrate failure_counts_as_success").code, 0);
  const project::Exit as_before = tessera("simulate failure_counts_as_success --for 2s");
  EXPECT_EQ(as_before.code, 0) << as_before.text;
  EXPECT_TRUE(has(as_before, "lift, closed: no")) << as_before.text;
}

TEST_F(FailedRuns, DoWhatTheWarningAboutTheirErrorSays) {
  project("w313");
  const project::Exit warned = tessera("check w313");
  EXPECT_TRUE(has(warned, "warning W313")) << warned.text;
  EXPECT_TRUE(has(warned, "it ends the subsystem and stops the system")) << warned.text;
  const project::Exit failed = tessera("simulate w313 --for 2s --accept-violations");
  EXPECT_EQ(failed.code, 1) << failed.text;
  EXPECT_TRUE(has(failed, "work")) << failed.text;
  EXPECT_FALSE(has(failed, "robot.control: limp")) << failed.text;
  EXPECT_FALSE(has(failed, "  limp\n")) << failed.text;
  ASSERT_TRUE(has(warned, "write next: { to: limp, when: error }")) << warned.text;
  replace(folder_ / "w313/spec.yaml", "next: limp", "next: { to: limp, when: error }");
  const project::Exit clean = tessera("check w313");
  EXPECT_FALSE(has(clean, "warning")) << clean.text;
  const project::Exit routed = tessera("simulate w313 --for 2s");
  EXPECT_EQ(routed.code, 0) << routed.text;
  EXPECT_TRUE(has(routed, "limp")) << routed.text;
}

TEST_F(FailedRuns, OfAnErrorOnlyBehaviourAreSimulated) {
  project("error_only_behaviour");
  const project::Exit judged = tessera("verify error_only_behaviour");
  EXPECT_EQ(judged.code, 0) << judged.text;
  EXPECT_TRUE(has(judged, "robot.control.limp (line 11) is reachable only after a failure")) << judged.text;
  const project::Exit driven =
      tessera("simulate error_only_behaviour --for 2s --inject robot.control:throw@500ms");
  EXPECT_EQ(driven.code, 0) << driven.text;
  EXPECT_TRUE(has(driven, "limp")) << driven.text;
}

}  // namespace
}  // namespace tessera::cli_test
