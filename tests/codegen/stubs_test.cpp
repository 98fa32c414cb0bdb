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
                                          "src/scout/control.cpp", "src/walker/control.cpp"}));
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
