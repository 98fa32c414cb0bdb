#include "sim/engine/physics.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sim/engine/complaint.hpp"

namespace tessera::sim {
namespace {

int first_free_joint(const mjModel& model) {
  for (int j = 0; j < model.njnt; ++j) {
    if (model.jnt_type[j] == mjJNT_FREE) return j;
  }
  return -1;
}

void copy(const std::vector<mjtNum>& from, mjtNum* to) { std::copy(from.begin(), from.end(), to); }

/// Copies the inputs and the state, and none of the computed values.
void copy_state(const mjModel& model, const mjData& from, mjData& to) {
  to.time = from.time;
  std::copy_n(from.qpos, model.nq, to.qpos);
  std::copy_n(from.qvel, model.nv, to.qvel);
  std::copy_n(from.act, model.na, to.act);
  std::copy_n(from.qacc_warmstart, model.nv, to.qacc_warmstart);
  std::copy_n(from.ctrl, model.nu, to.ctrl);
  std::copy_n(from.mocap_pos, 3 * model.nmocap, to.mocap_pos);
  std::copy_n(from.mocap_quat, 4 * model.nmocap, to.mocap_quat);
  std::copy_n(from.qfrc_applied, model.nv, to.qfrc_applied);
  std::copy_n(from.xfrc_applied, 6 * model.nbody, to.xfrc_applied);
  std::copy_n(from.userdata, model.nuserdata, to.userdata);
}

/// Whether the engine has noted that contacts or constraints are missing. Its other complaints then are
/// consequences.
bool lacks_room(const mjData& data) {
  return data.warning[mjWARN_CONTACTFULL].number > 0 || data.warning[mjWARN_CNSTRFULL].number > 0;
}

bool is_stack_overflow(const std::string& complaint) {
  return complaint.find("tack overflow") != std::string::npos;
}

}  // namespace

Result<std::unique_ptr<Physics>> Physics::load(const std::string& mjcf) {
  auto model = load_model(mjcf);
  if (!model) return Problem{model.problem()};
  return of(std::move(*model), mjcf);
}

Result<std::unique_ptr<Physics>> Physics::of(ModelPtr model, const std::string& name) {
  catch_complaints();
  DataPtr data, view;
  const std::optional<Problem> complaint = complaint_of([&] {
    data.reset(mj_makeData(model.get()));
    view.reset(mj_makeData(model.get()));
  });
  if (!complaint && data && view)
    return std::unique_ptr<Physics>(new Physics(std::move(model), std::move(data), std::move(view)));
  return Problem{name + ": " + (complaint ? complaint->text : "there is no memory for its state")};
}

/// Sensors are computed only for readers. Their noise would come from a generator that the whole process
/// shares; devices add their own.
Physics::Physics(ModelPtr model, DataPtr data, DataPtr view)
    : model_(std::move(model)),
      data_(std::move(data)),
      view_(std::move(view)),
      commands_(static_cast<std::size_t>(model_->nu)),
      kept_{std::vector<mjtNum>(static_cast<std::size_t>(model_->nq)),
            std::vector<mjtNum>(static_cast<std::size_t>(model_->nv)),
            std::vector<mjtNum>(static_cast<std::size_t>(model_->na)),
            std::vector<mjtNum>(static_cast<std::size_t>(model_->nv))},
      step_(std::llround(model_->opt.timestep * 1e9)),
      robot_joint_(first_free_joint(*model_)) {
  model_->opt.disableflags |= mjDSBL_SENSOR;
  model_->opt.enableflags &= ~static_cast<int>(mjENBL_SENSORNOISE);
}

void Physics::start_with(const std::function<void(const mjModel& model, mjData& data)>& set) {
  set(*model_, *data_);
  std::copy_n(data_->ctrl, model_->nu, commands_.begin());
  known_ = View::old;
}

void Physics::step() {
  if (failure_) return;
  apply_commands();
  if (failure_) return;
  keep_state();
  const std::optional<Problem> complaint = in_buffers_that_suffice([this] {
    restore_state();
    mj_step(model_.get(), data_.get());
  });
  wrap_positions();
  ++steps_;
  known_ = View::old;
  if (complaint) fail(*complaint);
}

void Physics::wrap_positions() {
  for (const auto& [place, length] : wraps_)
    if (mjtNum& position = data_->qpos[place]; std::abs(position) > length)
      position = std::fmod(position, length);
}

void Physics::apply_commands() {
  for (const std::vector<Change> changes = std::exchange(changes_, {}); const Change& change : changes) {
    const mjData& now = positions();
    if (const auto complaint = complaint_of([&] { change(*model_, *data_, now); })) return fail(*complaint);
    known_ = View::old;
  }
  copy(commands_, data_->ctrl);
}

void Physics::keep_state() {
  std::copy_n(data_->qpos, model_->nq, kept_.qpos.begin());
  std::copy_n(data_->qvel, model_->nv, kept_.qvel.begin());
  std::copy_n(data_->act, model_->na, kept_.act.begin());
  std::copy_n(data_->qacc_warmstart, model_->nv, kept_.warmstart.begin());
  kept_.time = data_->time;
}

void Physics::restore_state() {
  copy(kept_.qpos, data_->qpos);
  copy(kept_.qvel, data_->qvel);
  copy(kept_.act, data_->act);
  copy(kept_.warmstart, data_->qacc_warmstart);
  data_->time = kept_.time;
}

std::optional<Problem> Physics::in_buffers_that_suffice(const std::function<void()>& compute) const {
  for (;;) {
    std::optional<Problem> complaint = complaint_of(compute);
    if (!complaint) return std::nullopt;
    const mjData* const full = lacks_room(*data_) ? data_.get() : lacks_room(*view_) ? view_.get() : nullptr;
    const bool stack = full == nullptr && is_stack_overflow(complaint->text);
    if (full == nullptr && !stack) return complaint;
    if (const std::optional<Problem> why = grow(stack ? *data_ : *full, stack))
      return Problem{complaint->text + "; " + why->text};
  }
}

std::optional<Problem> Physics::grow(const mjData& full, bool stack) const {
  // The memory of constraints grows with the square of their number: 0.84 GB for 8000.
  constexpr int most_contacts = 20'000, most_constraints = 8'000, most_stack = 200'000'000;
  const bool contacts = full.warning[mjWARN_CONTACTFULL].number > 0;
  const bool constraints = full.warning[mjWARN_CNSTRFULL].number > 0;
  const auto doubled = [](int& size, int most) {
    if (size >= most) return false;
    size = std::min(most, std::max(2 * size, 100));
    return true;
  };
  const auto too_many = [](const char* what, int most) {
    return Problem{std::string("a world may have at most ") + std::to_string(most) + " " + what};
  };
  if (contacts && !doubled(model_->nconmax, most_contacts)) return too_many("contacts", most_contacts);
  if (constraints) {
    if (!doubled(model_->njmax, most_constraints)) return too_many("rows of constraints", most_constraints);
    // The same choice as the engine's compiler.
    const double rows = model_->njmax + model_->neq + model_->nv;
    model_->nstack =
        std::max(model_->nstack, static_cast<int>(std::min<double>(most_stack, 5 * rows * rows)));
  }
  if (stack && !doubled(model_->nstack, most_stack))
    return too_many("numbers on the engine's stack", most_stack);
  DataPtr data, view;
  std::optional<Problem> complaint = complaint_of([&] {
    data.reset(mj_makeData(model_.get()));
    view.reset(mj_makeData(model_.get()));
  });
  if (complaint) return complaint;
  if (!data || !view) return Problem{"there is no memory for larger buffers"};
  copy_state(*model_, *data_, *data);
  data_ = std::move(data);
  view_ = std::move(view);
  known_ = View::old;
  return std::nullopt;
}

void Physics::fail(const Problem& complaint) const {
  std::array<char, 64> when{};
  std::snprintf(when.data(), when.size(), "the physics failed at %.3f s: ", seconds(time()));
  failure_ = Problem{when.data() + complaint.text};
}

void Physics::copy_state_to_view() const { copy_state(*model_, *data_, *view_); }

/// A warning of the engine here appears again at the next step, which stops the run.
const mjData& Physics::positions() const {
  if (known_ != View::old || failure_) return *view_;
  copy_state_to_view();
  static_cast<void>(complaint_of([&] { mj_kinematics(model_.get(), view_.get()); }));
  known_ = View::positions;
  return *view_;
}

/// The state is copied again, so that the result does not depend on an earlier call of positions().
const mjData& Physics::state() const {
  if (known_ == View::all || failure_) return *view_;
  const std::optional<Problem> complaint = in_buffers_that_suffice([this] {
    copy_state_to_view();
    model_->opt.disableflags &= ~static_cast<int>(mjDSBL_SENSOR);
    const struct SensorsOff {
      mjModel& model;
      ~SensorsOff() { model.opt.disableflags |= mjDSBL_SENSOR; }
    } off{*model_};
    mj_forward(model_.get(), view_.get());
  });
  known_ = View::all;
  if (complaint) fail(*complaint);
  return *view_;
}

std::optional<Pose> Physics::robot() const {
  if (robot_joint_ < 0) return std::nullopt;
  return pose({model_->jnt_bodyid[robot_joint_]});
}

Pose Physics::pose(RootBody root) const {
  const mjData& now = positions();
  const mjtNum* at = now.xpos + 3 * root.body;
  const mjtNum* axes = now.xmat + 9 * root.body;
  return {{at[0], at[1]}, std::atan2(axes[3], axes[0])};
}

std::string Physics::name(RootBody root) const {
  const char* name = mj_id2name(model_.get(), mjOBJ_BODY, root.body);
  return name != nullptr && *name != '\0' ? name : "body " + std::to_string(root.body);
}

std::optional<Physics::RootBody> Physics::root_of_actuator(int actuator) const {
  const int target = model_->actuator_trnid[2 * actuator];
  if (target < 0) return std::nullopt;
  switch (model_->actuator_trntype[actuator]) {
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      return root_of_body(model_->jnt_bodyid[target]);
    case mjTRN_SITE:
    case mjTRN_SLIDERCRANK:
      return root_of_site(target);
    case mjTRN_BODY:
      return root_of_body(target);
    default:
      return std::nullopt;
  }
}

void Physics::place_robot(const Pose& pose) {
  mjtNum* q = data_->qpos + model_->jnt_qposadr[robot_joint_];
  q[0] = pose.at.x_m;
  q[1] = pose.at.y_m;
  q[3] = std::cos(pose.heading_rad / 2);
  q[4] = q[5] = 0;
  q[6] = std::sin(pose.heading_rad / 2);
  known_ = View::old;
}

Point Physics::site_position(int site) const {
  const mjData& now = positions();
  return {now.site_xpos[3 * site], now.site_xpos[3 * site + 1]};
}

}  // namespace tessera::sim
