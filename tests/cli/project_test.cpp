#include <dlfcn.h>
#include <unistd.h>

#include "command.hpp"

namespace tessera::cli_test {

using Project = Command;

TEST_F(Project, NewMakesAProjectThatDrivesAndWhoseTestsPass) {
  ASSERT_EQ(tessera("new rover").code, 0);
  const nlohmann::json run = json("simulate rover --for 20s --report rover/report");
  EXPECT_NEAR(run.at("simulated_s"), 20, 0.1);
  EXPECT_GT(run.at("firings"), 1000);
  EXPECT_GT(run.at("laps"), 0.2);
  EXPECT_TRUE(fs::exists(run.at("recording").get<std::string>()));
  EXPECT_TRUE(fs::exists(folder_ / "rover/report/index.html"));
  EXPECT_TRUE(fs::exists(folder_ / "rover/compile_commands.json"));
  const project::Exit tests = tessera("test rover");
  EXPECT_EQ(tests.code, 0) << tests.text;
  EXPECT_NE(tests.text.find("[  PASSED  ]"), std::string::npos) << tests.text;
  const project::Exit none = tessera("test rover --filter 'Folow.*'");
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.text.find("no test matches --filter Folow.*; there are Follow.SteersByTheTable, "),
            std::string::npos)
      << none.text;
}

TEST_F(Project, NewBeginsWithTheRobotThatWasAskedFor) {
  for (const auto& [robot, part] :
       {std::pair{"line_follower", "line_world.xml"}, std::pair{"rover", "src/robot/room.hpp"},
        std::pair{"arm", "arm.xml"}, std::pair{"depot", "yard.xml"}, std::pair{"fleet", "hall.xml"},
        std::pair{"empty", "src/control.cpp"}}) {
    const std::string name = std::string("my_") + robot;
    const project::Exit made = tessera("new " + name + " --robot " + robot);
    ASSERT_EQ(made.code, 0) << made.text;
    EXPECT_TRUE(fs::exists(folder_ / name / part)) << part;
    EXPECT_TRUE(fs::exists(folder_ / name / ".gitignore"));
    EXPECT_NE(content_of(folder_ / name / "spec.yaml").find("\nsystem: " + name + "\n"), std::string::npos);
    EXPECT_EQ(content_of(folder_ / name / "README.md").find("# " + name), 0U);
    const project::Exit judged = tessera("verify " + name);
    EXPECT_EQ(judged.code, 0) << judged.text;
  }
  EXPECT_EQ(tessera("new other --robot submarine").code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "other"));
}

TEST_F(Project, AnEmptyProjectRunsAndSoDoesItsNextStep) {
  const project::Exit made = tessera("new depot --robot empty");
  ASSERT_EQ(made.code, 0) << made.text;
  EXPECT_NE(made.text.find("Then add an agent"), std::string::npos) << made.text;
  EXPECT_NEAR(json("simulate depot --for 2s").at("simulated_s"), 2, 0.1);
  // The next step is in comments.
  std::string text = content_of(folder_ / "depot/spec.yaml");
  for (std::size_t at = 0; (at = text.find("\n# - ", at)) != std::string::npos;) text.erase(at + 1, 4);
  ASSERT_NE(text.find("\nchannels:\n  - robot.control.request -> dock.control.request\n"), std::string::npos)
      << text;
  write(folder_ / "depot/spec.yaml", text);
  EXPECT_EQ(tessera("simulate depot --for 2s").code, 1);
  EXPECT_EQ(tessera("generate depot --stubs").code, 0);
  const nlohmann::json run = json("simulate depot --for 2s");
  EXPECT_EQ(run.at("subsystems").size(), 2U) << run;
}

TEST_F(Project, AnArmKeepsOffTheWallUntilAMotionIsWrong) {
  ASSERT_EQ(tessera("new my_arm --robot arm").code, 0);
  const nlohmann::json run = json("simulate my_arm --for 20s");
  ASSERT_EQ(run.at("checks").size(), 3U);
  for (const nlohmann::json& check : run.at("checks")) EXPECT_EQ(check.at("verdict"), "held") << check;
  const project::Exit tests = tessera("test my_arm");
  EXPECT_EQ(tests.code, 0) << tests.text;
  const fs::path source = folder_ / "my_arm/src/arm/control.cpp";
  std::string text = content_of(source);
  const std::string above = "above_wall{0, -0.6, 0.8}";
  ASSERT_NE(text.find(above), std::string::npos);
  write(source, text.replace(text.find(above), above.size(), "above_wall{0, -0.1, 0.8}"));
  const project::Exit hit = tessera("simulate my_arm --for 20s");
  EXPECT_EQ(hit.code, 1);
  EXPECT_NE(hit.text.find("arm, wall touch"), std::string::npos) << hit.text;
}

TEST_F(Project, CarriersShareADock) {
  ASSERT_EQ(tessera("new yard --robot depot").code, 0);
  const nlohmann::json run = json("simulate yard --for 60s");
  ASSERT_EQ(run.at("checks").size(), 3U);
  for (const nlohmann::json& check : run.at("checks")) EXPECT_EQ(check.at("verdict"), "held") << check;
  EXPECT_GT(run.at("measures").at("nearest").at("least"), 0.3);
  EXPECT_EQ(run.at("measures").at("nearest").at("unit"), "m");
  // One carrier waits in the dock.
  const project::Exit hit = tessera("simulate yard --for 20s --set 'carrier[1].control.line=0.1'");
  EXPECT_EQ(hit.code, 1);
  EXPECT_NE(hit.text.find(" m (at "), std::string::npos) << hit.text;
  EXPECT_NE(hit.text.find("check nobody touches: failed at "), std::string::npos) << hit.text;
  EXPECT_NE(hit.text.find(" touch"), std::string::npos) << hit.text;
  const project::Exit tests = tessera("test yard");
  EXPECT_EQ(tests.code, 0) << tests.text;
}

/// Whether this machine has what cameras need.
bool sees_worlds() {
  void* const library = dlopen("libEGL.so.1", RTLD_NOW);
  if (library != nullptr) dlclose(library);
  return library != nullptr;
}

TEST_F(Project, ARoverDrivesAboutAndTakesParametersWithUnits) {
  ASSERT_EQ(tessera("new scout_2 --robot rover").code, 0);
  const nlohmann::json run = json("simulate scout_2 --for 30s");
  ASSERT_EQ(run.at("checks").size(), 2U);
  for (const nlohmann::json& check : run.at("checks")) EXPECT_EQ(check.at("verdict"), "held") << check;
  EXPECT_NEAR(run.at("measures").at("speed").at("greatest"), 0.4, 0.01);
  const nlohmann::json slow = json("simulate scout_2 --for 10s --set speed='20 cm/s'");
  EXPECT_NEAR(slow.at("measures").at("speed").at("greatest"), 0.2, 0.01);
  const project::Exit wrong = tessera("simulate scout_2 --for 10s --set speed='20 s'");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.text.find("the parameter is in m/s; write a number in m/s"), std::string::npos)
      << wrong.text;
  const project::Exit tests = tessera("test scout_2");
  EXPECT_EQ(tests.code, 0) << tests.text;
}

TEST_F(Project, AFleetOfOneModelHasOneLineForEachElement) {
  example("07_fleet");
  const project::Exit listed = tessera("world 07_fleet");
  EXPECT_NE(listed.text.find("\n    robot[*].motors.ahead: { actuator: ahead }  # float64\n"),
            std::string::npos)
      << listed.text;
  EXPECT_EQ(listed.text.find("robot[7].motors"), std::string::npos);
}

TEST_F(Project, TheExamplesWithManyAgentsKeepTheirChecks) {
  for (const char* name : {"06_sorting_cell", "depot"}) {
    const bool cell = name == std::string("06_sorting_cell");
    if (cell)
      example(name);
    else
      ASSERT_EQ(tessera("new depot --robot fleet").code, 0);
    const project::Exit tests = tessera(std::string("test ") + name);
    EXPECT_EQ(tests.code, 0) << tests.text;
    if (cell && !sees_worlds()) continue;
    const nlohmann::json run = json(std::string("simulate ") + name + (cell ? " --for 65s" : " --for 15s"));
    for (const nlohmann::json& check : run.at("checks")) EXPECT_EQ(check.at("verdict"), "held") << check;
  }
}

TEST_F(Project, NewRefusesAFolderThatExistsAndANameThatIsNone) {
  ASSERT_EQ(tessera("new rover").code, 0);
  EXPECT_EQ(tessera("new rover").code, 1);
  EXPECT_EQ(tessera("new 'Not A Name'").code, 2);
  for (const char* taken : {"errno", "while", "std", "time", "tessera_rover"}) {
    const project::Exit refused = tessera(std::string("new ") + taken);
    EXPECT_EQ(refused.code, 2) << refused.text;
    EXPECT_FALSE(fs::exists(folder_ / taken));
  }
  EXPECT_NE(tessera("new time")
                .text.find("system name 'time' is taken by the C or C++ library; for example "
                           "'time_1'"),
            std::string::npos);
}

TEST_F(Project, ChangedFunctionChangesTheRun) {
  ASSERT_EQ(tessera("new rover").code, 0);
  EXPECT_GT(json("simulate rover --for 10s").at("laps"), 0.1);
  write(folder_ / "rover/src/control.cpp",
        "#include \"robot/control.hpp\"\n"
        "namespace rover::robot::control {\n"
        "void init(Context&, const Inputs&, Memory&, Outputs&) {}\n"
        "void follow(Context& context, const Inputs&, Memory&, Outputs&) {\n"
        "  if (context.iteration > 20) context.stop(\"seen enough\");\n"
        "}\n"
        "}\n");
  const nlohmann::json stopped = json("simulate rover --for 10s");
  EXPECT_LT(stopped.at("simulated_s"), 2);
  EXPECT_EQ(stopped.at("ended"), "stopped: seen enough");
  EXPECT_LT(stopped.at("laps"), 0.01);
}

TEST_F(Project, MissingFunctionIsNamedWithAStubAndAppendedOnRequest) {
  ASSERT_EQ(tessera("new rover").code, 0);
  replace(folder_ / "rover/spec.yaml", "follow: {}", "follow: {}\n        rest: {}");
  // No behaviour leads to the new one yet, which the proof would report.
  const std::string generate = "generate rover --accept-violations";
  const project::Exit missing = tessera(generate);
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.text.find("src/control.cpp: error: robot.control has no function 'rest'"),
            std::string::npos)
      << missing.text;
  EXPECT_NE(missing.text.find("void rest(Context&"), std::string::npos) << missing.text;
  EXPECT_EQ(tessera(generate + " --stubs").code, 0);
  EXPECT_EQ(tessera(generate).code, 0);
  EXPECT_EQ(tessera("simulate rover --for 1s --accept-violations").code, 0);
}

TEST_F(Project, CompileErrorInAConditionNamesTheLineOfTheSpecification) {
  ASSERT_EQ(tessera("new rover").code, 0);
  replace(folder_ / "rover/spec.yaml", "follow: {}", "follow: { terminal: in.line.lft(), next: follow }");
  const std::string spec = content_of(folder_ / "rover/spec.yaml");
  const auto line =
      1 +
      std::count(spec.begin(), spec.begin() + static_cast<std::ptrdiff_t>(spec.find("in.line.lft()")), '\n');
  const project::Exit done = tessera("simulate rover --for 1s");
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.text.find("spec.yaml:" + std::to_string(line) + ":"), std::string::npos) << done.text;
  EXPECT_NE(done.text.find("lft"), std::string::npos) << done.text;
}

TEST_F(Project, DebugPrintsTheCommandThatDebugsTheRun) {
  ASSERT_EQ(tessera("new rover").code, 0);
  const project::Exit done = tessera("simulate rover --for 1s --debug");
  EXPECT_EQ(done.code, 0) << done.text;
  ASSERT_NE(done.text.find("gdb -ix "), std::string::npos) << done.text;
  const std::string line = done.text.substr(done.text.find("gdb -ix "));
  // The second time, there is a value.
  const project::Exit debugged = shell(
      "gdb -batch -ex 'set breakpoint pending on' -ex 'break rover::robot::control::follow' -ex run "
      "-ex continue -ex bt -ex 'print in.line' -ex 'print in.line.middle' -ex 'print context.now' " +
      line.substr(4));
  EXPECT_NE(debugged.text.find("control.cpp"), std::string::npos) << debugged.text;
  EXPECT_NE(debugged.text.find("= (valid, fresh, 60 ms old) = {left = true, middle = true, right = true}"),
            std::string::npos)
      << debugged.text;
  EXPECT_NE(debugged.text.find("$2 = true\n$3 = 100 ms\n"), std::string::npos) << debugged.text;
}

TEST_F(Project, ACopyIsBuiltFromItsOwnSources) {
  const fs::path project = example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 1s").code, 0);
  fs::copy(project, folder_ / "copy", fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  write(folder_ / "copy/src/control.cpp",
        content_of(project / "src/control.cpp") + "\nint broken = \"text\";\n");
  const project::Exit built = tessera("simulate copy --for 1s");
  EXPECT_EQ(built.code, 1) << built.text;
  EXPECT_NE(built.text.find("src/control.cpp:"), std::string::npos) << built.text;
  EXPECT_NE(built.text.find("copy/.tessera/build/release/compiler.log"), std::string::npos) << built.text;
}

}  // namespace tessera::cli_test
