#include "sim/physics.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace tessera::sim {
namespace {

/// Receives the warnings of the engine that this thread causes.
thread_local std::string* warnings = nullptr;

/// MuJoCo requires that this function does not return. Its C code has unwind tables on all Debian
/// architectures that ship it.
[[noreturn]] void on_error(const char* message) { throw std::runtime_error(message); }

void on_warning(const char* message) {
  if (warnings == nullptr) {
    std::fprintf(stderr, "MuJoCo: %s\n", message);
  } else if (warnings->empty()) {
    *warnings = message;
  }
}

/// Calls the engine. Returns its error or warning; empty: none.
template <class Call>
std::string complaint_of(Call&& call) {
  std::string text;
  warnings = &text;
  try {
    std::forward<Call>(call)();
  } catch (const std::exception& e) {
    text = e.what();
  } catch (...) {  // the engine's own exception type, which is in none of its headers
    text = "the engine gave up without saying why";
  }
  warnings = nullptr;
  return text;
}

int first_free_joint(const mjModel& model) {
  for (int j = 0; j < model.njnt; ++j) {
    if (model.jnt_type[j] == mjJNT_FREE) return j;
  }
  return -1;
}

}  // namespace

Result<std::unique_ptr<Physics>> Physics::load(const std::string& mjcf) {
  static std::mutex loading;  // the engine's parser keeps global state
  const std::scoped_lock lock(loading);
  mju_user_error = on_error;
  mju_user_warning = on_warning;
  std::array<char, 1024> message{};
  std::unique_ptr<mjModel, Release> model;
  std::unique_ptr<mjData, Release> data, view;
  std::string complaint = complaint_of([&] {
    model.reset(mj_loadXML(mjcf.c_str(), nullptr, message.data(), static_cast<int>(message.size())));
    if (model) data.reset(mj_makeData(model.get()));
    if (model) view.reset(mj_makeData(model.get()));
  });
  if (model && data && complaint.empty() && model->opt.timestep > 0.1)
    complaint = "the time step is longer than 0.1 s";
  if (!model || !data || !view || !complaint.empty()) {
    if (complaint.empty()) complaint = message.data();
    return Problem{mjcf + ": " + complaint};
  }
  return std::unique_ptr<Physics>(
      new Physics(model.release(), data.release(), view.release(), std::move(complaint)));
}

Physics::Physics(mjModel* model, mjData* data, mjData* view, std::string&& failure)
    : model_(model),
      data_(data),
      view_(view),
      failure_(std::move(failure)),
      step_(std::llround(model->opt.timestep * 1e9)),
      robot_joint_(first_free_joint(*model)) {}

void Physics::step() {
  if (!failure_.empty()) return;
  const std::string complaint = complaint_of([&] { mj_step(model_.get(), data_.get()); });
  ++steps_;
  located_ = false;
  if (complaint.empty()) return;
  std::array<char, 64> when{};
  std::snprintf(when.data(), when.size(), "the physics failed at %.3f s: ", seconds(time()));
  failure_ = when.data() + complaint;
}

/// A warning of the engine here comes again at the next step, which stops the run.
void Physics::locate() const {
  if (located_ || !failure_.empty()) return;
  std::copy_n(data_->qpos, model_->nq, view_->qpos);
  std::copy_n(data_->mocap_pos, 3 * model_->nmocap, view_->mocap_pos);
  std::copy_n(data_->mocap_quat, 4 * model_->nmocap, view_->mocap_quat);
  static_cast<void>(complaint_of([&] { mj_kinematics(model_.get(), view_.get()); }));
  located_ = true;
}

std::optional<Pose> Physics::robot() const {
  if (robot_joint_ < 0) return std::nullopt;
  return pose({model_->jnt_bodyid[robot_joint_]});
}

Pose Physics::pose(RootBody root) const {
  locate();
  const mjtNum* at = view_->xpos + 3 * root.body;
  const mjtNum* axes = view_->xmat + 9 * root.body;
  return {{at[0], at[1]}, std::atan2(axes[3], axes[0])};
}

std::string Physics::name(RootBody root) const {
  const char* name = mj_id2name(model_.get(), mjOBJ_BODY, root.body);
  return name != nullptr && *name != '\0' ? name : "body " + std::to_string(root.body);
}

Physics::RootBody Physics::root_of_site(int site) const {
  return {model_->body_rootid[model_->site_bodyid[site]]};
}

std::optional<Physics::RootBody> Physics::root_of_actuator(int actuator) const {
  const int target = model_->actuator_trnid[2 * actuator];
  if (target < 0) return std::nullopt;
  int body = 0;
  switch (model_->actuator_trntype[actuator]) {
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      body = model_->jnt_bodyid[target];
      break;
    case mjTRN_SITE:
    case mjTRN_SLIDERCRANK:
      body = model_->site_bodyid[target];
      break;
    default:
      return std::nullopt;
  }
  return RootBody{model_->body_rootid[body]};
}

void Physics::place_robot(const Pose& pose) {
  mjtNum* q = data_->qpos + model_->jnt_qposadr[robot_joint_];
  q[0] = pose.at.x_m;
  q[1] = pose.at.y_m;
  q[3] = std::cos(pose.heading_rad / 2);
  q[4] = q[5] = 0;
  q[6] = std::sin(pose.heading_rad / 2);
  located_ = false;
}

namespace {

std::optional<int> found(int id) { return id < 0 ? std::nullopt : std::optional(id); }

}  // namespace

std::optional<int> Physics::site(const std::string& name) const {
  return found(mj_name2id(model_.get(), mjOBJ_SITE, name.c_str()));
}

std::optional<int> Physics::actuator(const std::string& name) const {
  return found(mj_name2id(model_.get(), mjOBJ_ACTUATOR, name.c_str()));
}

Point Physics::site_position(int site) const {
  locate();
  return {view_->site_xpos[3 * site], view_->site_xpos[3 * site + 1]};
}

void Physics::command(int actuator, double value) { data_->ctrl[actuator] = value; }

std::vector<std::string> Physics::names(mjtObj type, int count) const {
  std::vector<std::string> all;
  for (int id = 0; id < count; ++id) {
    if (const char* name = mj_id2name(model_.get(), type, id); name != nullptr && *name != '\0')
      all.emplace_back(name);
  }
  return all;
}

}  // namespace tessera::sim
