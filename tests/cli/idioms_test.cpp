// The idioms of docs/reference/specification.md mean what the page says: one controller, and runs in
// which one of them fails.

#include <vector>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

/// The specification of the section "Idioms".
std::string idioms() {
  const std::string page = content_of(fs::path(TESSERA_SOURCE_DIR) / "docs/reference/specification.md");
  const std::string fence = "```yaml\n";
  const std::size_t section = page.find("### Idioms\n");
  const std::size_t begin = page.find(fence, section);
  if (section == std::string::npos || begin == std::string::npos) return {};
  return page.substr(begin + fence.size(), page.find("```", begin + fence.size()) - begin - fence.size());
}

struct IdiomRun {
  const char* fails;  ///< the behaviour in which an iteration fails; "": none
  int exit_code;
  std::vector<std::string> entered, never;  ///< transitions of robot.control that fire, and that do not
};

const std::vector<IdiomRun> runs{
    {"", 0, {"t_init_1", "t_seek_1", "t_ask_1", "t_grab_2"}, {"t_grab_1", "t_grab_3", "t_init_2"}},
    {"robot.control.init", 1, {"t_init_2"}, {"t_init_1", "t_seek_1"}},
    {"robot.control.seek", 1, {"t_init_1", "t_seek_2"}, {"t_seek_1", "t_ask_1"}},
    {"robot.control.ask", 1, {"t_seek_1", "t_ask_2"}, {"t_ask_1", "t_grab_2"}},
    {"robot.control.grab", 0, {"t_ask_1", "t_grab_1", "t_grab_2"}, {"t_grab_3"}},
    {"robot.eye.look", 0, {"t_ask_1", "t_grab_2", "eye.t_look_1"}, {"t_grab_1"}},
};

/// The first time, in seconds, at which a transition has fired; negative: never.
double fired_at(const std::string& csv, const std::string& transition) {
  const std::size_t at = csv.find(transition);
  if (at == std::string::npos) return -1;
  const std::size_t line = csv.rfind('\n', at) + 1;
  return std::stod(csv.substr(line));
}

using Idioms = Command;

TEST_F(Idioms, MeanWhatTheirPageSays) {
  const std::string text = idioms();
  ASSERT_FALSE(text.empty()) << "docs/reference/specification.md has no section of idioms";
  write(folder_ / "p/spec.yaml", text);
  const project::Exit checked = tessera("check p");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_EQ(checked.text.find("warning"), std::string::npos) << checked.text;
  ASSERT_EQ(tessera("generate p --stubs").code, 0);
  for (const IdiomRun& run : runs) {
    SCOPED_TRACE(run.fails);
    const std::string fault = *run.fails == '\0' ? "" : std::string(" --inject ") + run.fails + ":throw@0s";
    const project::Exit done = tessera("simulate p --for 4s --record run.tsr" + fault);
    EXPECT_EQ(done.code, run.exit_code) << done.text;
    const project::Exit table = tessera("replay run.tsr --csv -");
    ASSERT_EQ(table.code, 0) << table.text;
    const std::string robot = "robot.";
    for (const std::string& one : run.entered)
      EXPECT_GE(fired_at(table.text, robot + (one.starts_with("eye") ? "" : "control.") + one), 0)
          << one << "\n"
          << done.text;
    for (const std::string& one : run.never)
      EXPECT_LT(fired_at(table.text, robot + "control." + one), 0) << one << "\n" << done.text;
    EXPECT_EQ(tessera("replay run.tsr --spec p --check").code, 0) << "the run is one of the net";
    if (*run.fails == '\0') {
      EXPECT_GE(fired_at(table.text, "robot.control.t_ask_1"), fired_at(table.text, "dock.control.t_busy_1"))
          << "nobody goes on without the grant";
    }
  }
}

}  // namespace
}  // namespace tessera::cli_test
