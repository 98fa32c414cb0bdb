// A robot in a general world, from its specification to a recording.

#include <gmock/gmock.h>

#include <cstdlib>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class World : public Command {
 protected:
  void SetUp() override {
    fs::copy(fs::path(TESSERA_SOURCE_DIR) / "tests/cli/arm", folder_ / "arm", fs::copy_options::recursive);
  }
  [[nodiscard]] std::string checked() const { return tessera("check arm").text; }
  [[nodiscard]] fs::path spec() const { return folder_ / "arm/spec.yaml"; }
};

TEST_F(World, IsAskedWhetherItHasTheDevices) {
  EXPECT_EQ(tessera("check arm").code, 0) << checked();
  replace(spec(), "{ sensor: gyro }", "{ sensor: giro }");
  EXPECT_THAT(checked(), HasSubstr("spec.yaml:34:35: error E311: the world has no sensor 'giro'"));
  EXPECT_THAT(checked(), HasSubstr("hint: did you mean 'gyro'? the world has: gyro"));
  replace(spec(), "{ sensor: giro }", "{ joint_position: yaw }");
  EXPECT_THAT(checked(), HasSubstr("joint 'yaw' gives 1 number, and the buffer is float32[3]"));
  replace(spec(), "outside: clamp", "outside: bounce");
  EXPECT_THAT(checked(), HasSubstr("spec.yaml:36:77: error E311: option 'outside' must be clamp or refuse"));
  replace(folder_ / "arm/arm.xml", "<worldbody>", "<world>");
  EXPECT_THAT(checked(), HasSubstr("error E312: the world cannot be opened: "));
}

TEST_F(World, RefusesTwoDriversOfOneActuator) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const fs::path inputs = fs::path(data) / "field/specs/two_writers";
  fs::create_directories(folder_ / "pair");
  fs::copy_file(inputs / "sim.yaml", folder_ / "pair/spec.yaml");
  fs::copy_file(inputs / "world.xml", folder_ / "pair/world.xml");
  const project::Exit checked = tessera("check pair");
  EXPECT_EQ(checked.code, 1);
  EXPECT_THAT(checked.text,
              HasSubstr("spec.yaml:14:40: error E319: actuator 'x' is driven by robot[0].base.command and by "
                        "robot[1].base.command"));
  EXPECT_THAT(checked.text, HasSubstr("hint: name another one for each agent, such as x{i}"));
  replace(folder_ / "pair/spec.yaml", "robot[*].base.command: { actuator: x }",
          "robot[0].base.command: { actuator: x }");
  EXPECT_THAT(tessera("check pair").text, Not(HasSubstr("E319")));
}

TEST_F(World, NamesWithControlCharactersDoNotReachTheTerminal) {
  replace(folder_ / "arm/arm.xml", "<camera name=\"eye\"", "<camera name=\"e&#27;[31me\"");
  const project::Exit listed = tessera("world arm/arm.xml");
  EXPECT_EQ(listed.code, 0) << listed.text;
  EXPECT_EQ(listed.text.find('\x1b'), std::string::npos) << listed.text;
  EXPECT_THAT(listed.text, HasSubstr("camera: \"e\\u001b[31me\"")) << "for a specification";
}

TEST_F(World, MissingDriversAreAllNamedBeforeAnythingIsBuilt) {
  replace(spec(), "    arm.joints.gyro:    { sensor: gyro }\n", "");
  replace(spec(), "    arm.joints.hand:    { cpp: Height, site: tip }\n", "");
  const project::Exit done = tessera("simulate arm --for 1s");
  EXPECT_EQ(done.code, 1);
  EXPECT_THAT(done.text, HasSubstr("the real buffer arm.joints.gyro has no simulated driver"));
  EXPECT_THAT(done.text, HasSubstr("the real buffer arm.joints.hand has no simulated driver"));
  EXPECT_FALSE(fs::exists(folder_ / "arm/.tessera/build"));
}

TEST_F(World, IsListedWithDriversForIt) {
  const project::Exit listed = tessera("world arm");
  EXPECT_EQ(listed.code, 0) << listed.text;
  for (const char* line : {"  gyro                     sensor          float64[3]\n",
                           "  yaw                      actuator        float64      -2.5 .. 2.5\n",
                           "  eye                      camera          uint8[9216]  width: 64, height: 48\n",
                           "    arm.cameras.eye: { camera: eye, width: 64, height: 48 }  # uint8[9216]\n",
                           "    arm.motors.yaw: { actuator: yaw }  # float64\n"})
    EXPECT_THAT(listed.text, HasSubstr(line));
  EXPECT_EQ(json("world arm/arm.xml").at("actuators").size(), 4U);
}

TEST_F(World, OfAnArmIsSimulatedWithTheSameBytesForTheSameSeed) {
  const auto summary = json("simulate arm --for 2s --record first.tsr");
  EXPECT_EQ(summary.at("ended"), "duration") << summary.dump(1);
  const project::Exit again = tessera("simulate arm --for 2s --record second.tsr");
  EXPECT_EQ(again.code, 0) << again.text;
  EXPECT_THAT(again.text, HasSubstr("reached"));
  EXPECT_EQ(content_of(folder_ / "first.tsr"), content_of(folder_ / "second.tsr"));
  const project::Exit other = tessera("simulate arm --for 2s --seed 2 --record other.tsr");
  EXPECT_NE(content_of(folder_ / "first.tsr"), content_of(folder_ / "other.tsr")) << "the noise of the gyro";
}

/// Films need libEGL and a renderer, which a machine may lack.
TEST_F(World, OfARunIsDrawnAsAFilm) {
  ASSERT_EQ(tessera("simulate arm --for 1s").code, 0);
  const std::string film = "replay arm/.tessera/last/recording.tsr --film ";
  const project::Exit made = tessera(film + "run.png --size 64x48");
  if (made.text.find("libEGL") != std::string::npos) GTEST_SKIP() << made.text;
  EXPECT_EQ(made.code, 0) << made.text;
  EXPECT_THAT(made.text, HasSubstr("run.png: 2"));
  EXPECT_EQ(content_of(folder_ / "run.png").substr(0, 4), "\x89PNG");
  EXPECT_EQ(tessera(film + "run.y4m --size 64x48 --speed 5 --camera eye").code, 0);
  EXPECT_THAT(content_of(folder_ / "run.y4m"), ::testing::StartsWith("YUV4MPEG2 W64 H48 F25:1"));
  const auto frame_bytes = 64 * 48 * 3 / 2 + 6;
  EXPECT_EQ(content_of(folder_ / "run.y4m").size() / static_cast<std::size_t>(frame_bytes), 6U)
      << "0.2 s with both ends";
  struct Case {
    const char* options;
    int code;
    const char* says;
  };
  write(folder_ / "mine.y4m", "my own words");
  for (const Case& wrong :
       {Case{"run.avi", 2, "it ends in .mp4, .webm, .gif, .png or .y4m"},
        Case{"run.png --size 64x47", 2, "two even numbers"}, Case{"run.png --speed 0", 2, "--speed"},
        Case{"run.png --camera eie", 1, "did you mean 'eye'?"},
        Case{"run.png --from 100", 1, "nothing of the recording"}, Case{"mine.y4m", 1, "is there already"},
        Case{"/dev/full/run.png", 1, "cannot write"}}) {
    const project::Exit refused = tessera(film + wrong.options);
    EXPECT_EQ(refused.code, wrong.code) << wrong.options << refused.text;
    EXPECT_THAT(refused.text, HasSubstr(wrong.says));
  }
  const project::Exit movie = tessera(film + "run.mp4 --size 64x48");
  if (movie.code == 0)
    EXPECT_THAT(content_of(folder_ / "run.mp4"), HasSubstr("ftyp"));
  else
    EXPECT_THAT(movie.text, HasSubstr("apt-get install ffmpeg"));
  fs::remove(folder_ / "arm/.tessera/last/simulation.json");
  EXPECT_THAT(tessera(film + "run.png").text, HasSubstr("--spec"));
  EXPECT_EQ(tessera(film + "run.png --size 64x48 --spec arm").code, 0);
  EXPECT_THAT(tessera(film + "run.png --check").text, HasSubstr("excludes"));
}

}  // namespace
}  // namespace tessera::cli_test
