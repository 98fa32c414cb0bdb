#include "sim/scene/shapes.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace tessera::sim {
namespace {

using Vector = std::array<double, 3>;

// Few triangles, because a page without a graphics card draws them one by one.
constexpr int around = 20, rings = 10;

struct Ring {
  double radius, z, normal_radius, normal_z;
};

/// A surface of revolution about z, from the bottom to the top.
void add_rings(Shape& shape, const std::vector<Ring>& all) {
  const auto first = static_cast<std::uint32_t>(shape.positions.size() / 3);
  for (const Ring& ring : all)
    for (int at = 0; at <= around; ++at) {
      const double angle = 2 * std::numbers::pi * at / around;
      const double c = std::cos(angle), s = std::sin(angle);
      shape.add({ring.radius * c, ring.radius * s, ring.z},
                {ring.normal_radius * c, ring.normal_radius * s, ring.normal_z});
    }
  constexpr std::uint32_t stride = around + 1;
  for (std::uint32_t ring = 0; ring + 1 < all.size(); ++ring)
    for (std::uint32_t at = 0; at < around; ++at) {
      const std::uint32_t low = first + ring * stride + at, high = low + stride;
      if (all[ring].radius > 0) shape.add_triangle(low, low + 1, high + 1);
      if (all[ring + 1].radius > 0) shape.add_triangle(low, high + 1, high);
    }
}

/// The rings from one latitude to another, on a sphere about (0, 0, z).
std::vector<Ring> sphere_rings(double radius, double z, int from, int to) {
  std::vector<Ring> all;
  for (int ring = from; ring <= to; ++ring) {
    const double latitude = std::numbers::pi * (static_cast<double>(ring) / rings - 0.5);
    const bool is_pole = ring == 0 || ring == rings;
    const double c = is_pole ? 0 : std::cos(latitude), s = std::sin(latitude);
    all.push_back({radius * c, z + radius * s, c, s});
  }
  return all;
}

void add_disc(Shape& shape, double z, double up) {
  const std::uint32_t middle = shape.add({0, 0, z}, {0, 0, up});
  for (int at = 0; at <= around; ++at) {
    const double angle = 2 * std::numbers::pi * at / around;
    shape.add({std::cos(angle), std::sin(angle), z}, {0, 0, up});
  }
  for (std::uint32_t at = 1; at <= around; ++at) {
    if (up > 0)
      shape.add_triangle(middle, middle + at, middle + at + 1);
    else
      shape.add_triangle(middle, middle + at + 1, middle + at);
  }
}

/// A quadrilateral; its corners are counterclockwise, seen from the side of the normal.
void add_side(Shape& shape, const std::array<Vector, 4>& corners, const Vector& normal) {
  const std::uint32_t first = shape.add(corners[0], normal);
  for (std::size_t at = 1; at < corners.size(); ++at) shape.add(corners[at], normal);
  shape.add_triangle(first, first + 1, first + 2);
  shape.add_triangle(first, first + 2, first + 3);
}

Vector unit(const Vector& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return length > 0 ? Vector{v[0] / length, v[1] / length, v[2] / length} : Vector{0, 0, 1};
}

}  // namespace

std::uint32_t Shape::add(const Vector& position, const Vector& normal) {
  for (const double part : position) positions.push_back(static_cast<float>(part));
  for (const double part : normal) normals.push_back(static_cast<float>(part));
  return static_cast<std::uint32_t>(positions.size() / 3 - 1);
}

void Shape::add_triangle(std::uint32_t one, std::uint32_t two, std::uint32_t three) {
  indices.insert(indices.end(), {one, two, three});
}

Shape unit_box() {
  Shape box;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const std::size_t right = (axis + 1) % 3, up = (axis + 2) % 3;
      std::array<Vector, 4> corners{};
      constexpr std::array<std::array<double, 2>, 4> square{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
      for (std::size_t at = 0; at < corners.size(); ++at) {
        corners[at][axis] = side;
        corners[at][right] = square[at][0] * side;
        corners[at][up] = square[at][1];
      }
      Vector normal{};
      normal[axis] = side;
      add_side(box, corners, normal);
    }
  return box;
}

Shape unit_sphere() {
  Shape sphere;
  add_rings(sphere, sphere_rings(1, 0, 0, rings));
  return sphere;
}

Shape unit_cylinder() {
  Shape cylinder;
  add_rings(cylinder, {{1, -1, 1, 0}, {1, 1, 1, 0}});
  add_disc(cylinder, 1, 1);
  add_disc(cylinder, -1, -1);
  return cylinder;
}

Shape capsule(double radius, double half_length) {
  Shape shape;
  std::vector<Ring> all = sphere_rings(radius, -half_length, 0, rings / 2);
  const std::vector<Ring> top = sphere_rings(radius, half_length, rings / 2, rings);
  all.insert(all.end(), top.begin(), top.end());
  add_rings(shape, all);
  return shape;
}

Shape rectangle(double half_x, double half_y, const std::array<double, 2>& repeat) {
  Shape shape;
  add_side(shape, {{{-half_x, -half_y, 0}, {half_x, -half_y, 0}, {half_x, half_y, 0}, {-half_x, half_y, 0}}},
           {0, 0, 1});
  const auto u = static_cast<float>(repeat[0]), v = static_cast<float>(repeat[1]);
  shape.texture = {0, v, u, v, u, 0, 0, 0};
  return shape;
}

Shape landscape(double half_x, double half_y, int rows, int columns, const std::vector<double>& heights,
                double base) {
  Shape shape;
  if (rows < 2 || columns < 2) return shape;
  const double step_x = 2 * half_x / (columns - 1), step_y = 2 * half_y / (rows - 1);
  const auto height = [&](int row, int column) {
    return heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  };
  const auto slope = [](double before, double after, double distance) { return (after - before) / distance; };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int left = column == 0 ? 0 : column - 1, right = column + 1 == columns ? column : column + 1;
      const int below = row == 0 ? 0 : row - 1, above = row + 1 == rows ? row : row + 1;
      shape.add({column * step_x - half_x, row * step_y - half_y, height(row, column)},
                unit({-slope(height(row, left), height(row, right), (right - left) * step_x),
                      -slope(height(below, column), height(above, column), (above - below) * step_y), 1}));
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const auto at = static_cast<std::uint32_t>(row * columns + column);
      const auto over = at + static_cast<std::uint32_t>(columns);
      shape.add_triangle(at, at + 1, over + 1);
      shape.add_triangle(at, over + 1, over);
    }
  const std::array<Vector, 4> bottom{{{-half_x, half_y, -base},
                                      {half_x, half_y, -base},
                                      {half_x, -half_y, -base},
                                      {-half_x, -half_y, -base}}};
  add_side(shape, bottom, {0, 0, -1});
  return shape;
}

}  // namespace tessera::sim
