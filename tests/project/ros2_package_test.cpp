#include "project/packaging/ros2_package.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/source.hpp"
#include "folder.hpp"
#include "ros2/arguments/overrides.hpp"
#include "spec/parser.hpp"

namespace tessera::project {
namespace {

namespace fs = std::filesystem;
constexpr const char* beacons = R"(tessera: 1
system: Two_Beacons
types: { Speed: { v: float64 } }
parameters:
  gain: { default: 2, min: 0, max: 10 }
  wait: { type: uint32, default: 3 }
agents:
  unit:
    count: 2
    control:
      rate: 10 Hz
      outputs: { speed: Speed }
      parameters:
        label:   { type: string<=16, default: "a \"b\"" }
        corners: { type: "float64[2]", default: [1, 2.5] }
        on:      { type: bool, default: true }
      behaviours: { shine: { next: { to: shine, when: error } } }
    effectors:
      motor:
        rate: 10 Hz
        stale: never
        inputs: { speed: Speed }
        real:   { v: Speed }
        behaviours: { drive: { next: { to: drive, when: error } } }
channels: [ "unit[i].control.speed -> unit[i].motor.speed" ]
drivers:
  unit[*].motor.v: { ros2: "/unit{i}/speed", type: geometry_msgs/msg/Vector3, fields: { x: v } }
)";

class Ros2PackageOf : public project_test::Folder {
 protected:
  Ros2PackageOf() { write("p/spec.yaml", beacons); }
  [[nodiscard]] Specification specification() const {
    diagnostics::Diagnostics found((folder_ / "p/spec.yaml").string(), beacons);
    std::optional<spec::Model> model = spec::parse(found);
    if (!model) throw std::runtime_error(render(found));
    return {folder_ / "p/spec.yaml", folder_ / "p", found, *std::move(model)};
  }
};

TEST(Ros2PackageName, IsOneThatRos2Permits) {
  EXPECT_EQ(ros2_package_name("guard_2"), "guard_2");
  EXPECT_EQ(ros2_package_name("My-Robot"), "my_robot");
  EXPECT_EQ(ros2_package_name("a__b_"), "a_b");
  EXPECT_EQ(ros2_package_name("2x"), "robot_2x");
  EXPECT_EQ(ros2_package_name("r"), "r_robot");
}

TEST_F(Ros2PackageOf, AProjectIsACopyThatBuildsItself) {
  const Specification project = specification();
  write("p/.tessera/build/big", "");
  write("p/src/control.cpp", "// mine\n");
  write("p/project.cmake", "# flags\n");
  const auto made =
      make_ros2_package(project, {.name = "beacons", .version = "1.2", .folder = folder_ / "ws"});
  ASSERT_TRUE(made) << made.problem();
  EXPECT_EQ(*made, folder_ / "ws/beacons");
  EXPECT_EQ(content_of(*made / "src/control.cpp"), "// mine\n");
  EXPECT_FALSE(fs::exists(*made / ".tessera"));
  EXPECT_NE(content_of(*made / "package.xml").find("<version>1.2.0</version>"), std::string::npos);
  EXPECT_NE(content_of(*made / "CMakeLists.txt")
                .find("tessera_add_controller(controller SPEC spec.yaml LIBRARIES project)"),
            std::string::npos);
  EXPECT_NE(content_of(*made / "launch/beacons.launch.py").find("package=\"beacons\""), std::string::npos);
  EXPECT_FALSE(make_ros2_package(project, {.name = "beacons", .version = "1.2", .folder = folder_ / "ws"}))
      << "it exists";
}

TEST_F(Ros2PackageOf, DefaultValuesAreReadAsTheTypesOfTheParameters) {
  const auto made = make_ros2_package(specification(), {.name = "beacons", .version = "1", .folder = {}});
  ASSERT_TRUE(made) << made.problem();
  const fs::path file = *made / "config/params.yaml";
  const auto values = ros2::read_override_file(file.string());
  ASSERT_TRUE(values) << values.problem();
  EXPECT_EQ(values->nodes, (std::vector<std::string>{"/**", "/**/unit_0", "/**/unit_1"}));
  const auto value = [&](const std::string& name) -> ros2::ParameterValue {
    for (const ros2::Override& one : values->values)
      if (one.name == name) return one.value;
    return {};
  };
  EXPECT_EQ(value("use_sim_time"), ros2::ParameterValue(false));
  EXPECT_EQ(value("control.gain"), ros2::ParameterValue(2.0));
  EXPECT_EQ(value("motor.wait"), ros2::ParameterValue(std::int64_t{3}));
  EXPECT_EQ(value("control.label"), ros2::ParameterValue(std::string("a \"b\"")));
  EXPECT_EQ(value("control.corners"), ros2::ParameterValue(std::vector<double>{1, 2.5}));
  EXPECT_EQ(value("control.on"), ros2::ParameterValue(true));
}

TEST_F(Ros2PackageOf, NoFileIsReplacedAndNoWrongNameIsTaken) {
  const auto wrong = make_ros2_package(specification(), {.name = "", .version = "1.0", .folder = {}});
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.problem().find("'Two_Beacons' is no name of a package of ROS 2"), std::string::npos);
  EXPECT_NE(wrong.problem().find("try --ros2=two_beacons"), std::string::npos);
  EXPECT_FALSE(make_ros2_package(specification(), {.name = "beacons", .version = "1.0-2", .folder = {}}));
  write("p/CMakeLists.txt", "# mine\n");
  const auto kept = make_ros2_package(specification(), {.name = "beacons", .version = "1.0", .folder = {}});
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.problem().find("CMakeLists.txt exists already"), std::string::npos);
  EXPECT_EQ(content_of(folder_ / "p/CMakeLists.txt"), "# mine\n");
  EXPECT_FALSE(fs::exists(folder_ / "p/package.xml")) << "all or nothing";
}

}  // namespace
}  // namespace tessera::project
