// A model in a composed world equals its file compiled alone. The test compiles the file with the engine
// itself, not with the code under test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "files.hpp"
#include "sim/compose/comparison.hpp"
#include "sim/mjcf/compile.hpp"

namespace tessera::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Elements {
  const mjModel& alone;
  const mjModel& composed;
  std::string prefix;

  /// The id in the composed world; a failure of the test if it is not there.
  [[nodiscard]] int other(mjtObj type, int id) const {
    const std::string name = prefix + mj_id2name(&alone, type, id);
    const int found = mj_name2id(&composed, type, name.c_str());
    EXPECT_GE(found, 0) << name;
    return found;
  }
  [[nodiscard]] bool has_name(mjtObj type, int id) const { return mj_id2name(&alone, type, id) != nullptr; }
};

void expect_near(const mjtNum* a, const mjtNum* b, int count, const std::string& what) {
  for (int i = 0; i < count; ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * std::max(1.0, std::abs(a[i]))) << what;
}

void expect_same_geoms(const Elements& e, int body, int other) {
  ASSERT_EQ(e.alone.body_geomnum[body], e.composed.body_geomnum[other]);
  for (int i = 0; i < e.alone.body_geomnum[body]; ++i) {
    const int a = e.alone.body_geomadr[body] + i, b = e.composed.body_geomadr[other] + i;
    EXPECT_EQ(e.alone.geom_type[a], e.composed.geom_type[b]);
    EXPECT_EQ(e.alone.geom_contype[a], e.composed.geom_contype[b]);
    EXPECT_EQ(e.alone.geom_condim[a], e.composed.geom_condim[b]);
    EXPECT_EQ(e.alone.geom_priority[a], e.composed.geom_priority[b]);
    expect_near(e.alone.geom_size + 3 * a, e.composed.geom_size + 3 * b, 3, "size");
    expect_near(e.alone.geom_pos + 3 * a, e.composed.geom_pos + 3 * b, 3, "geom pos");
    expect_near(e.alone.geom_quat + 4 * a, e.composed.geom_quat + 4 * b, 4, "geom quat");
    expect_near(e.alone.geom_friction + 3 * a, e.composed.geom_friction + 3 * b, 3, "friction");
    expect_near(e.alone.geom_margin + a, e.composed.geom_margin + b, 1, "margin");
    for (int c = 0; c < 4; ++c) EXPECT_EQ(e.alone.geom_rgba[4 * a + c], e.composed.geom_rgba[4 * b + c]);
  }
}

void expect_same_joints(const Elements& e, int body, int other) {
  ASSERT_EQ(e.alone.body_jntnum[body], e.composed.body_jntnum[other]);
  for (int i = 0; i < e.alone.body_jntnum[body]; ++i) {
    const int a = e.alone.body_jntadr[body] + i, b = e.composed.body_jntadr[other] + i;
    ASSERT_EQ(e.alone.jnt_type[a], e.composed.jnt_type[b]);
    EXPECT_EQ(e.alone.jnt_limited[a], e.composed.jnt_limited[b]);
    expect_near(e.alone.jnt_range + 2 * a, e.composed.jnt_range + 2 * b, 2, "range");
    expect_near(e.alone.jnt_stiffness + a, e.composed.jnt_stiffness + b, 1, "stiffness");
    const int va = e.alone.jnt_dofadr[a], vb = e.composed.jnt_dofadr[b];
    expect_near(e.alone.dof_damping + va, e.composed.dof_damping + vb, 1, "damping");
    expect_near(e.alone.dof_armature + va, e.composed.dof_armature + vb, 1, "armature");
    if (e.alone.jnt_type[a] == mjJNT_FREE) continue;
    const int qa = e.alone.jnt_qposadr[a], qb = e.composed.jnt_qposadr[b];
    expect_near(e.alone.qpos0 + qa, e.composed.qpos0 + qb, 1, "ref");
    expect_near(e.alone.qpos_spring + qa, e.composed.qpos_spring + qb, 1, "springref");
  }
}

void expect_same_bodies(const Elements& e) {
  for (int body = 1; body < e.alone.nbody; ++body) {
    if (!e.has_name(mjOBJ_BODY, body)) continue;
    SCOPED_TRACE(e.prefix + mj_id2name(&e.alone, mjOBJ_BODY, body));
    const int other = e.other(mjOBJ_BODY, body);
    if (other < 0) continue;
    expect_near(e.alone.body_mass + body, e.composed.body_mass + other, 1, "mass");
    expect_near(e.alone.body_inertia + 3 * body, e.composed.body_inertia + 3 * other, 3, "inertia");
    expect_near(e.alone.body_ipos + 3 * body, e.composed.body_ipos + 3 * other, 3, "inertial pos");
    expect_near(e.alone.body_iquat + 4 * body, e.composed.body_iquat + 4 * other, 4, "inertial quat");
    if (e.alone.body_parentid[body] != 0) {
      expect_near(e.alone.body_pos + 3 * body, e.composed.body_pos + 3 * other, 3, "pos");
      expect_near(e.alone.body_quat + 4 * body, e.composed.body_quat + 4 * other, 4, "quat");
    }
    expect_same_geoms(e, body, other);
    expect_same_joints(e, body, other);
  }
}

void expect_same_actuators(const Elements& e) {
  for (int u = 0; u < e.alone.nu; ++u) {
    if (!e.has_name(mjOBJ_ACTUATOR, u)) continue;
    SCOPED_TRACE(mj_id2name(&e.alone, mjOBJ_ACTUATOR, u));
    const int v = e.other(mjOBJ_ACTUATOR, u);
    if (v < 0) continue;
    EXPECT_EQ(e.alone.actuator_dyntype[u], e.composed.actuator_dyntype[v]);
    EXPECT_EQ(e.alone.actuator_trntype[u], e.composed.actuator_trntype[v]);
    EXPECT_EQ(e.alone.actuator_ctrllimited[u], e.composed.actuator_ctrllimited[v]);
    EXPECT_EQ(e.alone.actuator_forcelimited[u], e.composed.actuator_forcelimited[v]);
    EXPECT_EQ(e.alone.actuator_actlimited[u], e.composed.actuator_actlimited[v]);
    expect_near(e.alone.actuator_gainprm + mjNGAIN * u, e.composed.actuator_gainprm + mjNGAIN * v, mjNGAIN,
                "gain");
    expect_near(e.alone.actuator_biasprm + mjNBIAS * u, e.composed.actuator_biasprm + mjNBIAS * v, mjNBIAS,
                "bias");
    expect_near(e.alone.actuator_ctrlrange + 2 * u, e.composed.actuator_ctrlrange + 2 * v, 2, "ctrlrange");
    expect_near(e.alone.actuator_forcerange + 2 * u, e.composed.actuator_forcerange + 2 * v, 2, "forcerange");
    expect_near(e.alone.actuator_lengthrange + 2 * u, e.composed.actuator_lengthrange + 2 * v, 2,
                "lengthrange");
    expect_near(e.alone.actuator_gear + 6 * u, e.composed.actuator_gear + 6 * v, 6, "gear");
  }
}

void expect_same_constraints(const Elements& e) {
  for (int q = 0; q < e.alone.neq; ++q) {
    if (!e.has_name(mjOBJ_EQUALITY, q)) continue;
    const int other = e.other(mjOBJ_EQUALITY, q);
    if (other < 0) continue;
    EXPECT_EQ(e.alone.eq_active[q], e.composed.eq_active[other]);
    expect_near(e.alone.eq_data + mjNEQDATA * q, e.composed.eq_data + mjNEQDATA * other, mjNEQDATA,
                mj_id2name(&e.alone, mjOBJ_EQUALITY, q));
  }
  for (int t = 0; t < e.alone.ntendon; ++t) {
    const int other = e.other(mjOBJ_TENDON, t);
    if (other < 0) continue;
    expect_near(e.alone.tendon_range + 2 * t, e.composed.tendon_range + 2 * other, 2, "tendon range");
    expect_near(e.alone.tendon_length0 + t, e.composed.tendon_length0 + other, 1, "tendon length");
  }
}

class ExactCopies : public ::testing::TestWithParam<const char*> {};

TEST_P(ExactCopies, InAWorldAsAlone) {
  std::string file = model(GetParam());
  const auto alone = sim::load_model(file);
  ASSERT_TRUE(alone) << alone.problem();
  sim::Placement first = placed("robot[0]", file, 3, -4), second = placed("robot[1]", file, -5, 6);
  first.heading_rad = 1.2;
  first.z_m = 0.5;
  second.heading_rad = -2.5;
  const sim::ComposedWorld world = loaded({first, second});
  for (const char* prefix : {"robot[0]/", "robot[1]/"}) {
    const Elements elements{**alone, *world.model, prefix};
    expect_same_bodies(elements);
    expect_same_actuators(elements);
    expect_same_constraints(elements);
  }
  const auto world_alone = sim::load_model(model("world.xml"));
  ASSERT_TRUE(world_alone);
  const Elements elements{**world_alone, *world.model, ""};
  expect_same_bodies(elements);
  const auto twice = [&](int mjModel::*count) {
    return 2 * ((**alone).*count) + (**world_alone).*count == (*world.model).*count;
  };
  for (int mjModel::*count : {&mjModel::ngeom, &mjModel::njnt, &mjModel::nu, &mjModel::neq, &mjModel::nsensor,
                              &mjModel::ntendon, &mjModel::nsite, &mjModel::ncam, &mjModel::npair,
                              &mjModel::nskin, &mjModel::na, &mjModel::nmocap, &mjModel::ntuple})
    EXPECT_TRUE(twice(count));
  EXPECT_EQ((*alone)->nmesh, world.model->nmesh);  // shared
  EXPECT_EQ((*alone)->nmat, world.model->nmat);
}

INSTANTIATE_TEST_SUITE_P(Models, ExactCopies,
                         ::testing::Values("rover.xml", "planar.xml", "arm.xml", "masses.xml", "ground.xml",
                                           "sections.xml", "meshes.xml", "composites.xml", "states.xml",
                                           "box.xml", "world.xml"),
                         [](const auto& tested) {
                           const std::string name = tested.param;
                           return name.substr(0, name.find('.'));
                         });

/// One file of a skin, in the engine's format: three vertices, a triangle, two bones.
std::string skin_file() {
  std::string bytes;
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const int count : {3, 3, 1, 2}) put(count);
  for (const int number : {0, 0, 0, 1, 0, 0, 0, 1, 0}) put(static_cast<float>(number));
  for (const int number : {0, 0, 1, 0, 0, 1}) put(static_cast<float>(number));
  for (const int vertex : {0, 1, 2}) put(vertex);
  for (const int first : {0, 1}) {
    std::string name = "bone";
    name.resize(40);
    bytes += name;
    for (const int number : {0, 0, 0, 1, 0, 0, 0}) put(static_cast<float>(number));
    put(2);
    put(first);
    put(first + 1);
    put(0.5F);
    put(1.0F);
  }
  return bytes;
}

TEST(Composition, SkinsInFilesFollowTheBonesOfTheirInstance) {
  static_cast<void>(file_with("skins/meshes/triangle.skn", skin_file()));
  const std::string file = file_with("skins/skin.xml", text_of(model("skin.xml")));
  const auto alone = sim::load_model(file);
  ASSERT_TRUE(alone) << alone.problem();
  const sim::ComposedWorld world = loaded({placed("a", file), placed("b", file, 1)});
  for (const char* name : {"inline", "filed"}) {
    const int original = mj_name2id(alone->get(), mjOBJ_SKIN, name);
    const int copy = mj_name2id(world.model.get(), mjOBJ_SKIN, (std::string("b/") + name).c_str());
    ASSERT_GE(copy, 0);
    ASSERT_EQ((*alone)->skin_vertnum[original], world.model->skin_vertnum[copy]);
    ASSERT_EQ((*alone)->skin_bonenum[original], world.model->skin_bonenum[copy]);
    for (int i = 0; i < 9; ++i)
      EXPECT_EQ((*alone)->skin_vert[3 * (*alone)->skin_vertadr[original] + i],
                world.model->skin_vert[3 * world.model->skin_vertadr[copy] + i]);
    const int bone = world.model->skin_bonebodyid[world.model->skin_boneadr[copy]];
    EXPECT_STREQ(mj_id2name(world.model.get(), mjOBJ_BODY, bone), "b/bone");
  }
}

TEST(Composition, DifferencesAreFound) {
  const auto composition = sim::compose(model("world.xml"), {placed("a", model("arm.xml"), 1, 2)});
  ASSERT_TRUE(composition) << composition.problem();
  const auto world = sim::compile_text(composition->mjcf);
  ASSERT_TRUE(world) << world.problem();
  mjModel& changed = **world;
  EXPECT_THAT(sim::differences(changed, composition->placed.front()), IsEmpty());
  const int hand = mj_name2id(&changed, mjOBJ_BODY, "a/hand");
  const int elbow = mj_name2id(&changed, mjOBJ_JOINT, "a/elbow");
  changed.body_mass[hand] *= 1 + 1e-9;
  changed.jnt_range[2 * elbow + 1] = 2;
  EXPECT_THAT(sim::differences(changed, composition->placed.front()),
              ElementsAre(::testing::StartsWith("mass of body 'hand': "),
                          ::testing::StartsWith("range of joint 'elbow': 2, not 2.09")));
}

}  // namespace
}  // namespace tessera::testing
