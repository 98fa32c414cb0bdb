// Whatever watches a run, it stays the same, to the last bit. TESSERA_SEEDS=100 is the long form.

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "../environment.hpp"
#include "sim/rendering/offscreen.hpp"
#include "small_worlds.hpp"
#include "tessera/large_array.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// Boxes in a pile on a belt that wraps, an arm that knocks them about, and a camera.
constexpr const char* belt_and_arm = R"(<mujoco model="belt_and_arm">
  <option timestep="0.002" cone="elliptic"/>
  <worldbody>
    <light pos="0 0 3"/>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <camera name="above" pos="0 0 2" fovy="60"/>
    <body name="belt" pos="0 0 0.1"><joint name="belt" type="slide" axis="1 0 0" armature="50"/>
      <geom name="belt" type="box" size="1 0.3 0.04" mass="10"/></body>
    <body name="arm" pos="0 0.5 0.25">
      <joint name="arm" type="hinge" axis="0 0 1" damping="1"/>
      <geom type="capsule" fromto="0 0 0 0 -0.5 0" size="0.03" mass="1"/>
      <site name="tip" pos="0 -0.5 0" size="0.02"/></body>
    <body name="box[0]" pos="0 0 0.3"><freejoint/><geom type="box" size="0.05 0.05 0.05" mass="0.3"/></body>
    <body name="box[1]" pos="0.04 0 0.42"><freejoint/><geom type="box" size="0.05 0.05 0.05" mass="0.3"/></body>
    <body name="box[2]" pos="-0.2 0.02 0.3"><freejoint/><geom type="box" size="0.05 0.05 0.05" mass="0.3"/></body>
    <site name="zone" type="box" size="0.5 0.5 0.5"/>
  </worldbody>
  <actuator>
    <velocity name="belt" joint="belt" kv="500" ctrllimited="true" ctrlrange="-1 1"/>
    <position name="arm" joint="arm" kp="20" ctrllimited="true" ctrlrange="-1.5 1.5"/>
  </actuator>
  <sensor><gyro name="gyro" site="tip" noise="0.1"/></sensor>
</mujoco>)";

constexpr const char* watched_checks = R"json({
  "checks": [{"name": "a", "when": "never", "formula": "contact(box[*], floor)"},
             {"name": "b", "when": "always", "formula": "distance(box[*], box[*]) > 0.01"},
             {"name": "c", "when": "at_end", "formula": "all(inside(box[*], zone))"}],
  "measures": {"pace": "speed(box[0])", "gyro": "sensor(gyro, 0)"}})json";

class CountingSink final : public PoseSink {
 public:
  void take(Time /*time*/, std::span<const BodyPose> poses) override { seen += poses.size(); }
  std::size_t seen = 0;
};

/// The end state of a run of 1 s, and its readings on the way.
struct Outcome {
  std::vector<double> readings;
  bool operator==(const Outcome&) const = default;
};

using Pose7 = std::array<double, 7>;
using Picture = LargeArray<std::uint8_t, 3UL * 64 * 48>;

/// Looks at a run in every way there is.
class Watcher {
 public:
  Watcher(World& world, bool with_camera) : world_(world) {
    world.show_poses(sink_);
    gyro_ = receptor<std::array<double, 3>>(world, {"other.imu.gyro", "sensor", {"gyro"}, {}});
    scan_ = receptor<std::array<double, 16>>(world, {"other.laser.scan", "scan", {"tip"}, {}});
    touch_ = receptor<bool>(world, {"other.bumper.touch", "contact", {"box[0]"}, {}});
    if (!with_camera) return;
    camera_ =
        receptor<Picture>(world, {"other.eye.picture", "camera", {"above"}, {{"width", 64}, {"height", 48}}});
    EXPECT_TRUE(camera_->open());
  }
  void look(bool picture) {
    static_cast<void>(read_as<std::array<double, 3>>(*gyro_));
    static_cast<void>(read_as<std::array<double, 16>>(*scan_));
    static_cast<void>(read_as<bool>(*touch_));
    if (camera_ && picture) static_cast<void>(read_as<Picture>(*camera_));
    static_cast<void>(world_.take_failures());
  }
  [[nodiscard]] std::size_t poses() const { return sink_.seen; }

 private:
  World& world_;
  CountingSink sink_;
  std::unique_ptr<RealReceptor> gyro_, scan_, touch_, camera_;
};

Outcome outcome_of(std::uint64_t seed, bool watched, bool with_camera) {
  WorldOptions options{.world = file_with("belt_and_arm.xml", belt_and_arm), .seed = seed};
  if (watched) {
    options.trace = temporary("watched.csv");
    options.checks = watched_checks;
  }
  const auto world = open(options);
  const auto belt =
      effector<double>(*world, {"cell.belt.speed", "actuator", {"belt"}, {{"wrap", WorldOption(0.1)}}});
  const auto arm = effector<double>(*world, {"cell.arm.angle", "actuator", {"arm"}, {}});
  const auto gyro = receptor<std::array<double, 3>>(*world, {"cell.imu.gyro", "sensor", {"gyro"}, {}});
  std::vector<std::unique_ptr<RealReceptor>> boxes;
  for (const char* box : {"box[0]", "box[1]", "box[2]"})
    boxes.push_back(receptor<Pose7>(*world, {std::string("cell.") + box, "pose", {box}, {}}));
  std::optional<Watcher> watcher;
  if (watched) watcher.emplace(*world, with_camera);

  Outcome outcome;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> anything(-1, 1);
  for (auto t = 50ms; t <= 1s; t += 50ms) {
    EXPECT_TRUE(write_as(*belt, anything(random)));
    EXPECT_TRUE(write_as(*arm, 1.5 * anything(random)));
    // A watched run goes in small pieces, as with pauses and breakpoints.
    for (auto piece = t - 49ms; watcher && piece < t; piece += 7ms) {
      world->advance_to(Time(piece));
      watcher->look(piece % 3ms == 0ms);
    }
    world->advance_to(Time(t));
    for (const double part : read_as<std::array<double, 3>>(*gyro)) outcome.readings.push_back(part);
    for (const auto& box : boxes)
      for (const double part : read_as<Pose7>(*box)) outcome.readings.push_back(part);
  }
  if (watcher) {
    EXPECT_GT(watcher->poses(), 0U);
    EXPECT_FALSE(world->results().empty());
  }
  std::string error;
  EXPECT_TRUE(world->finish(error)) << error;
  return outcome;
}

TEST(World, IsTheSameWhateverWatchesIt) {
  const std::uint64_t seeds = from_environment("TESSERA_SEEDS", share_of(20));
  const bool with_camera = static_cast<bool>(sim::OffscreenContext::open("libEGL.so.1"));
  Outcome last;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Outcome plain = outcome_of(seed, false, false);
    ASSERT_EQ(plain, outcome_of(seed, true, with_camera)) << "seed " << seed;
    ASSERT_NE(plain, last);
    last = plain;
  }
}

}  // namespace
}  // namespace tessera::testing
