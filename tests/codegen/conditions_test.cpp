#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "generated.hpp"

namespace tessera::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* lonely = R"(tessera: 1
system: lonely
agents:
  robot:
    control:
      rate: 10 Hz
      memory: { count: int32 }
      behaviours:
        work:
          terminal: { done: memory.count > 3, tired: "memory.count > 9" }
          error:    'memory.count < 0'
          next:
            - { to: work, when: tired }
            - { to: end,  when: memory.count == 4 }
            - work
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

/// What g++ says about the only subsystem of a specification.
Ran compile(const std::string& spec) {
  const Folder folder;
  folder.write("spec.yaml", spec);
  folder.write(generate(spec, (folder.path() / "spec.yaml").string()).files);
  return run(
      "cd " + folder.path().string() +
      " && LC_ALL=C " TESSERA_CXX
      " -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wconversion -Werror -I. -I" TESSERA_RUNTIME_HEADERS
      " robot.control.cpp");
}

TEST(Conditions, OfAGoodSpecificationCompile) {
  const Ran ran = compile(lonely);
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
}

struct Mistake {
  const char* right;
  const char* wrong;
  const char* line_and_column;
  const char* source;
};

const Mistake mistakes[] = {
    {"memory.count > 3", "memory.cont > 3", "spec.yaml:10:36: error:", "memory.cont > 3"},
    {"'memory.count < 0'", "'memory.count < '", "spec.yaml:11:36: error:", "memory.count < '"},
    {"memory.count == 4", "memory.count = 4", "spec.yaml:14:46: error:", "memory.count = 4"},
    {"memory.count > 9", "parameters.count > 9", "spec.yaml:10:66: error:", "parameters.count > 9"},
};

TEST(Conditions, AMistakeNamesTheLineAndColumnOfTheSpecification) {
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.wrong);
    const Ran ran = compile(replaced(lonely, mistake.right, mistake.wrong));
    EXPECT_NE(ran.exit_code, 0);
    EXPECT_THAT(ran.output, HasSubstr(mistake.line_and_column));
    EXPECT_THAT(ran.output, HasSubstr(mistake.source)) << "the compiler quotes the specification";
  }
}

TEST(Conditions, OfABlockTextKeepTheirLines) {
  const std::string block =
      "\n            done: |\n              memory.count > 3 &&\n                memory.cont > 5\n           "
      " tired: memory.count > 9";
  const Ran ran = compile(replaced(lonely, "{ done: memory.count > 3, tired: \"memory.count > 9\" }", block));
  EXPECT_THAT(ran.output, HasSubstr("spec.yaml:13:24: error:"));
}

TEST(Conditions, ErrorIsAskedBeforeTerminalAndNamedOnesAreRemembered) {
  const Generated generated = generate(lonely);
  const std::string& source = generated["robot.control.cpp"];
  EXPECT_THAT(source, HasSubstr(R"(        if (work_error()) return tessera::Outcome::error;
        held_.work_terminal_tired = work_terminal_tired();
        if (work_terminal_done()) return tessera::Outcome::terminal;
        if (held_.work_terminal_tired) return tessera::Outcome::terminal;
        return tessera::Outcome::go_on;
)"));
  EXPECT_THAT(source, HasSubstr(R"(        if (!failed && held_.work_terminal_tired) return 0;  // work
        if (work_next_2()) return 1;                         // end
        return 2;                                            // work
)"));
}

TEST(Conditions, OnTheFirstLineOfASpecificationHaveALineToo) {
  const std::string spec =
      "{tessera: 1, system: lonely, agents: {robot: {control: {rate: 9 Hz, memory: {n: int8}, "
      "behaviours: {work: {terminal: memory.m > 3}}}}}}\n";
  EXPECT_THAT(compile(spec).output, HasSubstr("spec.yaml:1:125: error:"));
}

TEST(Conditions, PathsOfSpecificationsAreEscaped) {
  const Generated generated = generate(lonely, "/tmp/a \"strange\" \\ name/spec.yaml");
  EXPECT_THAT(generated["robot.control.cpp"],
              HasSubstr("#line 9 \"/tmp/a \\\"strange\\\" \\\\ name/spec.yaml\"\n"));
}

}  // namespace
}  // namespace tessera::test
