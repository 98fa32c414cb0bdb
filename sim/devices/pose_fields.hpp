#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sim/devices/buffer.hpp"

namespace tessera::sim {

/// A pose in a plane: x and y in metres, heading in radians from the x axis.
using PlanarPose = std::array<double, 3>;

/// The positions of the fields x, y and heading in a structure.
class PlanarFields {
 public:
  /// Throws DeviceError if the buffer has other fields.
  explicit PlanarFields(const Buffer& buffer);
  void put(const PlanarPose& pose, std::span<double> numbers) const {
    for (std::size_t field = 0; field < order_.size(); ++field) numbers[field] = pose.at(order_[field]);
  }
  /// The unit of each field of the buffer, as the world gives them.
  [[nodiscard]] std::vector<std::string> units() const {
    std::vector<std::string> all;
    for (const std::size_t part : order_) all.emplace_back(part < 2 ? "m" : "rad");
    return all;
  }

 private:
  std::vector<std::size_t> order_;  // per field of the buffer: index into PlanarPose
};

/// The units of a whole pose.
inline const std::array<std::string, 7> units_of_pose{"m", "m", "m", "", "", "", ""};

/// Whether the buffer holds a whole pose: x, y, z and a quaternion w, x, y, z.
[[nodiscard]] inline bool takes_whole_pose(const Buffer& buffer) {
  return buffer.is_real() && buffer.size() == 7;
}

}  // namespace tessera::sim
