#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/result.hpp"

namespace tessera::checks {

/// How a robot keeps to the line of a track.
struct OnLine {
  double laps = 0;     ///< its progress along the line, in either direction, by the length of the line
  double error_m = 0;  ///< of its middle light sensor from the line
  double lost_s = 0;   ///< for how long none of its light sensors has been over the line
};

/// The simulated world as checks and measures see it. Elements are looked up once, and then have numbers.
class Scene {
 public:
  virtual ~Scene() = default;

  /// The indices of the models that were placed as NAME[0], NAME[1], ... in ascending order.
  [[nodiscard]] virtual std::vector<std::int64_t> indices_of(std::string_view name) const = 0;

  /// "robot[*]" for each NAME of that kind.
  [[nodiscard]] virtual std::vector<std::string> groups() const = 0;

  /// The quantity that an element is asked for.
  enum class As : std::uint8_t {
    point,    ///< a model, body, geom or site, whose origin is somewhere
    solid,    ///< a model, body or geom, which may touch others
    zone,     ///< a site, which has a volume
    sensor,   ///< a sensor
    follower  ///< a model or body that has light sensors over a track
  };
  /// Problem: there is no such element; with a list of existing ones.
  [[nodiscard]] virtual Result<std::size_t> find(As as, const std::string& name) = 0;
  /// How many numbers a sensor gives.
  [[nodiscard]] virtual std::size_t dimension_of(std::size_t sensor) const = 0;

  // The state of this instant. In m and m/s, in the frame of the world.
  [[nodiscard]] virtual std::array<double, 3> position(std::size_t point) = 0;
  [[nodiscard]] virtual double speed(std::size_t point) = 0;
  /// Whether the two solids have touched since the last instant that was looked at.
  [[nodiscard]] virtual bool touched(std::size_t solid, std::size_t other) = 0;
  [[nodiscard]] virtual bool touched_anything(std::size_t solid) = 0;
  [[nodiscard]] virtual bool inside(std::size_t point, std::size_t zone) = 0;
  [[nodiscard]] virtual OnLine on_line(std::size_t follower) = 0;
  [[nodiscard]] virtual double sensor(std::size_t sensor, std::size_t component) = 0;
};

}  // namespace tessera::checks
