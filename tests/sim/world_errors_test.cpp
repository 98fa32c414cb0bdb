#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "tessera/device.hpp"
#include "world_devices.hpp"
#include "world_library.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using ::testing::HasSubstr;

TEST(WorldErrors, SaysWhatItHasWhenAskedForWhatItHasNot) {
  const auto world = open({.world = line_world()});
  struct Case {
    DriverRequest request;
    bool receptor;
    std::string message;
  };
  for (const Case& c : {
           Case{{"a.b.c", "reflectance", {"eye_lef"}, {}},
                true,
                "a.b.c: the world has no site 'eye_lef'; did you mean 'eye_left'? the world has: eye_left, "
                "eye_middle, eye_right"},
           Case{{"a.b.c", "velocity", {"xyzzy"}, {}},
                false,
                "a.b.c: the world has no actuator 'xyzzy'; the world has: wheel_left, wheel_right"},
           Case{{"a.b.c", "reflectence", {"eye_left"}, {}},
                true,
                "a.b.c: the world has no receptor 'reflectence'; did you mean 'reflectance'? the world has: "
                "sensor, joint_position, joint_velocity, scan, pose, contact, camera, depth, labels, "
                "reflectance"},
           Case{{"a.b.c", "torque", {"wheel_left"}, {}},
                false,
                "a.b.c: the world has no effector 'torque'; the world has: actuator, velocity, weld, mocap, "
                "place, colour"},
           Case{{"a.b.c", "reflectance", {"eye_left"}, {{"nois", 1}}},
                true,
                "a.b.c: 'reflectance' has no option 'nois'; did you mean 'noise'? its options: noise, "
                "footprint"},
           Case{{"a.b.c", "reflectance", {"eye_left"}, {{"noise", -1}}},
                true,
                "a.b.c: option 'noise' must be a number from 0 up"},
           Case{{"a.b.c", "velocity", {"wheel_left"}, {{"gain", 1}}},
                false,
                "a.b.c: 'velocity' has no option 'gain'; its options: outside, wrap"},
       }) {
    std::string error;
    const DriverRequest request = request_for<double>(c.request);
    EXPECT_TRUE(c.receptor ? world->receptor(request, error) == nullptr
                           : world->effector(request, error) == nullptr);
    EXPECT_EQ(error, c.message);
  }
}

TEST(WorldErrors, SaysWhyItDoesNotOpen) {
  const std::string broken = file_with("broken.xml", "<mujoco><worldbody><body></mujoco>");
  const std::string unknown = file_with("unknown.xml", "<mujoco><worldbody><blob/></worldbody></mujoco>");
  const std::string fixed =
      file_with("fixed.xml", "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>");
  struct Case {
    WorldOptions options;
    std::string part;
  };
  for (const Case& c :
       {Case{{.world = "/nowhere/world.xml"}, "/nowhere/world.xml: "}, Case{{.world = broken}, "XML"},
        Case{{.world = unknown}, "blob"},
        Case{{.world = line_world(), .track = "/nowhere/track.png"}, "/nowhere/track.png"},
        Case{{.world = line_world(), .track = shipped_track("oval.png"), .metres_per_pixel = 0}, "positive"},
        Case{{.world = line_world(), .start_x_m = std::nan("")}, "finite"},
        Case{{.world = line_world(), .footprint_m = -1}, "footprint"},
        Case{{.world = fixed, .start_x_m = 1}, "free joint"}}) {
    std::string error;
    EXPECT_EQ(open_world(c.options, error), nullptr);
    EXPECT_THAT(error, HasSubstr(c.part));
  }
}

TEST(WorldErrors, ATraceThatCannotBeWrittenIsSaidAtTheEnd) {
  for (const std::string path : {"/nowhere/trace.csv", "/dev/full"}) {
    const auto world = open({.world = line_world(), .trace = path});
    world->advance_to(Time(2s));
    std::string error;
    EXPECT_FALSE(world->finish(error));
    EXPECT_THAT(error, HasSubstr(path));
  }
}

TEST(WorldErrors, AWheelRefusesWhatIsNotFinite) {
  const auto world = open({.world = line_world()});
  std::string error;
  const auto effector = world->effector(wheel_request, error);
  EXPECT_FALSE(write(*effector, std::nan("")));
  EXPECT_FALSE(write(*effector, -INFINITY));
  EXPECT_TRUE(write(*effector, 1));
}

/// A world whose physics fails once it runs.
void expect_failure(const std::string& mjcf, const std::string& part) {
  const auto world = open({.world = mjcf});
  std::string error;
  const auto receptor = world->receptor(request_for<double>({"a", "reflectance", {"s"}, {}}), error);
  ASSERT_NE(receptor, nullptr) << error;
  EXPECT_THROW(world->advance_to(Time(2s)), std::runtime_error);
  EXPECT_THROW(world->advance_to(Time(2s)), std::runtime_error) << "it stays so";
  EXPECT_FALSE(world->finish(error));
  EXPECT_THAT(error, HasSubstr("the physics failed at"));
  EXPECT_THAT(error, HasSubstr(part));
  std::array<std::byte, 8> value{};
  EXPECT_THROW(static_cast<void>(receptor->read(value)), std::runtime_error);
}

TEST(WorldErrors, AnUnstableSimulationIsAnError) {
  expect_failure(
      file_with("unstable.xml", R"(<mujoco><option timestep="0.05"/><worldbody><body><site name="s"/>
    <joint type="slide" stiffness="1e9"/><geom size="0.1" mass="0.001"/></body></worldbody></mujoco>)"),
      "unstable");
}

/// Falls on the floor: contacts need more of the engine's stack than there is in the end.
std::string falling_with_stack(int numbers) {
  return file_with("stack.xml",
                   "<mujoco><size nstack='" + std::to_string(numbers) + R"('/><worldbody><site name="s"/>
    <geom type="plane" size="1 1 1"/><body pos="0 0 0.5"><freejoint/><geom type="box" size="0.1 0.1 0.1"/></body>
    </worldbody></mujoco>)");
}

TEST(WorldErrors, AStackThatIsTooSmallGrows) {
  const auto world = open({.world = falling_with_stack(150)});
  world->advance_to(Time(2s));
  std::string error;
  EXPECT_TRUE(world->finish(error)) << error;
}

TEST(WorldErrors, AnErrorOfTheEngineWhileLoadingDoesNotEndTheProcess) {
  std::string error;
  EXPECT_EQ(open_world({.world = falling_with_stack(1)}, error), nullptr);
  EXPECT_THAT(error, HasSubstr("tack overflow"));
}

TEST(WorldErrors, AFileOfTheWorldThatIsMissingIsNamedWithTheLine) {
  const auto problem = [](const std::string& mjcf) {
    const std::string file = file_with("missing.xml", mjcf);
    std::string error;
    EXPECT_EQ(open_world({.world = file}, error), nullptr);
    return error;
  };
  EXPECT_THAT(problem("<mujoco>\n  <worldbody/>\n  <include file='gone.xml'/>\n</mujoco>"),
              ::testing::AllOf(HasSubstr("there is no file "),
                               HasSubstr("gone.xml, which an <include> names (line 3)")));
  EXPECT_THAT(problem("<mujoco>\n  <asset><mesh name='m' file='gone.stl'/></asset>\n  <worldbody>\n"
                      "    <geom type='mesh' mesh='m'/></worldbody>\n</mujoco>"),
              ::testing::AllOf(HasSubstr("the file "), HasSubstr("gone.stl cannot be opened (line 2)")));
}

}  // namespace
}  // namespace tessera::testing
