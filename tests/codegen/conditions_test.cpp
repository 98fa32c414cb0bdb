#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <string>

#include "../environment.hpp"
#include "generated.hpp"
#include "spec/legal_conditions.hpp"
#include "verify_circuits/naive_endings.hpp"

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

/// The messages of g++ about the subsystems of a robot. stage: "-S -o /dev/null" also finds unused functions.
Ran compile(const std::string& spec, const std::string& stage = "-fsyntax-only",
            const std::string& sources = "robot.control.conditions.cpp") {
  const Folder folder;
  folder.write("spec.yaml", spec);
  folder.write(generate(spec, (folder.path() / "spec.yaml").string()).files);
  return run("cd " + folder.path().string() +
             " && LC_ALL=C " TESSERA_CXX
             " -std=c++20 -Wall -Wextra -Wpedantic -Wconversion -Wno-parentheses -Werror -I. "
             "-I" TESSERA_RUNTIME_HEADERS " " +
             stage + " " + sources);
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

constexpr std::array<Mistake, 4> mistakes{{
    {"memory.count > 3", "std::cont > 3", "spec.yaml:10:34: error:", "std::cont > 3"},
    {"'memory.count < 0'", "'memory.count < '", "spec.yaml:11:36: error:", "memory.count < '"},
    {"memory.count == 4", "four(memory.count)", "spec.yaml:14:33: error:", "four(memory.count)"},
    {"memory.count > 9", "memory.count() > 9", "spec.yaml:10:67: error:", "memory.count() > 9"},
}};

TEST(Conditions, AMistakeNamesTheLineAndColumnOfTheSpecification) {
  for (const Mistake& mistake : share_of(mistakes)) {
    SCOPED_TRACE(mistake.wrong);
    const Ran ran = compile(replaced(lonely, mistake.right, mistake.wrong));
    EXPECT_NE(ran.exit_code, 0);
    EXPECT_THAT(ran.output, HasSubstr(mistake.line_and_column));
    EXPECT_THAT(ran.output, HasSubstr(mistake.source)) << "the compiler quotes the specification";
  }
}

TEST(Conditions, OfABlockTextKeepTheirLines) {
  const std::string block =
      "\n            done: |\n              memory.count > 3 &&\n                std::cont > 5\n           "
      " tired: memory.count > 9";
  const Ran ran = compile(replaced(lonely, "{ done: memory.count > 3, tired: \"memory.count > 9\" }", block));
  EXPECT_THAT(ran.output, HasSubstr("spec.yaml:13:22: error:"));
}

/// Lines::listed: messages about these lines lead to the same text in the specification.
TEST(Conditions, ListedLinesHaveTheTextOfTheSpecification) {
  const std::string block =
      "\n            done: |\n              memory.count > 3 &&\n                memory.count > 5\n          "
      " "
      " tired: memory.count > 9";
  const std::string spec = replaced(lonely, "{ done: memory.count > 3, tired: \"memory.count > 9\" }", block);
  const auto line_of = [](const std::string& text, std::uint32_t number) {
    std::istringstream lines(text);
    std::string line;
    for (std::uint32_t at = 0; at < number; ++at) std::getline(lines, line);
    return line;
  };
  std::size_t listed = 0;
  for (const codegen::File& file : generate(spec, "spec.yaml", codegen::Lines::listed).files)
    for (const codegen::SourceLine& line : file.lines) {
      std::string text = line_of(file.text, line.line);
      text.resize(std::min(text.find("); }"), text.size()));
      EXPECT_EQ(line_of(spec, line.spec_line).substr(line.column - 1, text.size()), text);
      EXPECT_NE(text, "");
      ++listed;
    }
  EXPECT_EQ(listed, 5U);
}

/// The compiler accepts everything that `check` accepts: durations with a blank, elapsed, index.
TEST(Conditions, ThatAreLegalCompile) {
  std::string terminal = "{";
  for (std::size_t at = 0; at < legal_conditions.size(); ++at)
    terminal += (at == 0 ? " c" : ", c") + std::to_string(at) + ": " + in_quotes(legal_conditions[at]);
  const std::string spec = with_terminal(terminal + " }");
  const Ran ran = compile(spec, "-fsyntax-only -Wno-conversion -Wno-sign-compare");
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(generate(spec)["robot.control.cpp"],
              HasSubstr("conditions_{in, out, memory, parameters, context_.in_behaviour, context_.index};"));
}

TEST(Conditions, ErrorIsAskedBeforeTerminalAndNamedOnesAreRemembered) {
  const Generated generated = generate(lonely);
  const std::string& source = generated["robot.control.cpp"];
  EXPECT_THAT(source,
              HasSubstr(R"(        if (conditions_.tessera_work_error()) return tessera::Outcome::error;
        held_.tessera_work_terminal_tired = conditions_.tessera_work_terminal_tired();
        if (conditions_.tessera_work_terminal_done()) return tessera::Outcome::terminal;
        if (held_.tessera_work_terminal_tired) return tessera::Outcome::terminal;
        return tessera::Outcome::go_on;
)"));
  EXPECT_THAT(source, HasSubstr(R"(        if (failed) return 3;                             // end
        if (held_.tessera_work_terminal_tired) return 0;  // work
        if (conditions_.tessera_work_next_2()) return 1;  // end
        return 2;                                         // work
)"));
}

std::string condition_text(const spec::Condition& condition) {
  if (condition.kind != spec::Condition::Kind::expressions)
    return condition.kind == spec::Condition::Kind::always ? "true" : "false";
  std::string text;
  for (const spec::Expression& one : condition.expressions)
    text += (text.empty() ? "{ " : ", ") + one.name + ": " + one.text;
  return text + " }";
}

std::string when_text(const spec::When& when, const spec::Behaviour& behaviour) {
  switch (when.kind) {
    case spec::When::Kind::always:
      return "";
    case spec::When::Kind::never:
      return ", when: false";
    case spec::When::Kind::error:
      return ", when: error";
    case spec::When::Kind::terminal:
      return ", when: " + behaviour.terminal.expressions[when.expression].name;
    case spec::When::Kind::named_error:
      return ", when: " + behaviour.error.expressions[when.expression].name;
    case spec::When::Kind::expression:
      return ", when: memory.c";
  }
  return "";
}

/// One that ends and leads on as drawn.
std::string behaviour_text(std::uint32_t number, std::uint32_t of, std::uint64_t seed) {
  spec::Behaviour behaviour;
  draw_endings(behaviour, of, seed);
  std::string text = "b" + std::to_string(number) + ": { terminal: " + condition_text(behaviour.terminal) +
                     ", error: " + condition_text(behaviour.error) + ", next: [";
  for (const spec::Next& next : behaviour.next)
    text += std::string(&next == &behaviour.next.front() ? "" : ", ") +
            "{ to: " + (next.behaviour.valid() ? "b" + std::to_string(next.behaviour.value) : "end") +
            when_text(next.when, behaviour) + " }";
  return text + "] }\n";
}

TEST(Conditions, OfAnyKindCompileWithoutWarnings) {
  constexpr auto many = static_cast<std::uint32_t>(share_of(60)),
                 alone = static_cast<std::uint32_t>(share_of(4));
  std::string spec =
      "tessera: 1\nsystem: s\nagents:\n  robot:\n    control:\n      rate: 10 Hz\n"
      "      memory: { a: bool, b: bool, c: bool }\n      behaviours:\n";
  for (std::uint32_t number = 0; number < many; ++number)
    spec += "        " + behaviour_text(number, many, number);
  spec += "    receptors:\n";
  for (std::uint32_t number = 0; number < alone; ++number)
    spec += "      r" + std::to_string(number) +
            ":\n        rate: 10 Hz\n        memory: { a: bool, b: bool, c: bool }\n        behaviours:\n" +
            "          " + behaviour_text(0, 1, 1000 + number);
  const Ran ran = compile(spec, "-S", "robot.control.cpp robot.control.conditions.cpp");
  EXPECT_EQ(ran.exit_code, 0) << ran.output.substr(0, 4000);
  for (std::uint32_t number = 0; number < alone; ++number) {
    const std::string name = "robot.r" + std::to_string(number);
    const Ran one = compile(spec, "-S", name + ".cpp " + name + ".conditions.cpp");
    EXPECT_EQ(one.exit_code, 0) << one.output.substr(0, 4000);
  }
}

TEST(Conditions, ThatAreNeverAskedAreNotEmitted) {
  const std::string spec = R"(tessera: 1
system: s
agents:
  robot:
    control:
      rate: 10 Hz
      memory: { m: bool, n: bool }
      behaviours:
        a: { terminal: true, next: [b, { to: a, when: memory.m }] }
        b: { error: true, terminal: { t: memory.n }, next: [{ to: b, when: t }, { to: a, when: error }] }
)";
  const Ran ran = compile(spec, "-S", "robot.control.cpp");
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  for (const codegen::File& file : generate(spec).files) {
    EXPECT_THAT(file.text, testing::Not(HasSubstr("a_next_2"))) << file.path;
    EXPECT_THAT(file.path, testing::Not(HasSubstr("conditions")));
  }
}

TEST(Conditions, OnTheFirstLineOfASpecificationHaveALineToo) {
  const std::string spec =
      "{tessera: 1, system: lonely, agents: {robot: {control: {rate: 9 Hz, memory: {n: int8}, "
      "behaviours: {work: {terminal: std::m > 3}}}}}}\n";
  EXPECT_THAT(compile(spec).output, HasSubstr("spec.yaml:1:123: error:"));
}

TEST(Conditions, OfAnIncludedFileHaveItsLines) {
  const Folder project;
  project.write("parts/robot.yaml", R"(templates:
  robot:
    control:
      rate: 10 Hz
      memory: { count: int32 }
      behaviours: { work: { terminal: memory.count > 3, next: work } }
)");
  const std::string spec =
      "tessera: 1\nsystem: demo\ninclude: parts/robot.yaml\nagents: { a: { use: robot } }\n";
  const std::string path = (project.path() / "spec.yaml").string();
  const Generated marked = generate(spec, path);
  EXPECT_THAT(marked["robot.control.conditions.cpp"],
              HasSubstr("#line 5 \"" + (project.path() / "parts/robot.yaml").string() + "\"\n"));
  const Generated listed = generate(spec, path, codegen::Lines::listed);
  for (const codegen::File& file : listed.files)
    for (const codegen::SourceLine& line : file.lines)
      EXPECT_EQ(listed.model.sources.included_line(line.spec_line), "parts/robot.yaml:6") << file.path;
}

TEST(Conditions, PathsOfSpecificationsAreEscaped) {
  const Generated generated = generate(lonely, "/tmp/a \"strange\" \\ name/spec.yaml");
  EXPECT_THAT(generated["robot.control.conditions.cpp"],
              HasSubstr("#line 9 \"/tmp/a \\\"strange\\\" \\\\ name/spec.yaml\"\n"));
}

}  // namespace
}  // namespace tessera::test
