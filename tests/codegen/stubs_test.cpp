#include <gtest/gtest.h>

#include <set>
#include <string>

#include "generated.hpp"

namespace tessera::test {
namespace {

TEST(Stubs, OnePerBehaviourInTheFileOfItsSubsystem) {
  const std::vector<codegen::Stub> stubs = codegen::stubs(generate_file(line_follower_spec).model);
  ASSERT_EQ(stubs.size(), 4U);
  const codegen::Stub& follow = stubs[1];
  EXPECT_EQ(follow.file, "src/control.cpp");
  EXPECT_EQ(follow.function, "follow");
  EXPECT_EQ(follow.subsystem, "robot.control");
  EXPECT_EQ(follow.space, "line_follower::robot::control");
  EXPECT_EQ(follow.signature,
            "void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out)");
  EXPECT_EQ(follow.preamble, "#include \"robot/control.hpp\"\n\nnamespace line_follower::robot::control {\n");
  EXPECT_EQ(follow.body,
            "/// Behaviour follow of robot.control.\n/// Reads in.line.\n/// Writes out.motion.\n"
            "void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}\n");
  EXPECT_EQ(follow.closing, "}  // namespace line_follower::robot::control\n");
}

TEST(Stubs, OfSeveralDefinitionsStandInFoldersOfTheirOwn) {
  std::set<std::string> files;
  for (const codegen::Stub& stub : codegen::stubs(generate_file(features_spec).model))
    files.insert(stub.file);
  EXPECT_EQ(files, (std::set<std::string>{"src/base/arm.cpp", "src/base/control.cpp", "src/base/lidar.cpp",
                                          "src/courier/control.cpp", "src/office/control.cpp",
                                          "src/scout/control.cpp", "src/walker/control.cpp"}));
}

TEST(Stubs, NameOnlyTheBuffersThatTheBehaviourReceivesAndSends) {
  const Generated generated = generate(R"(
tessera: 1
system: depot
agents:
  robot:
    control:
      rate: 10 Hz
      inputs: { grant: bool, pose: float64 }
      outputs: { request: bool, motion: float64 }
      behaviours:
        ask: { receive: [grant, pose], send: [request], terminal: true, next: wait }
        wait: { receive: [], send: [], terminal: true, next: all }
        all: {}
    receptors:
      eye:
        rate: 10 Hz
        real: { raw: float64 }
        inputs: { motion: float64 }
        outputs: { pose: float64 }
        behaviours: { look: { receive: [] } }
    effectors:
      wheels:
        rate: 10 Hz
        stale: never
        inputs: { motion: float64 }
        outputs: { done: float64 }
        real: { left: float64 }
        behaviours: { drive: { send: [] } }
channels:
  - robot.control.request -> robot.control.grant
  - robot.eye.pose -> robot.control.pose
  - robot.control.motion -> robot.eye.motion
  - robot.control.motion -> robot.wheels.motion
)");
  std::string bodies;
  for (const codegen::Stub& stub : codegen::stubs(generated.model))
    bodies += stub.body.substr(0, stub.body.find("void "));
  EXPECT_EQ(bodies,
            "/// Behaviour ask of robot.control.\n/// Reads in.grant, in.pose.\n/// Writes out.request.\n"
            "/// Behaviour wait of robot.control.\n"
            "/// Behaviour all of robot.control.\n/// Reads in.grant, in.pose.\n"
            "/// Writes out.request, out.motion.\n"
            "/// Behaviour look of robot.eye.\n/// Reads in.raw.\n/// Writes out.pose.\n"
            "/// Behaviour drive of robot.wheels.\n/// Reads in.motion.\n/// Writes out.left.\n");
}

TEST(Stubs, CompileAsTheyAreWritten) {
  const Generated generated = generate_file(line_follower_spec);
  const Folder folder;
  folder.write(generated.files);
  std::string text, closing;
  for (const codegen::Stub& stub : codegen::stubs(generated.model)) {
    if (stub.file != "src/control.cpp") continue;
    text += (text.empty() ? stub.preamble : "") + '\n' + stub.body;
    closing = stub.closing;
  }
  folder.write("stubs.cpp", text + '\n' + closing);
  const Ran ran = run("cd " + folder.path().string() +
                      " && " TESSERA_CXX
                      " -std=c++20 -fsyntax-only -Wall -Wextra -Wno-unused-parameter -Werror -I. "
                      "-I" TESSERA_RUNTIME_HEADERS " stubs.cpp && clang-format --dry-run -Werror stubs.cpp");
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
}

}  // namespace
}  // namespace tessera::test
