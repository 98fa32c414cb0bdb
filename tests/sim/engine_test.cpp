// Buffers that grow, and simulations that go wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "sim/contents.hpp"
#include "sim/engine/physics.hpp"
#include "small_worlds.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// A pile of boxes that needs far more contacts than `size` allows for.
std::string pile(const std::string& size) {
  std::string boxes;
  for (int index = 0; index < 27; ++index)
    boxes += "<body pos='" + std::to_string(0.21 * (index % 3)) + " " +
             std::to_string(0.21 * (index / 3 % 3)) + " " + std::to_string(0.12 + 0.22 * (index / 9)) +
             "'><freejoint/><geom type='box' size='0.1 0.1 0.1'/></body>";
  return "<mujoco>" + size + "<worldbody><geom type='plane' size='3 3 1'/>" + boxes + "</worldbody></mujoco>";
}

std::vector<double> end_of(const std::string& size, bool reading) {
  auto loaded = sim::Physics::load(file_with("pile.xml", pile(size)));
  if (!loaded) throw std::runtime_error(loaded.problem());
  sim::Physics& physics = **loaded;
  for (int step = 0; step < 150; ++step) {
    if (reading) static_cast<void>(physics.state());
    physics.step();
  }
  EXPECT_FALSE(physics.failure()) << physics.failure()->text;
  const mjData& now = physics.positions();
  return {now.qvel, now.qvel + physics.model().nv};
}

TEST(Engine, BuffersGrowWithTheResultOfLargeOnes) {
  const auto small = end_of("<size nconmax='20' njmax='60'/>", false);
  EXPECT_EQ(small, end_of("<size nconmax='2000' njmax='3000'/>", false));
  EXPECT_EQ(small, end_of("<size nconmax='20' njmax='60'/>", true))
      << "a reading may be the first to need more";
}

TEST(Engine, AWorldThatExplodesSaysWhen) {
  auto loaded = sim::Physics::load(file_with("explode.xml",
                                             "<mujoco><option timestep='0.05' gravity='0 0 "
                                             "0'/><worldbody><body><joint type='slide' stiffness='1e9'/>"
                                             "<geom size='0.1' mass='0.001'/></body></worldbody></mujoco>"));
  ASSERT_TRUE(loaded) << loaded.problem();
  sim::Physics& physics = **loaded;
  for (int step = 0; step < 100; ++step) physics.step();
  EXPECT_FALSE(physics.failure()) << "it rests at zero";
  physics.before_next_step([](mjModel&, mjData& state, const mjData&) { state.qpos[0] = 1; });
  for (int step = 0; step < 100; ++step) physics.step();
  ASSERT_TRUE(physics.failure());
  EXPECT_THAT(physics.failure()->text, ::testing::MatchesRegex("the physics failed at 5\\.[0-9]* s: .*"));
}

TEST(Engine, ListsWhatAWorldOffers) {
  auto loaded = sim::Physics::load(file_with("listed.xml", workshop));
  ASSERT_TRUE(loaded) << loaded.problem();
  const auto json = nlohmann::json::parse(sim::contents_as_json((*loaded)->model()));
  EXPECT_EQ(json["sensors"].size(), 5U);
  EXPECT_EQ(json["sensors"][2]["name"], "gyro");
  EXPECT_EQ(json["sensors"][2]["type"], "float64[3]");
  EXPECT_EQ(json["sensors"][4]["kind"], "") << "`user` sensors give nothing";
  EXPECT_EQ(json["joints"][3]["joint"], "ball");
  EXPECT_EQ(json["joints"][3]["velocity_type"], "float64[3]");
  EXPECT_EQ(json["actuators"][0]["range"], (std::vector<double>{-1.5, 1.5}));
  EXPECT_EQ(json["bodies"][2]["moved_by"], "place");
  EXPECT_EQ(json["equalities"][0]["name"], "grip");
}

TEST(Engine, SaysWhichWordNeedsANewerVersion) {
  const auto complaint = [](const std::string& inside) {
    return sim::Physics::load(file_with("newer.xml", "<mujoco>" + inside + "</mujoco>")).problem();
  };
  using ::testing::EndsWith;
  EXPECT_THAT(complaint("<option integrator='implicitfast'/>"),
              EndsWith("newer.xml: needs a newer MuJoCo: `implicitfast` in `option` (line 1)"));
  EXPECT_THAT(complaint("<worldbody><frame/></worldbody>"),
              EndsWith("needs a newer MuJoCo: `frame` (line 1)"));
  EXPECT_THAT(complaint("<worldbody><blob/></worldbody>"), EndsWith("it is wrong, or needs a newer MuJoCo"));
  const std::string body = "<worldbody><body name='b'><joint name='j'/><geom size='1'/></body></worldbody>";
  EXPECT_THAT(
      complaint("<default><adhesion ctrlrange='0 1'/></default>" + body +
                "<actuator><adhesion body='b'/></actuator>"),
      EndsWith("MuJoCo 2.2.2 wants `ctrlrange` at `adhesion` itself (line 1), not in a default class; "
               "write it there, or use a newer MuJoCo, which takes both"));
  EXPECT_THAT(
      complaint(body + "<actuator><general joint='j' dyntype='integrator'/><motor joint='j'/></actuator>"),
      EndsWith("sort them, or use a newer MuJoCo, which takes any order"));
  EXPECT_THAT(
      sim::Physics::load(file_with("part.xml", "<mujocoinclude/>")).problem(),
      EndsWith("part.xml: is a part for an <include>, no model of its own: open the file that includes it"));
}

TEST(Engine, RefusesATimeStepThatNoRunCanMake) {
  const auto complaint = [](const std::string& step) {
    return sim::Physics::load(file_with("step.xml", "<mujoco><option timestep='" + step + "'/></mujoco>"))
        .problem();
  };
  for (const char* step : {"0", "-0.002", "9e-7"})
    EXPECT_THAT(complaint(step), ::testing::HasSubstr("it must be 1 us (1e-6 s) or longer")) << step;
  EXPECT_EQ(complaint("1e-6"), "");
  EXPECT_THAT(complaint("0.2"), ::testing::HasSubstr("longer than 0.1 s"));
}

TEST(Engine, SaysWhereANumberIsNone) {
  using ::testing::EndsWith;
  const auto complaint = [](const std::string& xml) {
    return sim::Physics::load(file_with("nan.xml", xml)).problem();
  };
  const std::string body = "<body name='nan' pos='0 0 1'>\n<geom name='a' size='0.1'/></body>";
  const auto world = [&](const std::string& parts) {
    return "<mujoco>\n<worldbody>\n" + parts + "</worldbody></mujoco>";
  };
  EXPECT_EQ(complaint(world(body)), "");
  EXPECT_THAT(complaint(world(body + "<geom size='1' pos = \"0 NaN 1\"/>")),
              EndsWith("nan.xml: `pos` is NaN (line 4)"));
  EXPECT_THAT(complaint(world("<geom size='-nan'/>")), EndsWith("nan.xml: `size` is NaN (line 3)"));
  const std::filesystem::path part =
      file_with("has_nan.xml", "<mujoco><worldbody><geom size='nan'/></worldbody></mujoco>");
  EXPECT_THAT(complaint("<mujoco><include file='" + part.filename().string() + "'/></mujoco>"),
              EndsWith("a number is NaN, here or in a file that is included"));
}

TEST(Engine, SaysWhatIsNoFileOfAWorld) {
  using ::testing::EndsWith;
  const std::string folder = std::filesystem::path(file_with("empty.xml", "")).parent_path().string();
  const auto complaint = [](const std::string& path) { return sim::Physics::load(path).problem(); };
  EXPECT_THAT(complaint(file_with("empty.xml", "")), EndsWith("empty.xml: the file is empty"));
  EXPECT_THAT(complaint(folder), EndsWith("is a folder; name the file in it"));
  EXPECT_THAT(complaint(folder + "/nowhere.xml"), EndsWith("nowhere.xml: there is no such file"));
  EXPECT_THAT(complaint("/dev/zero"), EndsWith("is no regular file"));
  const std::string pipe = folder + "/pipe.xml";
  std::filesystem::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(complaint(pipe), EndsWith("is no regular file")) << "and nobody waits";
  std::filesystem::remove(pipe);
}

TEST(Engine, RefusesSensorsWithInfiniteNoise) {
  using ::testing::EndsWith;
  const auto complaint = [](const std::string& options) {
    return sim::Physics::load(file_with("sensor.xml",
                                        "<mujoco><worldbody><body><joint name='j'/><geom size='1'/>"
                                        "</body></worldbody><sensor><jointpos name='s' joint='j' " +
                                            options + "/></sensor></mujoco>"))
        .problem();
  };
  EXPECT_EQ(complaint("noise='0.1' cutoff='3'"), "");
  for (const char* wrong : {"noise='inf'", "cutoff='inf'", "noise='1e999'"})
    EXPECT_NE(complaint(wrong), "") << wrong;
  EXPECT_THAT(complaint("noise='inf'"), EndsWith("the `noise` or `cutoff` of sensor 's' is infinite"));
}

TEST(Engine, AnActuatorWithoutANameHasThatOfItsJoint) {
  const auto world = open_text("unnamed", R"(<mujoco><worldbody>
    <body><joint name="a"/><geom size="0.1"/><body><joint name="b"/><geom size="0.1"/></body></body>
    </worldbody><actuator><motor joint="a"/><motor joint="b"/><motor joint="b"/></actuator></mujoco>)");
  EXPECT_NO_THROW(static_cast<void>(effector<double>(*world, {"r.m.a", "actuator", {"a"}, {}})));
  EXPECT_THROW(static_cast<void>(effector<double>(*world, {"r.m.b", "actuator", {"b"}, {}})),
               std::runtime_error)
      << "there are two";
}

}  // namespace
}  // namespace tessera::testing
