#pragma once

#include <memory>
#include <string>
#include <utility>

#include "checks/scene.hpp"
#include "sim/judging/eyes.hpp"
#include "sim/judging/way_along_line.hpp"

namespace tessera::sim {

/// Measures how well a robot with light sensors follows the line of the track.
class LineFollower {
 public:
  LineFollower(std::string name, Physics::RootBody robot, std::shared_ptr<const Skeleton> line)
      : name_(std::move(name)), robot_(robot), line_(std::move(line)), way_(*line_) {}

  /// Adds the present instant. Throws std::runtime_error if the robot has no light sensor.
  void look(const Physics& physics, const Eyes& eyes);
  [[nodiscard]] const checks::OnLine& seen() const { return seen_; }

 private:
  std::string name_;
  Physics::RootBody robot_;
  std::shared_ptr<const Skeleton> line_;
  WayAlongLine way_;
  checks::OnLine seen_;
  double looked_at_s_ = 0;
  bool was_on_line_ = true;
};

}  // namespace tessera::sim
