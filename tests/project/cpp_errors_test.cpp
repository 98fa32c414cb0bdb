// Mistakes in C++, compiled by a user's g++, and the messages about them.

#include <algorithm>
#include <array>
#include <cstdlib>

#include "folder.hpp"
#include "project/build/build_errors.hpp"
#include "project/build/cmake_errors.hpp"
#include "project/build/controller.hpp"
#include "project/process/process.hpp"

namespace tessera::project_test {
namespace {

constexpr const char* specification = R"(tessera: 1
system: rover
types:
  Line: { left: bool, right: bool }
  Velocity: { linear: float64 m/s, angular: float64 rad/s }
parameters: { speed: 0.2 m/s }
agents:
  robot:
    control:
      rate: 20 Hz
      inputs: { line: Line, level: float64 }
      outputs: { motion: Velocity }
      memory: { count: uint32 }
      behaviours:
        follow: { terminal: FOLLOWED, next: follow }
    receptors:
      eye:
        rate: 20 Hz
        real: { raw: float64 }
        outputs: { line: Line, level: float64 }
        behaviours: { look: {} }
    effectors:
      motor:
        rate: 20 Hz
        inputs: { speed: Velocity }
        real: { left: float64 }
        stale: 500 ms
        behaviours: { drive: {} }
channels:
  - robot.eye.line -> robot.control.line
  - robot.eye.level -> robot.control.level
  - robot.control.motion -> robot.motor.speed
drivers:
  robot.eye.raw: { cpp: Eye }
  robot.motor.left: { cpp: Wheel }
)";

constexpr const char* function = R"(#include "robot/control.hpp"

namespace rover::robot::control {

void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  HERE
}

}  // namespace rover::robot::control
)";

constexpr const char* drivers = R"(#pragma once
#include <optional>
#include <tessera/device.hpp>

class Eye final : public tessera::Receptor<double> {
 public:
  std::optional<double> read() override { return 0.5; }
};
class Wheel final : public tessera::Effector<double> {
 public:
  bool write(const double&) override { return true; }
};
)";

/// The contents of the function: each is a separate mistake.
constexpr auto statements = std::to_array<const char*>({
    "if (in.lin.left) return;",
    "if (in.line.lft) return;",
    "if (in.level.left) return;",
    "out.motin = {0, 0};",
    "++memory.cont;",
    "out.motion.linear = context.parameters.sped;",
    "context.lg(\"x\");",
    "out.motion = {};",
    "out.motion.skip();",
    "in.level = 3;",
    "in.line.left = true;",
    "out.motion = 3;",
    "out.motion.linear = sqrt(2.0);",
    "out.motion.linear = std::sqrt(2.0);",
    "std::vector<int> all;",
    "if (in.line.age > 1) return;",
    "if (in.line.age > 1s) return;",
    "out.motion.linear = speed;",
    "++count;",
    "if (in.line) return;",
    "double level = \"a\";",
    "Velocty wanted;",
    "out.motion.linear = 1",
    "context.log(\"level {}\");",
    "context.log(\"line {}\", in.line);",
    "follow(context, in, out);",
    "return 3;",
    "out.motion.linear = context.parameters.speed.value;",
    "hlper(3);",
    "memory.count = 1\n  const double speed = double{context.parameters.speed};\n  out.motion = {speed, 0};",
    "if (in.line.left) {\n    const double speed = 1;\n  }\n  out.motion.linear = speed;",
    "if (in.line.left) {",
});

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

class CppErrors : public Folder {
 protected:
  struct Case {
    std::string title, file, text;
  };

  /// Generates the controller, with that condition, and compiles its headers once.
  void prepare(const std::string& condition) {
    write("project/spec.yaml", with(specification, "FOLLOWED", condition));
    write("project/src/control.cpp", function);
    verified_ = project::run_pipeline(folder_ / "project", {}, said_);
    ASSERT_TRUE(verified_.has_value()) << said_.all;
    generated_ = project::generate(*verified_);
    const project::Exit done = shell(compiler() + " -x c++-header " + header() + " -o " + header() + ".gch");
    ASSERT_EQ(done.code, 0) << done.text;
  }

  [[nodiscard]] std::string header() const { return (generated_.folder / "robot/control.hpp").string(); }
  [[nodiscard]] std::string compiler() const {
    const std::string project = (folder_ / "project").string(), source = TESSERA_SOURCE_DIR;
    return "LC_ALL=C.UTF-8 g++ -std=c++20 -DFMT_SHARED -Wall -Wextra -Wno-unused-parameter -I" +
           generated_.folder.string() + " -I" + project + "/src -I" + source + "/runtime/include -I" +
           source + "/recording/include -I" + source + "/vocabulary/include";
  }
  static project::Exit shell(const std::string& line) { return project::capture({"sh", "-c", line}); }

  /// The messages about that output, with this folder as FOLDER.
  [[nodiscard]] std::string explained(const std::string& output) const {
    const project::TransitionFunctions functions(folder_ / "project", generated_.functions->wanted());
    std::string text = project::explain_build(
        output, {verified_->specification, functions, generated_.source_lines, "compiler.log"});
    for (std::size_t at = text.find(folder_.string()); at != std::string::npos;
         at = text.find(folder_.string()))
      text.replace(at, folder_.string().size(), "FOLDER");
    return text;
  }

  /// Two compilers at a time.
  std::string explained(const std::vector<Case>& cases) const {
    std::string names;
    for (std::size_t at = 0; at < cases.size(); ++at) {
      const fs::path file = fs::path("project/src") / ("case" + std::to_string(at) + ".cpp");
      write(file, cases[at].text);
      names += (folder_ / file).string() + "\n";
    }
    write("names.txt", names);
    shell("xargs -P2 -I@ sh -c '" + compiler() + " -fsyntax-only @ >@.said 2>&1' <" +
          (folder_ / "names.txt").string());
    std::string all;
    for (std::size_t at = 0; at < cases.size(); ++at) {
      const fs::path file = folder_ / "project/src" / ("case" + std::to_string(at) + ".cpp");
      std::string said = content_of(file.string() + ".said");
      EXPECT_NE(said, "") << cases[at].title;
      const std::string text = explained(said);
      EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 24) << text;
      all += "=== " + cases[at].title + "\n" + with(text, "case" + std::to_string(at), "control");
    }
    for (std::size_t at = 0; at < cases.size(); ++at)
      fs::remove(folder_ / "project/src" / ("case" + std::to_string(at) + ".cpp"));
    return all;
  }

  Said said_;
  std::optional<project::Verified> verified_;
  project::Generated generated_;
};

void expect_golden(const std::string& name, const std::string& text) {
  const fs::path file = fs::path(TESSERA_SOURCE_DIR) / "tests/golden/build" / name;
  if (std::getenv("TESSERA_UPDATE_GOLDEN") != nullptr) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
  }
  EXPECT_EQ(text, content_of(file));
}

TEST_F(CppErrors, InTransitionFunctions) {
  prepare("in.line.left");
  std::vector<Case> cases;
  for (const char* statement : statements)
    cases.push_back({statement, "", with(function, "HERE", statement)});
  const std::string usual = with(function, "HERE", "");
  const auto changed = [&](const char* title, const char* from, const char* to) {
    cases.push_back({title, "", with(usual, from, to)});
  };
  changed("another result", "void follow", "int follow");
  changed("another namespace", "rover::robot::control {", "rover::robot::contrl {");
  changed("a header that is not there", "#include", "#include \"steering.hpp\"\n#include");
  changed("no header", "#include \"robot/control.hpp\"", "");
  expect_golden("functions.expected", explained(cases));
}

/// A mistake in a condition that only the compiler finds.
TEST_F(CppErrors, InConditions) {
  prepare("{ a: std::abss(in.level) > 1, b: memory.count.value() > 1, c: \"memory.count > nearest(3)\" }");
  const project::Exit done = shell(compiler() + " -Werror -fsyntax-only " +
                                   (generated_.folder / "robot.control.conditions.cpp").string());
  expect_golden("conditions.expected", explained(done.text));
}

TEST_F(CppErrors, InDrivers) {
  prepare("in.line.left");
  const std::string system = (generated_.folder / "system.drivers.cpp").string();
  const auto said = [&](const std::string& title) {
    return "=== " + title + "\n" + explained(shell(compiler() + " -fsyntax-only " + system).text);
  };
  std::string all = said("no drivers.hpp");
  const auto try_it = [&](const char* title, const char* from, const char* to) {
    write("project/src/drivers.hpp", with(drivers, from, to));
    all += said(title);
  };
  try_it("no such class", "class Eye", "class Eyes");
  try_it("no read", "std::optional<double> read() override { return 0.5; }", "");
  try_it("another result", "std::optional<double> read", "double read");
  try_it("another type", "tessera::Receptor<double>", "tessera::Receptor<int>");
  try_it("no base", ": public tessera::Effector<double>", "");
  try_it("a constructor with a number", " public:\n  bool", " public:\n  explicit Wheel(int pin);\n  bool");
  expect_golden("drivers.expected", all);
}

TEST_F(CppErrors, OfCMake) {
  write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.25)\nproject(any LANGUAGES CXX)\n");
  const project::Exit done = shell("LC_ALL=C.UTF-8 cmake -G Ninja -DCMAKE_CXX_COMPILER=/nowhere/c++ -S " +
                                   folder_.string() + " -B " + (folder_ / "build").string());
  EXPECT_NE(done.code, 0);
  const std::string text = project::explain_configuration(done.text, "compiler.log");
  EXPECT_TRUE(text.starts_with("error E510: CMake could not prepare the build\n")) << text;
  EXPECT_NE(text.find("/nowhere/c++"), std::string::npos) << text;
  EXPECT_NE(text.find("hint: install a compiler of C++20: apt install g++\n"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("the whole output of CMake: compiler.log\n")) << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 24) << text;
}

/// Mistakes in a user's project.cmake: CMake has them at their line, and compiler and linker say what they refuse.
TEST_F(CppErrors, OfTheUsersCMake) {
  prepare("in.line.left");
  const std::string user_file = (folder_ / "project/project.cmake").string();
  write("project/.tessera/generated/CMakeLists.txt",
        "cmake_minimum_required(VERSION 3.25)\nproject(any LANGUAGES NONE)\nadd_library(project "
        "INTERFACE)\ninclude(" +
            user_file + ")\n");
  write("project/main.cpp", "int main() {}\n");
  std::string all;
  const auto tell = [&](const std::string& lines, const std::string& said) {
    EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 24) << said;
    all += "=== " + lines + "\n" + said;
  };
  const std::string in_project = "cd " + (folder_ / "project").string() + " && LC_ALL=C.UTF-8 ";
  for (const char* lines :
       {"target_link_librares(project INTERFACE m)", "tell_me(project)", "find_package(Eigen33 REQUIRED)",
        "target_link_libraries(project INTERFACE m", "target_link_libraries(projct INTERFACE m)",
        "include(${CMAKE_CURRENT_LIST_DIR}/more.cmake)", "target_link_libraries(project PRIVATE m)"}) {
    write("project/project.cmake", "# libraries\n" + std::string(lines) + "\n");
    const project::Exit done = shell(in_project + "cmake -S .tessera/generated -B build");
    EXPECT_NE(done.code, 0) << lines;
    std::string said = project::explain_cmake_errors(done.text, folder_ / "project");
    for (std::size_t at = said.find(folder_.string()); at != std::string::npos;
         at = said.find(folder_.string()))
      said.replace(at, folder_.string().size(), "FOLDER");
    tell(lines, said);
  }
  const struct {
    const char *lines, *flags;
  } refused[]{
      {"target_link_libraries(project INTERFACE nolib)", "-lnolib"},
      {"target_link_options(project INTERFACE -Wl,--fooo)", "-Wl,--fooo"},
      {"target_compile_options(project INTERFACE -Wall -Wshadw)", "-Wall -Wshadw"},
  };
  for (const auto& one : refused) {
    write("project/project.cmake", "# libraries\n" + std::string(one.lines) + "\n");
    // As often as a build has sources.
    const std::string compile = "g++ -o main main.cpp " + std::string(one.flags);
    const project::Exit done = shell(in_project + "sh -c '" + compile + "; " + compile + "'");
    EXPECT_NE(done.code, 0) << one.lines;
    tell(one.lines, explained(done.text));
  }
  write("project/project.cmake", "target_link_libraries(project INTERFACE /nowhere/libx.a)\n");
  tell("a file that is not there",
       explained(
           "ninja: error: '/nowhere/libx.a', needed by 'rover', missing and no known rule to make it\n"));
  fs::remove(folder_ / "project/project.cmake");
  EXPECT_TRUE(
      explained("/usr/bin/ld: cannot find -lnolib\n").starts_with("/usr/bin/ld: cannot find -lnolib\n"));
  expect_golden("cmake.expected", all);
}

/// Other parameters make another function, which only the linker notices.
TEST_F(CppErrors, OfTheLinker) {
  prepare("in.line.left");
  const struct {
    const char *from, *to, *found;
  } cases[]{
      {", Memory& memory", "", "void follow(Context& context, const Inputs& in, Outputs& out)"},
      {"Context& context, ", "Context context,\n  ",
       "void follow(Context context, const Inputs& in, Memory& memory, Outputs& out)"},
      {"const Inputs& in", "Inputs in",
       "void follow(Context& context, Inputs in, Memory& memory, Outputs& out)"},
  };
  for (const auto& one : cases) {
    write("project/src/control.cpp", with(with(function, "HERE", ""), one.from, one.to));
    EXPECT_EQ(
        explained("/usr/bin/ld: system.a(robot.control.cpp.o): in function `x':\nundefined reference to "
                  "`rover::robot::control::follow(rover::robot::control::Context&)'\n"
                  "collect2: error: ld returned 1 exit status\n"),
        "src/control.cpp:5: error E507: the function 'follow' of robot.control has other parameters\n"
        "found:  " +
            std::string(one.found) +
            "\nwanted: void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out)\n"
            "the whole output of the compiler: compiler.log\n");
  }
}

}  // namespace
}  // namespace tessera::project_test
