// A robot in a general world, from its specification to a recording.

#include <gmock/gmock.h>

#include "command.hpp"

namespace tessera::cli_test {
namespace {

using ::testing::HasSubstr;

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

}  // namespace
}  // namespace tessera::cli_test
