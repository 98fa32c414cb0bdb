#pragma once

#include <functional>
#include <vector>

namespace tessera::drawing {

/// In pixels, y downwards.
struct Point {
  double x = 0, y = 0;
};

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
};

/// Cubic Bezier segments end to end: 3 n + 1 points.
using Curve = std::vector<Point>;

/// The curve without the part at its end that lies in a shape. A curve that lies in the shape
/// completely keeps one segment.
[[nodiscard]] Curve cut_at_end(Curve curve, const std::function<bool(Point)>& inside);

[[nodiscard]] Curve reversed(Curve curve);

/// The curve and a straight segment to `end`.
[[nodiscard]] Curve extended(Curve curve, Point end);

}  // namespace tessera::drawing
