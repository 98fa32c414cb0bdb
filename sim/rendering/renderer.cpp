#include "sim/rendering/renderer.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/engine/complaint.hpp"

namespace tessera::sim {
namespace {

/// Shadows as sharp as MuJoCo's default (4096) would take eight times as long as the picture.
constexpr int most_shadow_pixels = 1024;

/// Throws the complaint of the engine.
template <class Call>
void call_engine(const char* what, Call&& call) {
  if (const std::optional<Problem> complaint = complaint_of(std::forward<Call>(call)))
    throw std::runtime_error(std::string(what) + ": " + complaint->text);
}

/// Turns the rows of a picture around: OpenGL begins at the bottom.
template <class T>
void begin_at_top(std::span<T> numbers, PictureSize size) {
  const std::size_t row = numbers.size() / static_cast<std::size_t>(size.height);
  for (auto top = numbers.begin(), bottom = numbers.end() - static_cast<std::ptrdiff_t>(row); top < bottom;
       top += static_cast<std::ptrdiff_t>(row), bottom -= static_cast<std::ptrdiff_t>(row))
    std::swap_ranges(top, top + static_cast<std::ptrdiff_t>(row), bottom);
}

std::size_t number_of(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  constexpr unsigned byte = 8;
  return red + (std::size_t{green} << byte) + (std::size_t{blue} << 2 * byte);
}

}  // namespace

CameraView::CameraView(int camera, PictureSize size, PictureKind kind)
    : camera_(camera), size_(size), kind_(kind) {
  mjv_defaultScene(&scene_);
  mjv_defaultOption(&options_);
  options_.flags[mjVIS_RANGEFINDER] = 0;
  std::ranges::fill(options_.sitegroup, mjtByte{0});
}

CameraView::~CameraView() { mjv_freeScene(&scene_); }

void CameraView::make_scene(const mjModel& model, int most_geoms) {
  mjv_freeScene(&scene_);
  mjv_defaultScene(&scene_);
  mjv_makeScene(&model, &scene_, most_geoms);
  if (kind_ == PictureKind::colour) return;
  for (const int effect : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_FOG, mjRND_HAZE})
    scene_.flags[effect] = 0;
  if (kind_ != PictureKind::labels) return;
  scene_.flags[mjRND_SEGMENT] = 1;
  scene_.flags[mjRND_IDCOLOR] = 1;
}

void CameraView::look(const Physics& physics) {
  // The engine computes the scene from the state, and only reads it.
  auto& state = const_cast<mjData&>(physics.state());
  if (physics.failure()) return;
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FIXED;
  camera.fixedcamid = camera_;
  look(physics.model(), state, camera);
}

void CameraView::look(const mjModel& model, mjData& state, mjvCamera& camera) {
  constexpr int seen = mjCAT_STATIC | mjCAT_DYNAMIC;
  if (scene_.maxgeom == 0) make_scene(model, model.ngeom + 2 * model.nwrap + model.nskin + 100);
  for (;;) {
    // A full scene is a warning, and is enlarged here.
    static_cast<void>(
        complaint_of([&] { mjv_updateScene(&model, &state, &options_, nullptr, &camera, seen, &scene_); }));
    if (scene_.ngeom < scene_.maxgeom) break;
    make_scene(model, 2 * scene_.maxgeom);
  }
  if (kind_ != PictureKind::labels) return;
  bodies_.clear();
  for (const mjvGeom& geom : std::span(scene_.geoms, static_cast<std::size_t>(scene_.ngeom))) {
    if (geom.segid < 0) continue;
    bodies_.resize(std::max(bodies_.size(), static_cast<std::size_t>(geom.segid) + 2));
    bodies_[static_cast<std::size_t>(geom.segid) + 1] =
        geom.objtype == mjOBJ_GEOM ? static_cast<std::uint16_t>(model.geom_bodyid[geom.objid]) : 0;
  }
}

void CameraView::add(const mjvGeom& thing) {
  if (scene_.ngeom < scene_.maxgeom)
    scene_.geoms[scene_.ngeom++] = thing;  // look() leaves space for one
                                           // more
}

std::uint16_t CameraView::body_of(std::uint8_t red, std::uint8_t green, std::uint8_t blue) const {
  const std::size_t number = number_of(red, green, blue);
  return number < bodies_.size() ? bodies_[number] : std::uint16_t{0};
}

Renderer::~Renderer() {
  try {
    release();
  } catch (const std::exception&) {  // EGL is gone, and its resources with it
  }
}

void Renderer::release() {
  if (!resources_) return;
  const OffscreenContext::Current current(*context_);
  mjr_freeContext(resources_.get());
  resources_.reset();
}

void Renderer::make_room_for(PictureSize size) {
  const std::scoped_lock lock(mutex_);
  room_ = {std::max(room_.width, size.width), std::max(room_.height, size.height)};
}

void Renderer::prepare(const mjModel& model) {
  const std::scoped_lock lock(mutex_);
  const auto fits = [this] {
    return resources_->offWidth >= room_.width && resources_->offHeight >= room_.height;
  };
  if (resources_ && fits()) return;
  const auto& context = OffscreenContext::of_process();
  if (!context) throw std::runtime_error(context.problem());
  context_ = context->get();
  release();
  make_resources(model);
  if (!fits()) throw std::runtime_error("the renderer of this machine makes no pictures of this size");
}

void Renderer::make_resources(const mjModel& model) {
  catch_complaints();
  mjModel sized = model;  // copies the numbers; the arrays stay those of the model
  sized.vis.global.offwidth = room_.width;
  sized.vis.global.offheight = room_.height;
  sized.vis.quality.offsamples = 0;  // depths and labels of two bodies cannot be mixed
  sized.vis.quality.shadowsize = std::min(sized.vis.quality.shadowsize, most_shadow_pixels);
  std::optional<TexturesWithTrack> textures;
  if (!track_file_.png.empty()) {
    if (!track_) {
      Result<TrackPicture> loaded = TrackPicture::load(track_file_);
      if (!loaded) throw std::runtime_error(loaded.problem());
      track_ = std::move(*loaded);
    }
    track_texture_ = model.ntex;
    textures.emplace(model, *track_).lend_to(sized);
  }
  auto made = std::make_unique<mjrContext>();
  const OffscreenContext::Current current(*context_);
  mjr_defaultContext(made.get());
  call_engine("the cameras cannot be rendered", [&] { mjr_makeContext(&sized, made.get(), mjFONTSCALE_50); });
  resources_ = std::move(made);
}

template <class Read>
void Renderer::draw(CameraView& view, Read&& read) {
  const std::scoped_lock lock(mutex_);
  const OffscreenContext::Current current(*context_);
  if (track_ && view.kind() == PictureKind::colour) view.add(track_->geom(track_texture_));
  const mjrRect all{0, 0, view.size().width, view.size().height};
  call_engine("a camera cannot be rendered", [&] {
    mjr_setBuffer(mjFB_OFFSCREEN, resources_.get());
    mjr_render(all, &view.scene(), resources_.get());
    read(all);
  });
}

void Renderer::draw_colours(CameraView& view, std::span<std::uint8_t> rgb) {
  draw(view, [&](mjrRect all) { mjr_readPixels(rgb.data(), nullptr, all, resources_.get()); });
  begin_at_top(rgb, view.size());
}

void Renderer::draw_depths(CameraView& view, std::span<float> metres) {
  draw(view, [&](mjrRect all) { mjr_readPixels(nullptr, metres.data(), all, resources_.get()); });
  const auto& lens = view.scene().camera[0];
  const double near = lens.frustum_near, far = lens.frustum_far;
  for (float& depth : metres) depth = static_cast<float>(near * far / (far - depth * (far - near)));
  begin_at_top(metres, view.size());
}

}  // namespace tessera::sim
