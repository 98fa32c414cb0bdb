#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tessera::sim {

/// Triangles, counterclockwise seen from outside. The arrays are in the form of glTF.
struct Shape {
  std::vector<float> positions, normals;  ///< three numbers per vertex
  std::vector<float> texture;             ///< two numbers per vertex; empty: none
  std::vector<std::uint32_t> indices;     ///< three per triangle

  /// Returns the index of the vertex.
  std::uint32_t add(const std::array<double, 3>& position, const std::array<double, 3>& normal);
  void add_triangle(std::uint32_t one, std::uint32_t two, std::uint32_t three);
};

/// From -1 to 1 in all directions.
[[nodiscard]] Shape unit_box();
/// Radius 1.
[[nodiscard]] Shape unit_sphere();
/// Radius 1, along z from -1 to 1.
[[nodiscard]] Shape unit_cylinder();
/// Along z; half_length: of the cylinder between the half spheres.
[[nodiscard]] Shape capsule(double radius, double half_length);
/// In the plane z = 0, visible from above. Texture coordinates go from 0 to `repeat` along x and y, and the
/// upper edge of the picture is at the largest y.
[[nodiscard]] Shape rectangle(double half_x, double half_y, const std::array<double, 2>& repeat);
/// heights: of `rows` times `columns` points over a rectangle, row by row from the smallest y; the lowest
/// point of the solid is at -base.
[[nodiscard]] Shape landscape(double half_x, double half_y, int rows, int columns,
                              const std::vector<double>& heights, double base);

}  // namespace tessera::sim
