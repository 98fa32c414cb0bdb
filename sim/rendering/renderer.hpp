#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sim/engine/physics.hpp"
#include "sim/rendering/offscreen.hpp"
#include "sim/rendering/track_picture.hpp"

namespace tessera::sim {

struct PictureSize {
  int width = 0, height = 0;
  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};
inline constexpr int longest_side = 4096;  ///< of a picture, in pixels

enum class PictureKind : std::uint8_t {
  colour,
  depth,
  labels  ///< every body in a colour of its own, without light
};

/// The view of one camera of a world, drawn by a Renderer. It leaves out sites, range finders and geoms of
/// the groups 3 to 5.
class CameraView {
 public:
  CameraView(int camera, PictureSize size, PictureKind kind);
  CameraView(const CameraView&) = delete;
  CameraView& operator=(const CameraView&) = delete;
  ~CameraView();

  /// Copies the poses of all bodies. Does not change the physics.
  void look(const Physics& physics);
  /// The same for any camera. state: the engine only reads it.
  void look(const mjModel& model, mjData& state, mjvCamera& camera);
  /// Adds one more object, until the view looks again.
  void add(const mjvGeom& thing);

  [[nodiscard]] PictureSize size() const { return size_; }
  [[nodiscard]] PictureKind kind() const { return kind_; }
  [[nodiscard]] mjvScene& scene() { return scene_; }
  /// The body whose colour is (red, green, blue) in a picture of the kind `labels`.
  /// 0: the world, a skin, a tendon, or nothing.
  [[nodiscard]] std::uint16_t body_of(std::uint8_t red, std::uint8_t green, std::uint8_t blue) const;

 private:
  void make_scene(const mjModel& model, int most_geoms);

  int camera_;
  PictureSize size_;
  PictureKind kind_;
  mjvScene scene_{};
  mjvOption options_{};
  std::vector<std::uint16_t> bodies_;  // by the number that the engine gives each drawn object
};

/// Draws the pictures of all cameras of one world.
///
/// Threads: any.
class Renderer {
 public:
  /// track: a track that pictures in colour show.
  explicit Renderer(TrackFile track = {}) : track_file_(std::move(track)) {}
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  ~Renderer();

  /// Announces a picture size that will be drawn.
  void make_room_for(PictureSize size);
  /// Uploads meshes and textures. Call it before `draw`, without concurrent changes of the model. Throws
  /// std::runtime_error if this machine cannot render, or the picture of the track cannot be read.
  void prepare(const mjModel& model);

  /// Draws the view as it was at its last look, rows from the top. Three numbers a pixel. Draws once per
  /// look.
  void draw_colours(CameraView& view, std::span<std::uint8_t> rgb);
  /// Depths in metres along the direction of the camera. Objects beyond the far clipping plane, and empty
  /// pixels, have the distance of that plane.
  void draw_depths(CameraView& view, std::span<float> metres);

 private:
  void release();
  void make_resources(const mjModel& model);
  template <class Read>
  void draw(CameraView& view, Read&& read);

  std::mutex mutex_;
  PictureSize room_;
  TrackFile track_file_;
  std::optional<TrackPicture> track_;  // loaded at its first use
  int track_texture_ = -1;
  OffscreenContext* context_ = nullptr;
  std::unique_ptr<mjrContext> resources_;  // nullptr: not prepared
};

}  // namespace tessera::sim
