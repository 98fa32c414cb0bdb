// Mistakes in command lines and parameter files: the messages before anything is built.

#include <cstdlib>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

using Output = Command;

TEST_F(Output, ThatIsLostIsAFailureAndGoesIntoNoFile) {
  fs::copy(fs::path(TESSERA_SOURCE_DIR) / "examples/01_line_follower/spec.yaml", folder_ / "spec.yaml");
  for (const char* line : {"show", "show --counts --json -", "verify",
                           "rename robot.control.follow pursue --dry-run", "--help", "verify --json - "})
    for (const auto& [where, why] :
         {std::pair{">/dev/full", "No space left on device"}, {">&-", "Bad file descriptor"}}) {
      const project::Exit done = tessera(std::string(line) + " 2>err.txt " + where);
      const std::string told = content_of(folder_ / "err.txt");
      EXPECT_NE(done.code, 0) << line << where;
      EXPECT_NE(told.find(why), std::string::npos) << line << where << "\n" << told;
    }
  // The file has the lowest free number, which must not be that of standard error.
  EXPECT_EQ(tessera("show --svg net.svg --page nowhere 2>&-").code, 1);
  EXPECT_EQ(tessera("show --svg net.svg >&- 2>&-").code, 0);
  EXPECT_EQ(content_of(folder_ / "net.svg").rfind("<", 0), 0U);
}

struct WrongInput {
  const char* arguments;
  const char* parameters;  ///< of params.yaml; empty: there is none
};

constexpr WrongInput wrong_inputs[] = {
    {"simulate --set v", ""},
    {"simulate --set =3", ""},
    {"simulate --set vv=3", ""},
    {"simulate --set v=fast", ""},
    {"simulate --set v=", ""},
    {"simulate --set 'v=3 kg'", ""},
    {"simulate --set 'v=3 km'", ""},
    {"simulate --set 'v=3600 km/h' --set vv=1", ""},
    {"simulate --set robot.contrl.v=3", ""},
    {"simulate --set robot.motor.v=1 --set robot.motor.rr=1", ""},
    {"simulate --for soon", ""},
    {"simulate --record-limit many", ""},
    {"simulate --sed 3", ""},
    {"simulate --seed x", ""},
    {"simulat", ""},
    {"simulate nowhere", ""},
    {"run --hardware robot.motor", ""},
    {"run", ""},
    {"simulate --schedules 20", ""},
    {"simulate --from run.tsr", ""},
    {"schedules 20 --part 3", ""},
    {"schedules many", ""},
    {"rerun", ""},
    {"simulate --parameters nowhere.yaml", ""},
    {"simulate", "v: fast\nw: 3 kg\n"},
    {"simulate", "v: [1, 2]\nrobot.control:\n  vv: 3\n"},
    {"simulate", "v 0.3\n"},
    {"simulate", "v: 0.3\nw:\n"},
    {"simulate", "v: { x: [1, [2]] }\n"},
    {"simulate", "- v: 1\n"},
    {"simulate", "v: 1\n w: 2\n"},
    {"simulate", "robot[3]: { control: { v: 1 } }\n"},
    {"simulate", "v: 2\nv: 3\n"},
    {"simulate", "robot: { control: { v: 2 } }\nrobot.control.v: 3\n"},
    {"simulate", "v: 3\n---\nv: 4\n"},
    {"simulate", "v: \"3\n"},
    {"simulate --parameters .", ""},
    {"simulate --set points=1,2", ""},
    {"simulate --set 'points=[1, 2, -3]'", ""},
    {"simulate --set 'points=[1, 2 cm, x]'", "points: 3\n"},
};

class WrongInputs : public Command {};

TEST_F(WrongInputs, OfCommandLinesAndParameterFiles) {
  const fs::path project = example("01_line_follower");
  replace(project / "spec.yaml", "parameters: { v: 0.2 m/s,",
          "parameters: { points: { type: \"float64[3] m\", default: [1, 2, 3], min: 0 }, v: 0.2 m/s,");
  std::string all;
  for (const WrongInput& wrong : wrong_inputs) {
    fs::remove(project / "params.yaml");
    if (*wrong.parameters != '\0') write(project / "params.yaml", wrong.parameters);
    const project::Exit done =
        shell("cd 01_line_follower && " TESSERA_BINARY_DIR "/tessera " + std::string(wrong.arguments));
    EXPECT_TRUE(done.code == 1 || done.code == 2) << wrong.arguments << "\n" << done.text;
    EXPECT_LE(std::count(done.text.begin(), done.text.end(), '\n'), 24) << done.text;
    all += "=== tessera " + std::string(wrong.arguments) + "\n" + wrong.parameters + "--- " +
           std::to_string(done.code) + "\n" + done.text;
  }
  for (const std::string& own : {fs::canonical(folder_).string(), folder_.string()})
    for (std::size_t at = all.find(own); at != std::string::npos; at = all.find(own))
      all.replace(at, own.size(), "FOLDER");
  EXPECT_FALSE(fs::exists(project / ".tessera/build")) << "nothing was built";
  const fs::path golden = fs::path(TESSERA_SOURCE_DIR) / "tests/golden/command_line/wrong.expected";
  if (std::getenv("TESSERA_UPDATE_GOLDEN") != nullptr) write(golden, all);
  EXPECT_EQ(all, content_of(golden));
}

}  // namespace
}  // namespace tessera::cli_test
