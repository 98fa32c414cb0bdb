#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tessera/poses.hpp"
#include "world_devices.hpp"
#include "world_library.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using nlohmann::json;

/// Every kind of shape, and a body that is carried about.
constexpr const char* shapes_world = R"(<mujoco>
  <compiler autolimits="true"/>
  <asset>
    <texture name="squares" type="2d" builtin="checker" rgb1="1 1 1" rgb2="0 0 0" width="16" height="16"/>
    <material name="squares" texture="squares" texrepeat="2 2" texuniform="true"/>
    <texture name="red" type="cube" builtin="flat" rgb1="1 0 0" width="8" height="8"/>
    <material name="red" texture="red" shininess="1" emission="0.5"/>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
    <hfield name="hills" nrow="5" ncol="7" size="2 1 0.5 0.1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="0 0 1" material="squares"/>
    <geom type="hfield" hfield="hills" pos="9 0 0"/>
    <geom name="hidden" type="box" size="1 1 1" group="3"/>
    <geom type="box" size="1 1 1" rgba="1 0 0 0"/>
    <body name="shelf" pos="3 0 0"><geom type="box" size="0.1 0.2 0.3" rgba="0 0 1 0.5"/></body>
    <body name="robot[0]/base" pos="0 0 1"><freejoint/>
      <geom type="sphere" size="0.1" material="red"/>
      <body pos="0 0 0.5"><joint name="robot[0]/arm" type="hinge"/>
        <geom type="capsule" size="0.02 0.1"/><site name="robot[0]/hand"/></body>
    </body>
    <body name="robot[1]/base" pos="0 4 1" quat="0 0 0 1"><freejoint/>
      <geom type="sphere" size="0.2" material="red"/><geom type="mesh" mesh="wedge"/></body>
    <body name="loose" pos="0 6 1"><joint type="slide" axis="1 0 0"/><geom type="cylinder" size="0.1 0.2"/>
      <geom type="ellipsoid" size="0.1 0.2 0.3"/><site name="eye"/></body>
    <body name="carried" mocap="true" pos="0 8 0"><geom type="box" size="0.1 0.1 0.1"/></body>
  </worldbody>
</mujoco>)";

struct Glb {
  json head;
  std::string data;
};

/// The parts of a file whose lengths all agree.
[[nodiscard]] Glb parts_of(const std::string& glb) {
  const auto word = [&](std::size_t at) {
    std::uint32_t number = 0;
    std::memcpy(&number, glb.data() + at, sizeof number);
    return number;
  };
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), glb.size());
  const std::size_t text = word(12);
  Glb parts{json::parse(glb.substr(20, text)), ""};
  EXPECT_EQ(word(20 + text), glb.size() - 28 - text);
  parts.data = glb.substr(28 + text);
  EXPECT_EQ(parts.head["buffers"][0]["byteLength"], parts.data.size());
  return parts;
}

[[nodiscard]] json node_named(const json& head, const std::string& name) {
  for (const json& node : head["nodes"])
    if (node.value("name", "") == name) return node;
  ADD_FAILURE() << "no node " << name;
  return {};
}

struct Seen final : PoseSink {
  std::vector<double> times;
  std::vector<std::vector<BodyPose>> frames;
  void take(Time time, std::span<const BodyPose> poses) override {
    times.push_back(seconds(time.time_since_epoch()));
    frames.emplace_back(poses.begin(), poses.end());
  }
};

struct Scenes : ::testing::Test {
  std::unique_ptr<World> world = open({.world = file_with("shapes.xml", shapes_world)});
  std::vector<DriverRequest> devices{{"robot[0].arm.angle", "joint_position", {"arm"}, {}},
                                     {"lone.eye.light", "reflectance", {"eye"}, {}}};
};

TEST_F(Scenes, NameTheBodiesThatMoveAndTheirAgents) {
  const std::optional<WorldScene> scene = world->scene(devices);
  ASSERT_TRUE(scene);
  std::vector<std::string> told;
  for (const WorldScene::Body& body : scene->bodies) told.push_back(body.name + "=" + body.agent);
  EXPECT_EQ(told, (std::vector<std::string>{"robot[0]/base=robot[0]", "body 3=robot[0]",
                                            "robot[1]/base=", "loose=lone", "carried="}));
}

TEST_F(Scenes, HaveANodePerBodyWithItsVisibleShapes) {
  const Glb scene = parts_of(world->scene(devices)->glb);
  const json& nodes = scene.head["nodes"];
  std::map<int, std::string> bodies;
  for (const json& node : nodes)
    if (node.contains("extras") && node["extras"].contains("body"))
      bodies[node["extras"]["body"].get<int>()] = node["name"].get<std::string>();
  EXPECT_EQ(bodies,
            (std::map<int, std::string>{
                {0, "robot[0]/base"}, {1, "body 3"}, {2, "robot[1]/base"}, {3, "loose"}, {4, "carried"}}));
  EXPECT_EQ(node_named(scene.head, "world")["children"].size(), 2u) << "what is hidden or clear is not there";
  EXPECT_FALSE(node_named(scene.head, "shelf").contains("extras"));
  EXPECT_EQ(node_named(scene.head, "body 3")["translation"], json({0, 0, 1.5}));
  EXPECT_EQ(node_named(scene.head, "loose")["children"].size(), 2u);
  const auto mesh_below = [&](const char* body) {
    return nodes[node_named(scene.head, body)["children"][0].get<std::size_t>()]["mesh"];
  };
  EXPECT_EQ(mesh_below("robot[0]/base"), mesh_below("robot[1]/base")) << "spheres of one look share one mesh";
  const json& sphere = scene.head["meshes"][mesh_below("robot[0]/base").get<std::size_t>()]["primitives"][0];
  const json& red = scene.head["materials"][sphere["material"].get<std::size_t>()];
  const auto colour = red["pbrMetallicRoughness"]["baseColorFactor"].get<std::vector<double>>();
  EXPECT_TRUE(colour[0] > 0.75 && colour[1] < 0.02 && colour[3] == 1) << "of the picture around it";
  EXPECT_EQ(scene.head["images"].size(), 1u);
}

TEST_F(Scenes, AccessorsLieWithinTheirDataAndIndicesWithinTheirVertices) {
  const Glb scene = parts_of(world->scene(devices)->glb);
  for (const json& mesh : scene.head["meshes"]) {
    const json& primitive = mesh["primitives"][0];
    const auto accessor = [&](const json& index) {
      return scene.head["accessors"][index.get<std::size_t>()];
    };
    const json indices = accessor(primitive["indices"]),
               points = accessor(primitive["attributes"]["POSITION"]);
    const json& view = scene.head["bufferViews"][indices["bufferView"].get<std::size_t>()];
    ASSERT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
              scene.data.size());
    ASSERT_EQ(indices["componentType"], 5123);
    ASSERT_EQ(view["byteLength"], 2 * indices["count"].get<std::size_t>());
    for (std::size_t at = 0; at < indices["count"].get<std::size_t>(); ++at) {
      std::uint16_t index = 0;
      std::memcpy(&index, scene.data.data() + view["byteOffset"].get<std::size_t>() + 2 * at, 2);
      EXPECT_LT(index, points["count"].get<std::size_t>());
    }
  }
}

/// Seen from outside, all triangles of the shapes are turned against the clock.
TEST_F(Scenes, TrianglesLookOutwards) {
  const Glb scene = parts_of(world->scene(devices)->glb);
  std::size_t triangles = 0;
  for (const json& mesh : scene.head["meshes"]) {
    const json& primitive = mesh["primitives"][0];
    const auto view_of = [&](const json& index) {
      const json& accessor = scene.head["accessors"][index.get<std::size_t>()];
      return scene.head["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"]
          .get<std::size_t>();
    };
    const auto vector_at = [&](const char* attribute, std::uint16_t vertex) {
      std::array<float, 3> v{};
      std::memcpy(v.data(), scene.data.data() + view_of(primitive["attributes"][attribute]) + 12 * vertex,
                  12);
      return v;
    };
    const std::size_t count = scene.head["accessors"][primitive["indices"].get<std::size_t>()]["count"];
    constexpr std::size_t of_wedge = 12;
    if (count == of_wedge) continue;  // the engine smooths the normals of meshes
    for (std::size_t at = 0; at < count; at += 3) {
      std::array<std::uint16_t, 3> corners{};
      std::memcpy(corners.data(), scene.data.data() + view_of(primitive["indices"]) + 2 * at, 6);
      std::array<std::array<float, 3>, 3> p{};
      for (std::size_t corner = 0; corner < 3; ++corner) p[corner] = vector_at("POSITION", corners[corner]);
      std::array<float, 3> a{}, b{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        a[axis] = p[1][axis] - p[0][axis], b[axis] = p[2][axis] - p[0][axis];
      const std::array<float, 3> cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                       a[0] * b[1] - a[1] * b[0]};
      float with = 0;
      for (const std::uint16_t corner : corners)
        for (std::size_t axis = 0; axis < 3; ++axis) with += cross[axis] * vector_at("NORMAL", corner)[axis];
      EXPECT_GT(with, 0) << mesh << " triangle " << at / 3;
      ++triangles;
    }
  }
  EXPECT_GT(triangles, 500u);
}

TEST_F(Scenes, AreTheSameForTheSameModelWhateverItsState) {
  const std::string before = world->scene(devices)->glb;
  world->advance_to(Time(1s));
  EXPECT_EQ(world->scene(devices)->glb, before);
  if (const char* const kept = std::getenv("TESSERA_KEEP_SCENES")) {
    std::ofstream(std::string(kept) + "/shapes.glb", std::ios::binary) << before;
    const auto floor = open({.world = line_world(), .track = shipped_track("oval.png")});
    std::ofstream(std::string(kept) + "/line.glb", std::ios::binary) << floor->scene({})->glb;
  }
}

TEST_F(Scenes, PosesComeOncePerPeriodAndFollowThePhysics) {
  Seen seen;
  world->show_poses(seen);
  world->advance_to(Time(100ms));
  world->advance_to(Time(500ms));
  ASSERT_EQ(seen.times.size(), 13u);
  for (std::size_t frame = 0; frame < seen.times.size(); ++frame)
    EXPECT_NEAR(seen.times[frame], 0.04 * static_cast<double>(frame), 2e-3 + 1e-9);
  const auto& fallen = seen.frames[8][2];  // before it meets the floor
  const double time = seen.times[8];
  EXPECT_NEAR(fallen.position_m[2], 1 - 0.5 * 9.81 * time * time, 0.02);
  EXPECT_NEAR(std::abs(seen.frames[0][2].rotation[3]), 1, 1e-12);
  EXPECT_NEAR(seen.frames[5][4].position_m[1], 8, 1e-12);
}

TEST(Scene, TheFloorPictureLiesWithItsLowerLeftCornerAtTheOrigin) {
  const auto world = open({.world = line_world(), .track = shipped_track("oval.png")});
  const std::vector<DriverRequest> devices{eye_request, wheel_request};
  const std::optional<WorldScene> shown = world->scene(devices);
  const Glb scene = parts_of(shown->glb);
  const json picture = node_named(scene.head, "floor picture");
  const json& primitive = scene.head["meshes"][picture["mesh"].get<std::size_t>()]["primitives"][0];
  const json& points = scene.head["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  for (std::size_t axis = 0; axis < 2; ++axis)
    EXPECT_NEAR(picture["translation"][axis].get<double>(), -points["min"][axis].get<double>(), 1e-6);
  EXPECT_GT(points["max"][0].get<double>(), 0.5);
  ASSERT_EQ(shown->bodies.size(), 3u);
  for (const WorldScene::Body& body : shown->bodies) EXPECT_EQ(body.agent, "robot");
}

/// A view changes no bit of the run: positions after some time are the same with and without it.
TEST(Scene, LookingAtAWorldDoesNotDisturbIt) {
  const auto positions = [](bool watched) {
    Seen seen, at_the_end;
    const auto world = open({.world = line_world()});
    std::string error;
    const auto wheel = world->effector(wheel_request, error);
    EXPECT_TRUE(write(*wheel, 3));
    if (watched) {
      static_cast<void>(world->scene({}));
      world->show_poses(seen);
    }
    for (int step = 1; step <= 400; ++step) world->advance_to(Time(step * 5ms));
    world->show_poses(at_the_end);
    world->advance_to(Time(2100ms));
    return at_the_end.frames.back();
  };
  const std::vector<BodyPose> one = positions(false), other = positions(true);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t body = 0; body < one.size(); ++body) {
    EXPECT_EQ(one[body].position_m, other[body].position_m);
    EXPECT_EQ(one[body].rotation, other[body].rotation);
  }
}

}  // namespace
}  // namespace tessera::testing
