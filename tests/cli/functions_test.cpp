// The positions of the user's functions, and the messages about missing ones.

#include "command.hpp"

namespace tessera::cli_test {

using Functions = Command;

TEST_F(Functions, MayStandInAnySourceAndNothingIsWrittenForThem) {
  ASSERT_EQ(tessera("new rover").code, 0);
  const fs::path src = folder_ / "rover/src";
  fs::rename(src / "motor.cpp", src / "wheels.cc");
  const nlohmann::json run = json("simulate rover --for 20s");
  EXPECT_GT(run.at("laps"), 0.2);
  EXPECT_FALSE(fs::exists(src / "motor.cpp"));

  // Twice: the linker's message, in terms of the project.
  fs::copy_file(src / "wheels.cc", src / "motor.cpp");
  const project::Exit twice = tessera("simulate rover --for 1s");
  EXPECT_EQ(twice.code, 1);
  EXPECT_NE(twice.text.find("the function 'drive' of robot.motor is defined more than once"),
            std::string::npos)
      << twice.text;
  EXPECT_NE(twice.text.find("src/wheels.cc:"), std::string::npos) << twice.text;
  EXPECT_NE(twice.text.find("src/motor.cpp:"), std::string::npos) << twice.text;
  EXPECT_EQ(twice.text.find("multiple definition"), std::string::npos) << twice.text;
  fs::remove(src / "motor.cpp");

  // In a namespace that belongs to no subsystem.
  replace(src / "wheels.cc", "namespace rover::robot::motor {", "namespace rover::car::motor {");
  const project::Exit moved = tessera("simulate rover --for 1s");
  EXPECT_EQ(moved.code, 1);
  EXPECT_NE(moved.text.find("belongs in the namespace rover::robot::motor"), std::string::npos) << moved.text;
  replace(src / "wheels.cc", "namespace rover::car::motor {", "namespace rover::robot::motor {");

  // A macro makes it: only the compiler can see that.
  std::string text = content_of(src / "wheels.cc");
  const std::size_t begin = text.find("void drive(");
  write(src / "wheels.cc",
        "#define BEHAVIOUR(name) void name(Context& context, const Inputs& in, Memory& memory, Outputs& "
        "out)\n" +
            text.replace(begin, text.find(')', begin) + 1 - begin, "BEHAVIOUR(drive)"));
  EXPECT_EQ(tessera("generate rover").code, 0);
  const project::Exit made = tessera("simulate rover --for 1s");
  EXPECT_EQ(made.code, 0) << made.text;

  // Not there at all.
  fs::remove(src / "wheels.cc");
  const project::Exit missing = tessera("simulate rover --for 1s");
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.text.find("src/motor.cpp: error: robot.motor has no function 'drive'"), std::string::npos)
      << missing.text;
  EXPECT_NE(missing.text.find("namespace rover::robot::motor {"), std::string::npos) << missing.text;
  EXPECT_FALSE(fs::exists(src / "motor.cpp"));
}

TEST_F(Functions, ASecondAgentLeavesThoseOfTheFirstWhereTheyAre) {
  ASSERT_EQ(tessera("new rover").code, 0);
  replace(folder_ / "rover/spec.yaml", "agents:\n",
          "agents:\n  watcher: { control: { rate: 1 Hz, behaviours: { look: {} } } }\n");
  const project::Exit missing = tessera("simulate rover --for 1s");
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.text.find("src/watcher/control.cpp: error: watcher.control has no function 'look'"),
            std::string::npos)
      << missing.text;
  EXPECT_EQ(missing.text.find("follow"), std::string::npos) << missing.text;
  const std::string before = content_of(folder_ / "rover/src/control.cpp");
  ASSERT_EQ(tessera("generate rover --stubs").code, 0);
  EXPECT_EQ(content_of(folder_ / "rover/src/control.cpp"), before);
  EXPECT_FALSE(fs::exists(folder_ / "rover/src/robot"));
  EXPECT_GT(json("simulate rover --for 20s").at("laps"), 0.2);
}

}  // namespace tessera::cli_test
