#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace scout {

/// The free space around a rover, from a scan.
struct Room {
  double free_m = 0;   ///< how far it may drive ahead
  double left_m = 0;   ///< mean distance on the left, in front of it
  double right_m = 0;  ///< the same on the right
};

/// ranges: all around in equal steps, from behind by the right.
/// gap_m: the distance to keep, from hull to hull.
///
/// A rover only drives ahead, so objects behind it do not count. Near objects beside it stop it, too: they
/// may be other rovers that come closer.
inline Room room_around(std::span<const float> ranges, double gap_m) {
  constexpr double radius_m = 0.1;
  Room room{10, 0, 0};
  int left = 0, right = 0;
  for (std::size_t ray = 0; ray < ranges.size(); ++ray) {
    const double angle =
        (2.0 * static_cast<double>(ray) / static_cast<double>(ranges.size()) - 1) * std::numbers::pi;
    if (std::abs(angle) > 1.8) continue;
    const double distance = ranges[ray];
    const double ahead = distance * std::cos(angle), aside = std::abs(distance * std::sin(angle));
    if (std::abs(angle) < 1.5 && distance < radius_m + gap_m) room.free_m = std::min(room.free_m, 0.0);
    if (ahead > 0 && aside < radius_m + gap_m) room.free_m = std::min(room.free_m, ahead - radius_m - gap_m);
    (angle > 0 ? room.left_m : room.right_m) += distance;
    ++(angle > 0 ? left : right);
  }
  room.left_m /= std::max(left, 1);
  room.right_m /= std::max(right, 1);
  return room;
}

}  // namespace scout
