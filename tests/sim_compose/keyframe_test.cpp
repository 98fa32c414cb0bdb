#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "files.hpp"

namespace tessera::testing {
namespace {

struct State {
  explicit State(const sim::ComposedWorld& world) : model(*world.model), data(mj_makeData(&model)) {
    sim::set_state(model, world.initial, *data);
  }
  [[nodiscard]] const mjtNum* position(const char* joint) const {
    return data->qpos + model.jnt_qposadr[mj_name2id(&model, mjOBJ_JOINT, joint)];
  }
  [[nodiscard]] double control(const char* actuator) const {
    return data->ctrl[mj_name2id(&model, mjOBJ_ACTUATOR, actuator)];
  }
  const mjModel& model;
  sim::DataPtr data;
};

TEST(Keyframe, SetsJointsAndControlsOfItsInstanceOnly) {
  sim::Placement posed = placed("a", model("arm.xml"), 1, 2);
  posed.keyframe = "home";
  const sim::ComposedWorld world = loaded({placed("b", model("arm.xml")), posed});
  const State state(world);
  EXPECT_EQ(*state.position("a/shoulder"), 0.3);
  EXPECT_EQ(*state.position("a/elbow"), -0.4);
  EXPECT_NEAR(*state.position("b/shoulder"), std::acos(-1.0) / 18, 1e-15);  // its `ref`
  EXPECT_EQ(state.control("a/shoulder"), 0.3);
  EXPECT_EQ(state.control("a/pull"), 0.4);
  EXPECT_EQ(state.control("b/shoulder"), 0);
  // The states of both `elbow` and `pull`, after those of b.
  ASSERT_EQ(state.model.na, 4);
  EXPECT_EQ(state.data->act[2], 0.5);
  EXPECT_EQ(state.data->act[3], 0.25);
}

TEST(Keyframe, MovesWithThePlacement) {
  sim::Placement rover = placed("a", model("rover.xml"), 10, 20);
  rover.heading_rad = std::acos(-1.0) / 2;
  rover.keyframe = "rolling";
  sim::Placement arm = placed("b", model("arm.xml"), 1, 2);
  arm.heading_rad = rover.heading_rad;
  arm.keyframe = "home";
  const sim::ComposedWorld world = loaded({rover, arm});
  const State state(world);
  const mjModel& m = state.model;
  // The rover's free joint has no name in its file, and is set all the same. It is one metre ahead.
  const int base = mj_name2id(&m, mjOBJ_BODY, "a/base");
  const int joint = m.body_jntadr[base];
  const mjtNum* q = state.data->qpos + m.jnt_qposadr[joint];
  EXPECT_NEAR(q[0], 10, 1e-12);
  EXPECT_NEAR(q[1], 21, 1e-12);
  EXPECT_NEAR(q[2], 0.06, 1e-12);
  EXPECT_NEAR(q[3], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(q[6], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(state.data->qvel[m.jnt_dofadr[joint] + 1], 0.3, 1e-12);
  EXPECT_NEAR(state.data->qvel[m.jnt_dofadr[joint] + 5], 0.1, 1e-12);
  const int mocap = m.body_mocapid[mj_name2id(&m, mjOBJ_BODY, "b/target")];
  EXPECT_NEAR(state.data->mocap_pos[3 * mocap], 1 - 0.2, 1e-12);
  EXPECT_NEAR(state.data->mocap_pos[3 * mocap + 1], 2 + 0.1, 1e-12);
}

TEST(Keyframe, WithoutOneTheStateIsThatOfTheFile) {
  const sim::ComposedWorld world =
      loaded({placed("a", model("rover.xml"), 1, 2), placed("b", model("arm.xml"))});
  const State state(world);
  const sim::DataPtr fresh(mj_makeData(&state.model));
  for (int i = 0; i < state.model.nq; ++i) EXPECT_EQ(state.data->qpos[i], fresh->qpos[i]);
  for (int i = 0; i < 3 * state.model.nmocap; ++i) EXPECT_EQ(state.data->mocap_pos[i], fresh->mocap_pos[i]);
  for (int i = 0; i < 4 * state.model.nmocap; ++i) EXPECT_EQ(state.data->mocap_quat[i], fresh->mocap_quat[i]);
}

TEST(Keyframe, SaysWhichThereAre) {
  sim::Placement rover = placed("a", model("rover.xml"));
  rover.keyframe = "standin";
  EXPECT_EQ(problem_of({rover}), model("rover.xml") +
                                     ": has no keyframe 'standin'; it has rolling, standing; did you mean "
                                     "'standing'?");
  sim::Placement box = placed("a", model("box.xml"));
  box.keyframe = "home";
  EXPECT_EQ(problem_of({box}), model("box.xml") + ": has no keyframe 'home'; it has none at all");
}

}  // namespace
}  // namespace tessera::testing
