#include "drawing/geometry.hpp"

#include <algorithm>
#include <array>

namespace tessera::drawing {
namespace {

Point between(Point a, Point b, double t) { return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; }

/// The segment up to parameter t, by de Casteljau's algorithm.
std::array<Point, 4> head(const Point* p, double t) {
  const Point a = between(p[0], p[1], t), b = between(p[1], p[2], t), c = between(p[2], p[3], t);
  const Point d = between(a, b, t), e = between(b, c, t);
  return {p[0], a, d, between(d, e, t)};
}

/// The largest sampled parameter outside the shape, refined; negative if the whole segment is inside.
double last_outside(const Point* segment, const std::function<bool(Point)>& inside) {
  constexpr int samples = 32;
  for (int sample = samples; sample >= 0; --sample) {
    double outside = double(sample) / samples;
    if (inside(head(segment, outside)[3])) continue;
    double within = std::min(1.0, outside + 1.0 / samples);
    for (int step = 0; step < 20; ++step) {
      const double middle = (outside + within) / 2;
      (inside(head(segment, middle)[3]) ? within : outside) = middle;
    }
    return outside;
  }
  return -1;
}

}  // namespace

Curve cut_at_end(Curve curve, const std::function<bool(Point)>& inside) {
  while (curve.size() >= 4) {
    const Point* segment = curve.data() + curve.size() - 4;
    const double t = last_outside(segment, inside);
    if (t >= 0) {
      const std::array<Point, 4> kept = head(segment, t);
      std::ranges::copy(kept, curve.end() - 4);
      return curve;
    }
    if (curve.size() == 4) return curve;
    curve.resize(curve.size() - 3);
  }
  return curve;
}

Curve reversed(Curve curve) {
  std::ranges::reverse(curve);
  return curve;
}

Curve extended(Curve curve, Point end) {
  const Point start = curve.back();
  curve.push_back(between(start, end, 1.0 / 3));
  curve.push_back(between(start, end, 2.0 / 3));
  curve.push_back(end);
  return curve;
}

}  // namespace tessera::drawing
