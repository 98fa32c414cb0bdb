#include "sim/pose_sampler.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "sim/scene/scene.hpp"

namespace tessera::sim {

WorldScene PoseSampler::scene(const Physics& physics, const Track* floor,
                              std::span<const DriverRequest> devices) {
  const mjModel& model = physics.model();
  const std::vector<int> bodies = moving_bodies(model);
  FloorPicture picture;
  if (floor != nullptr)
    picture = {floor->width_m(), floor->height_m(), floor->width_px(), floor->height_px(), floor->pixels()};
  WorldScene scene{.glb = glb_of(model, bodies, picture), .bodies = {}};
  const std::vector<std::string> agents = agents_of_bodies(model, bodies, devices);
  for (std::size_t index = 0; index < bodies.size(); ++index) {
    scene.bodies.push_back({body_name(model, bodies[index]), agents[index]});
    for (int above = model.body_parentid[bodies[index]]; above != 0; above = model.body_parentid[above]) {
      const auto found = std::ranges::find(bodies, above);
      if (found == bodies.end()) continue;
      scene.bodies.back().parent = static_cast<std::size_t>(found - bodies.begin());
      break;
    }
  }
  return scene;
}

void PoseSampler::look(const Physics& physics) {
  if (sink_ == nullptr || physics.time() < next_ || physics.failure()) return;
  next_ = (physics.time() / pose_period + 1) * pose_period;
  if (bodies_.empty()) bodies_ = moving_bodies(physics.model());
  read_poses(physics.positions(), bodies_, poses_);
  sink_->take(Time(physics.time()), poses_);
}

}  // namespace tessera::sim
