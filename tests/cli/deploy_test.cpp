#include <csignal>
#include <utility>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

/// Three real processes that talk over loopback. The controller is built once.
class Deploy : public Command {
 protected:
  Deploy() : project_(folder_ / "11_crossing_apart") {
    static bool built = false;
    kept() = fs::temp_directory_path() / ("tessera_deploy_" + std::to_string(getpid()));
    if (!std::exchange(built, true)) {
      fs::rename(example("11_crossing_apart"), kept());
      built = tessera("generate '" + kept().string() + "' --build").code == 0;
    }
    fs::create_directory_symlink(kept(), project_);
    // Others may run the same system on this machine.
    domain_ = " --domain " + std::to_string(1 + getpid() % 230);
  }
  static void TearDownTestSuite() { fs::remove_all(kept()); }
  static fs::path& kept() {
    static fs::path folder;
    return folder;
  }

  [[nodiscard]] nlohmann::json deployment() const {
    return nlohmann::json::parse(content_of(project_ / ".tessera/last/deployment.json"), nullptr, false);
  }
  [[nodiscard]] pid_t pid_of(std::size_t process) const {
    return deployment().at("processes").at(process).at("starts").back().at("pid").get<pid_t>();
  }
  [[nodiscard]] bool any_is_left() const {
    for (std::size_t process = 0; process < 3; ++process)
      if (kill(pid_of(process), 0) == 0) return true;
    return false;
  }
  /// Runs it, and kills rover[0] when that has said something.
  project::Exit run_and_kill(const std::string& options) const {
    bool killed = false;
    const std::string line = "cd '" + folder_.string() + "' && exec " + TESSERA_BINARY_DIR +
                             "/tessera run 11_crossing_apart --deploy" + domain_ + options;
    return project::capture({"sh", "-c", line}, [&](std::string_view said) {
      if (killed || !said.starts_with("rover[0] |")) return;
      killed = true;
      kill(pid_of(1), SIGKILL);
    });
  }

  fs::path project_;
  std::string domain_;
};

constexpr const char* checked = "replay 11_crossing_apart/.tessera/last --check";

TEST_F(Deploy, ProcessesRunTogetherAndTheirRecordingsAreOneLegalRun) {
  const project::Exit alone = tessera("run 11_crossing_apart --for 1s");
  EXPECT_EQ(alone.code, 1);
  EXPECT_NE(alone.text.find("`--deploy` starts those of this machine"), std::string::npos) << alone.text;
  const project::Exit unknown = tessera("run 11_crossing_apart --deploy --only rover[0],gat");
  EXPECT_NE(unknown.text.find("has no process 'gat'; did you mean 'gate'?"), std::string::npos)
      << unknown.text;

  const project::Exit run = tessera("run 11_crossing_apart --deploy --for 3s" + domain_);
  EXPECT_EQ(run.code, 0) << run.text;
  EXPECT_NE(run.text.find("rover[1] | "), std::string::npos) << run.text;
  EXPECT_NE(run.text.find("ended: duration"), std::string::npos) << run.text;
  EXPECT_FALSE(any_is_left());
  const project::Exit joint = tessera(checked);
  EXPECT_EQ(joint.code, 0) << joint.text;
  EXPECT_NE(joint.text.find("in 3 recordings"), std::string::npos) << joint.text;

  const std::string last = "11_crossing_apart/.tessera/last/process-";
  const project::Exit part = tessera("replay --check '" + last + "gate.tsr' '" + last + "rover[0].tsr'");
  EXPECT_EQ(part.code, 3) << part.text;
  EXPECT_NE(part.text.find("no recording of rover[1] is given"), std::string::npos) << part.text;
  const project::Exit twice = tessera("replay --check '" + last + "gate.tsr' '" + last + "gate.tsr'");
  EXPECT_EQ(twice.code, 1);
  EXPECT_NE(twice.text.find("two of them are of 'gate'"), std::string::npos) << twice.text;
}

TEST_F(Deploy, OneThatIsKilledIsToldOfAndStopsTheOthersOrStartsAgain) {
  const project::Exit stopped = run_and_kill(" --for 60s");
  EXPECT_EQ(stopped.code, 1) << stopped.text;
  EXPECT_NE(stopped.text.find("rover[0]: the controller was killed by SIGKILL"), std::string::npos)
      << stopped.text;
  EXPECT_NE(stopped.text.find("ended: SIGTERM"), std::string::npos) << stopped.text;
  EXPECT_FALSE(any_is_left());
  const project::Exit cut = tessera(checked);
  EXPECT_EQ(cut.code, 3) << cut.text;
  EXPECT_NE(cut.text.find("the recording of rover[0] is cut off at its end"), std::string::npos) << cut.text;

  const project::Exit again = run_and_kill(" --for 4s --restart on-failure");
  EXPECT_EQ(again.code, 0) << again.text;
  EXPECT_NE(again.text.find("start 2 in 1.0 s"), std::string::npos) << again.text;
  EXPECT_TRUE(fs::exists(project_ / ".tessera/last/process-rover[0]@2.tsr")) << again.text;
  EXPECT_FALSE(any_is_left());
  const project::Exit both = tessera(checked);
  EXPECT_EQ(both.code, 3) << both.text;
  EXPECT_NE(both.text.find("in 4 recordings"), std::string::npos) << both.text;
}

}  // namespace
}  // namespace tessera::cli_test
