// `tessera test`, with everything that the tests of a project can use.
#include "command.hpp"

namespace tessera::cli_test {
namespace {

using Testing = Command;

TEST_F(Testing, ShowsWhichLinesAndWhichPartsOfTheNetTheTestsOfAProjectHaveReached) {
  const fs::path project = example("08_rover");
  const project::Exit done = tessera("test 08_rover --coverage");
  ASSERT_EQ(done.code, 0) << done.text;
  EXPECT_NE(done.text.find("[  PASSED  ] 9 tests."), std::string::npos) << done.text;
  EXPECT_NE(done.text.find("  src/robot/laser.cpp                 4 of 4\n"), std::string::npos) << done.text;
  EXPECT_NE(done.text.find("coverage of the net by 2 runs:\n  behaviours        4 of      4  100.0 %\n"),
            std::string::npos)
      << done.text;
  EXPECT_NE(done.text.find("never true: t_avoid_1 [error]   spec.yaml:29"), std::string::npos) << done.text;

  // A function that no test calls is reported with its lines.
  std::ofstream(project / "src/robot/room.cpp") << "int unused(int x) {\n  return x + 1;\n}\n";
  const project::Exit more = tessera("test 08_rover --coverage");
  EXPECT_NE(more.text.find("src/robot/room.cpp                  0 of 2, not 1-2\n"), std::string::npos)
      << more.text;
}

}  // namespace
}  // namespace tessera::cli_test
