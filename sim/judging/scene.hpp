#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "checks/scene.hpp"
#include "sim/engine/physics.hpp"
#include "sim/judging/eyes.hpp"
#include "sim/judging/line_follower.hpp"

namespace tessera::sim {

/// A world as its checks and measures see it.
///
/// A model that is placed as `robot[3]` stands for all of its bodies in contacts; its origin is that of the
/// first body of its file. A body stands for everything attached to it. Without placed models, the names of
/// the world file are used as they are.
///
/// Contacts are noted after every step, so none between two observations is missed.
class Scene final : public checks::Scene {
 public:
  /// physics, eyes: must outlive this object.
  Scene(const Physics& physics, const Eyes& eyes) : physics_(physics), eyes_(eyes) {}

  [[nodiscard]] std::vector<std::int64_t> indices_of(std::string_view name) const override;
  [[nodiscard]] std::vector<std::string> groups() const override;
  [[nodiscard]] Result<std::size_t> find(As as, const std::string& name) override;
  [[nodiscard]] std::size_t dimension_of(std::size_t sensor) const override;
  [[nodiscard]] std::array<double, 3> position(std::size_t point) override;
  [[nodiscard]] double speed(std::size_t point) override;
  [[nodiscard]] bool touched(std::size_t solid, std::size_t other) override;
  [[nodiscard]] bool touched_anything(std::size_t solid) override;
  [[nodiscard]] bool inside(std::size_t point, std::size_t zone) override;
  [[nodiscard]] double sensor(std::size_t sensor, std::size_t component) override;

  [[nodiscard]] checks::OnLine on_line(std::size_t follower) override { return followers_[follower].seen(); }

  /// Updates the line followers of the robots, before each look at them.
  void follow_lines();
  /// Notes the contacts of the last step.
  void note_contacts();
  void forget_contacts();

 private:
  struct Element {
    mjtObj type;
    int id;
  };
  /// nullopt: there is no such model, body, geom or site.
  [[nodiscard]] Result<std::optional<Element>> point_named(const std::string& name) const;
  [[nodiscard]] Result<int> root_of_model(const std::string& name, const std::vector<int>& bodies) const;
  [[nodiscard]] std::vector<int> bodies_of_model(const std::string& name) const;
  [[nodiscard]] Result<std::size_t> find_solid(const std::string& name);
  [[nodiscard]] std::vector<bool> geoms_of(const std::string& name) const;
  [[nodiscard]] Problem unknown(const char* what, const std::string& name,
                                std::initializer_list<mjtObj> types) const;
  void note_contact(int geom, int other);
  /// The state with velocities and sensors. Throws std::runtime_error if the physics fails.
  [[nodiscard]] const mjData& state() const;

  [[nodiscard]] Result<std::size_t> find_follower(const std::string& name);

  const Physics& physics_;
  const Eyes& eyes_;
  std::shared_ptr<const Skeleton> line_;  ///< of the track; nullptr: not needed yet
  std::vector<LineFollower> followers_;
  std::vector<Element> elements_;  ///< points, zones and sensors
  std::map<std::string, std::size_t> solids_;
  std::vector<std::vector<std::size_t>> solids_of_geom_;
  std::set<std::pair<std::size_t, std::size_t>> touching_;  ///< solids, the smaller number first
  std::vector<bool> touching_anything_;                     ///< per solid
};

}  // namespace tessera::sim
