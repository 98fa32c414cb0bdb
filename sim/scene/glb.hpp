#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/scene/shapes.hpp"

namespace tessera::sim {

/// The look of a surface, in the colours of the screen (sRGB).
struct Surface {
  std::array<float, 4> rgba{0.5F, 0.5F, 0.5F, 1};
  float roughness = 0.8F;
  float emission = 0;
  std::optional<int> texture{};  ///< as GlbFile::add_picture returns it
  auto operator<=>(const Surface&) const = default;
};

/// A place and an orientation. The quaternion is w, i, j, k.
struct NodeTransform {
  std::array<double, 3> position{};
  std::array<double, 4> rotation{1, 0, 0, 0};
  std::array<double, 3> scale{1, 1, 1};
};

/// Writes a binary glTF 2.0 file. The same calls give the same bytes.
///
/// Threads: one at a time.
class GlbFile {
 public:
  GlbFile();
  /// png: the bytes of a file. Returns a texture.
  [[nodiscard]] int add_picture(const std::string& png);
  /// Equal keys share the triangles. make: called only for a new key.
  template <class Make>
  [[nodiscard]] int mesh(const std::string& key, const Surface& surface, Make&& make) {
    const auto known = meshes_.find({key, surface});
    if (known != meshes_.end()) return known->second;
    if (!shapes_.contains(key)) shapes_.emplace(key, primitive_of(make()));
    return add_mesh(key, surface);
  }
  /// Returns the node. mesh, extras: may be null.
  [[nodiscard]] int add_node(const std::string& name, const NodeTransform& placement, std::optional<int> mesh,
                             const nlohmann::ordered_json& extras);
  void add_child(int parent, int child);
  /// The whole file; `root` is the only node of its scene.
  [[nodiscard]] std::string bytes(int root);

 private:
  struct Accessor {
    int component = 0;
    const char* type = "";
    std::size_t count = 0;
  };
  [[nodiscard]] nlohmann::ordered_json primitive_of(const Shape& shape);
  [[nodiscard]] int add_mesh(const std::string& key, const Surface& surface);
  [[nodiscard]] int material_of(const Surface& surface);
  [[nodiscard]] int add_view(const void* data, std::size_t bytes, std::optional<int> target);
  [[nodiscard]] int add_accessor(const void* data, std::size_t bytes, int target, const Accessor& accessor);

  nlohmann::ordered_json json_;
  std::string data_;
  std::map<std::string, nlohmann::ordered_json> shapes_;
  std::map<std::pair<std::string, Surface>, int> meshes_;
  std::map<Surface, int> materials_;
};

/// The bytes of a PNG file. pixels: rows from the top; channels: 1 grey, 3 red, green, blue. Throws
/// std::runtime_error.
[[nodiscard]] std::string png_of(const std::uint8_t* pixels, std::uint32_t width, std::uint32_t height,
                                 int channels);

}  // namespace tessera::sim
