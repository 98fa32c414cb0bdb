#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "generated.hpp"

/// Outputs that iterations may skip.
namespace tessera::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string asking_spec = "tests/golden/spec/valid/send_conditions.yaml";

TEST(Sending, IsDecidedByConditionsOrByTheFunction) {
  const Generated generated = generate_file(source_folder / asking_spec);
  const std::string& data = generated["robot/control.data.hpp"];
  EXPECT_THAT(data, HasSubstr("  tessera::SkippableOutput<double> scan;\n"));
  EXPECT_THAT(data, HasSubstr("  tessera::Output<bool> request;\n")) << "its function cannot skip it";
  const std::string& source = generated["robot.control.cpp"];
  EXPECT_THAT(source, HasSubstr("tessera::asks(0, 0)"));
  EXPECT_THAT(source, HasSubstr("tessera::if_skips"));
  EXPECT_THAT(source, HasSubstr(R"(    if (behaviour == 0 && output == 1)  // drive, scan
      return tessera::Sending::by_function;
)"));
  EXPECT_THAT(generated["dock.control.cpp"], Not(HasSubstr("Sending")));
}

/// The sources compile, and only an output that some behaviour may skip has the function.
TEST(Sending, CompilesWithTheUsersCode) {
  const Folder folder;
  folder.write(generate_file(source_folder / asking_spec).files);
  const std::string function = R"(
void asking::robot::control::drive(Context&, const Inputs&, Memory&, Outputs& out) {
  out.scan = 1;
  out.)";
  const auto compiles = [&](const std::string& source) {
    return run("cd " + folder.path().string() +
               " && LC_ALL=C " TESSERA_CXX
               " -std=c++20 -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only -I. "
               "-I" TESSERA_RUNTIME_HEADERS " " +
               source);
  };
  folder.write("drive.cpp", "#include \"robot/control.hpp\"\n" + function + "scan.skip();\n}\n");
  folder.write("wrong.cpp", "#include \"robot/control.hpp\"\n" + function + "request.skip();\n}\n");
  for (const char* source : {"robot.control.cpp", "robot.control.conditions.cpp", "drive.cpp"}) {
    const Ran ran = compiles(source);
    EXPECT_EQ(ran.exit_code, 0) << source << "\n" << ran.output;
  }
  EXPECT_NE(compiles("wrong.cpp").exit_code, 0);
}

}  // namespace
}  // namespace tessera::test
