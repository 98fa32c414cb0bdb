#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "sim/engine/physics.hpp"
#include "sim/track.hpp"

namespace tessera::sim {

/// The light sensors of a world, and the floor that they look at.
class Eyes {
 public:
  struct Eye {
    int site = 0;
    double footprint_m = 0;
  };
  /// floor: nullopt means white everywhere.
  explicit Eyes(std::optional<Track> floor) : floor_(std::move(floor)) {}

  /// Returns its number.
  [[nodiscard]] std::size_t add(Eye eye);
  [[nodiscard]] const std::vector<Eye>& all() const { return all_; }
  [[nodiscard]] const Track* floor() const { return floor_ ? &*floor_ : nullptr; }

  /// 0 dark .. 1 bright, without noise.
  [[nodiscard]] double light_under(const Physics& physics, std::size_t eye) const;

  /// The combined readings of one robot's eyes.
  struct Look {
    Point middle;          ///< of the middle eye
    bool on_line = false;  ///< whether any of them is over the line
  };
  /// robot: nullopt means all eyes. nullopt: there are none.
  [[nodiscard]] std::optional<Look> look(const Physics& physics,
                                         std::optional<Physics::RootBody> robot) const;

 private:
  std::optional<Track> floor_;
  std::vector<Eye> all_;
};

}  // namespace tessera::sim
