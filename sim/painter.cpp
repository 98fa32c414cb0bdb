#include "sim/painter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/devices/device_error.hpp"
#include "sim/engine/elements.hpp"
#include "sim/placed_world.hpp"
#include "sim/rendering/renderer.hpp"
#include "sim/scene/scene.hpp"

namespace tessera::sim {
namespace {

/// Pictures are drawn larger and made smaller, so that edges are smooth.
constexpr int finer = 2;

struct RigidFrame {
  std::array<mjtNum, 3> position{};
  std::array<mjtNum, 4> rotation{1, 0, 0, 0};
};

[[nodiscard]] RigidFrame frame_of(const mjData& data, int body) {
  RigidFrame frame;
  std::copy_n(data.xpos + 3 * body, 3, frame.position.begin());
  std::copy_n(data.xquat + 4 * body, 4, frame.rotation.begin());
  return frame;
}

/// `inner` is given in `outer`.
[[nodiscard]] RigidFrame within(const RigidFrame& outer, const RigidFrame& inner) {
  RigidFrame all;
  mju_rotVecQuat(all.position.data(), inner.position.data(), outer.rotation.data());
  mju_addTo3(all.position.data(), outer.position.data());
  mju_mulQuat(all.rotation.data(), outer.rotation.data(), inner.rotation.data());
  return all;
}

[[nodiscard]] RigidFrame seen_from(const RigidFrame& outer, const RigidFrame& inner) {
  RigidFrame from;
  std::array<mjtNum, 3> way{};
  std::array<mjtNum, 4> back{};
  mju_negQuat(back.data(), outer.rotation.data());
  mju_sub3(way.data(), inner.position.data(), outer.position.data());
  mju_rotVecQuat(from.position.data(), way.data(), back.data());
  mju_mulQuat(from.rotation.data(), back.data(), inner.rotation.data());
  return from;
}

/// Computes the engine's frame of an object that is fixed to a body.
void put_frame(const RigidFrame& body, const mjtNum* position, const mjtNum* rotation, mjtNum* xpos,
               mjtNum* xmat) {
  RigidFrame own;
  std::copy_n(position, 3, own.position.begin());
  std::copy_n(rotation, 4, own.rotation.begin());
  const RigidFrame frame = within(body, own);
  std::ranges::copy(frame.position, xpos);
  mju_quat2Mat(xmat, frame.rotation.data());
}

class Painter final : public WorldPainter {
 public:
  Painter(std::unique_ptr<Physics> physics, std::vector<int> bodies, const PictureOptions& picture,
          int camera, TrackFile track)
      : physics_(std::move(physics)),
        data_(mj_makeData(&model())),
        bodies_(std::move(bodies)),
        size_{picture.width, picture.height},
        view_(-1, {picture.width * finer, picture.height * finer}, PictureKind::colour),
        renderer_(std::move(track)) {
    if (data_ == nullptr) throw std::runtime_error("the engine cannot make the state of the world");
    const mjData& start = physics_->positions();
    std::copy_n(start.qpos, model().nq, data_->qpos);
    std::copy_n(start.mocap_pos, 3 * model().nmocap, data_->mocap_pos);
    std::copy_n(start.mocap_quat, 4 * model().nmocap, data_->mocap_quat);
    mj_kinematics(&model(), data_.get());
    attach_bodies();
    aim(picture, camera);
    renderer_.make_room_for(view_.size());
    renderer_.prepare(model());
    pixels_.resize(3 * view_.size().pixels());
  }

  void paint(std::span<const BodyPose> poses, std::span<std::uint8_t> rgb) override {
    if (poses.size() != bodies_.size() || rgb.size() != 3 * size_.pixels())
      throw std::runtime_error("a picture of another size, or of other bodies, was asked for");
    move_to(poses);
    view_.look(model(), *data_, camera_);
    renderer_.draw_colours(view_, pixels_);
    make_smaller(rgb);
  }

 private:
  [[nodiscard]] const mjModel& model() const { return physics_->model(); }

  /// A body that is not in the recording does not move, or is attached to one that is recorded.
  void attach_bodies() {
    attached_bodies_.resize(static_cast<std::size_t>(model().nbody));
    for (int body = 0; body < model().nbody; ++body) {
      AttachedBody& attached = attached_bodies_[static_cast<std::size_t>(body)];
      int on = body;
      auto found = std::ranges::find(bodies_, on);
      while (found == bodies_.end() && on != 0) {
        on = model().body_parentid[on];
        found = std::ranges::find(bodies_, on);
      }
      if (found != bodies_.end()) attached.recorded = static_cast<std::size_t>(found - bodies_.begin());
      attached.there = attached.recorded ? seen_from(frame_of(*data_, on), frame_of(*data_, body))
                                         : frame_of(*data_, body);
    }
  }

  void aim(const PictureOptions& picture, int camera) {
    mjv_defaultCamera(&camera_);
    if (camera >= 0) {
      camera_.type = mjCAMERA_FIXED;
      camera_.fixedcamid = camera;
      return;
    }
    camera_.type = mjCAMERA_FREE;
    std::ranges::copy(picture.middle_m, camera_.lookat);
    camera_.azimuth = 90;  // x to the right
    camera_.elevation = picture.elevation_deg;
    const double up = static_cast<double>(model().vis.global.fovy) / 2 * std::numbers::pi / 180;
    const double aspect = static_cast<double>(picture.width) / picture.height;
    const double least = std::min(up, std::atan(std::tan(up) * aspect));
    // Moving objects are usually low and seen at a slant: in a wide picture, the sphere may exceed the edges
    // a little.
    constexpr double wide = 1.4, nearer = 0.8;
    camera_.distance = std::max(picture.radius_m, 0.01) / std::sin(least) * (aspect >= wide ? nearer : 1);
  }

  void move_to(std::span<const BodyPose> poses) {
    mjData& data = *data_;
    for (int body = 0; body < model().nbody; ++body) {
      const AttachedBody& attached = attached_bodies_[static_cast<std::size_t>(body)];
      RigidFrame frame = attached.there;
      if (attached.recorded) {
        const BodyPose& pose = poses[*attached.recorded];
        RigidFrame of_pose;
        std::ranges::copy(pose.position_m, of_pose.position.begin());
        std::ranges::copy(pose.rotation, of_pose.rotation.begin());
        frame = within(of_pose, attached.there);
      }
      std::ranges::copy(frame.position, data.xpos + 3 * body);
      std::ranges::copy(frame.rotation, data.xquat + 4 * body);
      mju_quat2Mat(data.xmat + 9 * body, frame.rotation.data());
      put_frame(frame, model().body_ipos + 3 * body, model().body_iquat + 4 * body, data.xipos + 3 * body,
                data.ximat + 9 * body);
    }
    for (int geom = 0; geom < model().ngeom; ++geom)
      put_frame(frame_of(data, model().geom_bodyid[geom]), model().geom_pos + 3 * geom,
                model().geom_quat + 4 * geom, data.geom_xpos + 3 * geom, data.geom_xmat + 9 * geom);
    for (int site = 0; site < model().nsite; ++site)
      put_frame(frame_of(data, model().site_bodyid[site]), model().site_pos + 3 * site,
                model().site_quat + 4 * site, data.site_xpos + 3 * site, data.site_xmat + 9 * site);
    mj_comPos(&model(), &data);
    mj_camlight(&model(), &data);
    mj_tendon(&model(), &data);
  }

  void make_smaller(std::span<std::uint8_t> rgb) const {
    const auto width = static_cast<std::size_t>(size_.width), wide = 3 * width * finer;
    for (std::size_t y = 0; y < static_cast<std::size_t>(size_.height); ++y)
      for (std::size_t x = 0; x < width; ++x)
        for (std::size_t colour = 0; colour < 3; ++colour) {
          const std::size_t at = finer * y * wide + 3 * finer * x + colour;
          const unsigned sum = pixels_[at] + pixels_[at + 3] + pixels_[at + wide] + pixels_[at + wide + 3];
          rgb[3 * (y * width + x) + colour] = static_cast<std::uint8_t>((sum + 2) / 4);
        }
  }

  /// The pose of a body, relative to one whose pose is recorded; otherwise in the world.
  struct AttachedBody {
    std::optional<std::size_t> recorded;
    RigidFrame there;
  };
  std::unique_ptr<Physics> physics_;
  DataPtr data_;
  std::vector<int> bodies_;
  std::vector<AttachedBody> attached_bodies_;
  PictureSize size_;
  mjvCamera camera_{};
  CameraView view_;
  Renderer renderer_;
  std::vector<std::uint8_t> pixels_;
};

[[nodiscard]] std::optional<Problem> other_bodies(const mjModel& model, std::span<const int> bodies,
                                                  const std::vector<std::string>& recorded) {
  std::vector<std::string> names;
  for (const int body : bodies) names.push_back(body_name(model, body));
  if (names == recorded) return std::nullopt;
  return Problem{
      fmt::format("the world has changed since the run: it has {} bodies that can move ({}), and the "
                  "recording {} ({})",
                  names.size(), short_list(names), recorded.size(), short_list(recorded))};
}

/// -1: no camera is named.
[[nodiscard]] Result<int> camera_of(const mjModel& model, const std::string& name) {
  if (name.empty()) return -1;
  if (const auto id = find_element(model, mjOBJ_CAMERA, "", name)) return *id;
  const std::vector<std::string> known = names_of(model, mjOBJ_CAMERA);
  if (known.empty()) return Problem{"the world has no camera '" + name + "', and no other one"};
  const DriverProblem problem = unknown_name(word_for(mjOBJ_CAMERA), name, known);
  return Problem{problem.text + "; " + problem.hint};
}

}  // namespace

Result<std::unique_ptr<WorldPainter>> open_painter(const WorldOptions& options,
                                                   const PictureOptions& picture) {
  if (picture.width < 1 || picture.height < 1 || picture.width * finer > longest_side ||
      picture.height * finer > longest_side)
    return Problem{fmt::format("a picture has at most {0} x {0} pixels", longest_side / finer)};
  auto physics = physics_of(options);
  if (!physics) return Problem{physics.problem()};
  const mjModel& model = (*physics)->model();
  std::vector<int> bodies = moving_bodies(model);
  if (auto problem = other_bodies(model, bodies, picture.bodies)) return std::move(*problem);
  const Result<int> camera = camera_of(model, picture.camera);
  if (!camera) return Problem{camera.problem()};
  return std::unique_ptr<WorldPainter>(
      std::make_unique<Painter>(std::move(*physics), std::move(bodies), picture, *camera,
                                TrackFile{options.track, options.metres_per_pixel}));
}

}  // namespace tessera::sim
