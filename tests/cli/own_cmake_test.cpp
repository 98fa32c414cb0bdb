// Libraries of other people, and controllers in other people's CMake projects.
#include "command.hpp"

namespace tessera::cli_test {
namespace {

using OwnCMake = Command;

TEST_F(OwnCMake, AProjectLinksTheLibrariesThatItsFileNamesAndMistakesThereHaveALine) {
  const fs::path project = example("12_own_cmake");
  EXPECT_EQ(json("simulate 12_own_cmake --for 20s").at("ended"), "duration");
  // The filter sees the wall come near: the cart has stopped.
  const project::Exit wheel = tessera("replay 12_own_cmake --values=cart.motor.wheel");
  EXPECT_TRUE(wheel.text.ends_with("cart.motor.wheel = 0\n")) << wheel.text;
  const project::Exit tests = tessera("test 12_own_cmake");
  EXPECT_EQ(tests.code, 0) << tests.text;

  replace(project / "project.cmake", "find_package(Eigen3", "find_package(Eigen33");
  const project::Exit unknown = tessera("simulate 12_own_cmake --for 1s");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_NE(unknown.text.find("project.cmake:2:1: error E511: CMake refuses this command\n"
                              "    2 | find_package(Eigen33 3.3 REQUIRED NO_MODULE)\n"
                              "      | ^~~~~~~~~~~~\n"),
            std::string::npos)
      << unknown.text;
  EXPECT_NE(unknown.text.find("Eigen33Config.cmake"), std::string::npos) << unknown.text;
  replace(project / "project.cmake", "find_package(Eigen33", "find_package(Eigen3");
  replace(project / "project.cmake", "Eigen3::Eigen", "Eigen3::Eigne");
  const project::Exit typo = tessera("simulate 12_own_cmake --for 1s");
  EXPECT_NE(typo.text.find("project.cmake:3:1: error E511: CMake refuses this command\n"), std::string::npos)
      << typo.text;
  EXPECT_NE(typo.text.find("Eigen3::Eigne"), std::string::npos) << typo.text;

  // Without the file, the library is missing; nothing of the earlier configuration is left.
  fs::remove(project / "project.cmake");
  const project::Exit none = tessera("simulate 12_own_cmake --for 1s");
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.text.find("Eigen/Dense"), std::string::npos) << none.text;
}

TEST_F(OwnCMake, AControllerIsATargetOfAProjectThatFollowsItsSpecification) {
  const fs::path project = example("12_own_cmake");
  const std::string build = "cmake --build build 2>&1";
  const project::Exit made =
      shell("cmake -B build -S 12_own_cmake -G Ninja '-Dtessera_DIR=" TESSERA_BINARY_DIR
            "/lib/cmake/tessera' 2>&1 && " +
            build);
  ASSERT_EQ(made.code, 0) << made.text;
  const project::Exit run = shell("build/cart simulate --for 5s 2>&1");
  EXPECT_EQ(run.code, 0) << run.text;

  replace(project / "spec.yaml", "to: listen", "to: lissten");
  const project::Exit refused = shell(build);
  EXPECT_NE(refused.code, 0);
  EXPECT_NE(refused.text.find("error E101: unknown behaviour 'lissten'"), std::string::npos) << refused.text;
  replace(project / "spec.yaml", "to: lissten", "to: listen");

  // The functions may stand elsewhere.
  fs::rename(project / "src/motor.cpp", project / "wheels.cpp");
  const project::Exit missing = shell(build);
  EXPECT_NE(missing.text.find("cart.motor has no function 'drive'"), std::string::npos) << missing.text;
  replace(project / "CMakeLists.txt", "LIBRARIES",
          "SOURCES src/control.cpp src/ranger.cpp wheels.cpp LIBRARIES");
  const project::Exit elsewhere = shell(build);
  EXPECT_EQ(elsewhere.code, 0) << elsewhere.text;
}

}  // namespace
}  // namespace tessera::cli_test
