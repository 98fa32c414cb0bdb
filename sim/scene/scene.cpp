#include "sim/scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "sim/scene/glb.hpp"
#include "sim/scene/shapes.hpp"

namespace tessera::sim {
namespace {

using nlohmann::ordered_json;

constexpr int hidden_groups = 3;
/// Lifts the floor picture, so that it is not drawn in the same plane as the floor.
constexpr double picture_height_m = 0.0005;

[[nodiscard]] std::size_t at(int index) { return static_cast<std::size_t>(index); }

template <std::size_t N, class Number>
[[nodiscard]] std::array<double, N> numbers(const Number* from) {
  std::array<double, N> all{};
  std::copy_n(from, N, all.begin());
  return all;
}

[[nodiscard]] std::string text_of(const std::array<double, 3>& numbers) {
  return ordered_json(numbers).dump();
}

/// The colour of a geom: that of its material, unless it has its own. The engine uses the same rule.
[[nodiscard]] std::array<float, 4> rgba_of(const mjModel& model, int geom) {
  const float* const own = model.geom_rgba + 4 * geom;
  const int material = model.geom_matid[geom];
  constexpr std::array<float, 4> unset{0.5F, 0.5F, 0.5F, 1};
  const float* const used =
      material >= 0 && std::equal(unset.begin(), unset.end(), own) ? model.mat_rgba + 4 * material : own;
  std::array<float, 4> rgba{};
  std::copy_n(used, rgba.size(), rgba.begin());
  return rgba;
}

[[nodiscard]] bool is_visible(const mjModel& model, int geom) {
  return model.geom_group[geom] < hidden_groups && rgba_of(model, geom)[3] > 0;
}

[[nodiscard]] bool has_visible_geom(const mjModel& model, int body) {
  for (int index = 0; index < model.body_geomnum[body]; ++index)
    if (is_visible(model, model.body_geomadr[body] + index)) return true;
  return false;
}

[[nodiscard]] bool can_move(const mjModel& model, int body) {
  return model.body_weldid[body] != 0 || model.body_mocapid[model.body_rootid[body]] >= 0;
}

/// The bodies of a model with all joints at their reference.
[[nodiscard]] std::vector<NodeTransform> reference_placements(const mjModel& model) {
  std::vector<NodeTransform> all(at(model.nbody));
  for (int body = 1; body < model.nbody; ++body) {
    const NodeTransform& parent = all[at(model.body_parentid[body])];
    NodeTransform& own = all[at(body)];
    mju_rotVecQuat(own.position.data(), model.body_pos + 3 * body, parent.rotation.data());
    for (std::size_t axis = 0; axis < 3; ++axis) own.position[axis] += parent.position[axis];
    mju_mulQuat(own.rotation.data(), parent.rotation.data(), model.body_quat + 4 * body);
  }
  return all;
}

/// Writes the geoms of one model.
class SceneWriter {
 public:
  SceneWriter(const mjModel& model, const FloorPicture& floor) : model_(model), floor_(floor) {}

  [[nodiscard]] std::string write(std::span<const int> bodies) {
    const std::vector<NodeTransform> placements = reference_placements(model_);
    // glTF has y up.
    const int root = file_.add_node("", {.rotation = {std::sqrt(0.5), -std::sqrt(0.5), 0, 0}}, {}, nullptr);
    std::size_t next = 0;
    for (int body = 0; body < model_.nbody; ++body) {
      const bool moves = next < bodies.size() && bodies[next] == body;
      if (!moves && body != 0 && !has_visible_geom(model_, body)) continue;
      const int node = file_.add_node(body_name(model_, body), placements[at(body)], {},
                                      moves ? ordered_json{{"body", next++}} : ordered_json());
      file_.add_child(root, node);
      for (int index = 0; index < model_.body_geomnum[body]; ++index)
        add_geom(model_.body_geomadr[body] + index, node);
      if (body == 0) add_floor(node);
    }
    return file_.bytes(root);
  }

 private:
  void add_geom(int geom, int node) {
    if (!is_visible(model_, geom)) return;
    NodeTransform placement{.position = numbers<3>(model_.geom_pos + 3 * geom),
                            .rotation = numbers<4>(model_.geom_quat + 4 * geom)};
    const std::optional<int> mesh = mesh_of(geom, placement);
    if (!mesh) return;
    const char* const name = mj_id2name(&model_, mjOBJ_GEOM, geom);
    file_.add_child(node, file_.add_node(name == nullptr ? "" : name, placement, mesh, nullptr));
  }

  /// Round shapes and boxes share their triangles; their size is a scale of the node.
  [[nodiscard]] std::optional<int> mesh_of(int geom, NodeTransform& placement) {
    const std::array<double, 3> size = numbers<3>(model_.geom_size + 3 * geom);
    switch (model_.geom_type[geom]) {
      case mjGEOM_PLANE:
        return plane(geom, size);
      case mjGEOM_SPHERE:
        placement.scale = {size[0], size[0], size[0]};
        return file_.mesh("sphere", plain(geom), unit_sphere);
      case mjGEOM_ELLIPSOID:
        placement.scale = size;
        return file_.mesh("sphere", plain(geom), unit_sphere);
      case mjGEOM_CYLINDER:
        placement.scale = {size[0], size[0], size[1]};
        return file_.mesh("cylinder", plain(geom), unit_cylinder);
      case mjGEOM_BOX:
        placement.scale = size;
        return file_.mesh("box", plain(geom), unit_box);
      case mjGEOM_CAPSULE:
        return file_.mesh("capsule " + text_of(size), plain(geom), [&] { return capsule(size[0], size[1]); });
      case mjGEOM_MESH:
        return mesh(geom);
      case mjGEOM_HFIELD:
        return heights(geom);
      default:
        return std::nullopt;
    }
  }

  /// A picture that is wrapped around a body is replaced by its mean colour.
  [[nodiscard]] Surface plain(int geom) {
    Surface surface{.rgba = rgba_of(model_, geom)};
    const int material = model_.geom_matid[geom];
    if (material < 0) return surface;
    surface.roughness = std::clamp(1 - 0.6F * model_.mat_shininess[material], 0.2F, 1.0F);
    surface.emission = model_.mat_emission[material];
    if (const int texture = model_.mat_texid[material]; texture >= 0) {
      const std::array<float, 3> mean = mean_colour(texture);
      for (std::size_t part = 0; part < 3; ++part) surface.rgba[part] *= mean[part];
    }
    return surface;
  }

  [[nodiscard]] Surface with_picture(int geom) {
    const int material = model_.geom_matid[geom];
    const int texture = material < 0 ? -1 : model_.mat_texid[material];
    if (texture < 0 || model_.tex_type[texture] != mjTEXTURE_2D) return plain(geom);
    Surface surface = plain(geom);
    surface.rgba = rgba_of(model_, geom);
    surface.texture = picture(texture);
    return surface;
  }

  [[nodiscard]] std::array<float, 3> mean_colour(int texture) const {
    const std::size_t pixels = at(model_.tex_width[texture]) * at(model_.tex_height[texture]);
    const mjtByte* const rgb = model_.tex_rgb + model_.tex_adr[texture];
    std::array<double, 3> sum{};
    for (std::size_t byte = 0; byte < 3 * pixels; ++byte) sum[byte % 3] += rgb[byte];
    std::array<float, 3> mean{1, 1, 1};
    for (std::size_t part = 0; part < 3 && pixels > 0; ++part)
      mean[part] = static_cast<float>(sum[part] / 255 / static_cast<double>(pixels));
    return mean;
  }

  [[nodiscard]] int picture(int texture) {
    std::optional<int>& known = pictures_[texture];
    if (!known)
      known = file_.add_picture(png_of(model_.tex_rgb + model_.tex_adr[texture],
                                       static_cast<std::uint32_t>(model_.tex_width[texture]),
                                       static_cast<std::uint32_t>(model_.tex_height[texture]), 3));
    return *known;
  }

  [[nodiscard]] int plane(int geom, std::array<double, 3> size) {
    const bool endless = size[0] <= 0 || size[1] <= 0;
    // The engine draws an infinite plane up to the horizon.
    const double far = std::max({5.0, 3 * model_.stat.extent, 2 * floor_.width_m, 2 * floor_.height_m});
    for (std::size_t axis = 0; axis < 2; ++axis)
      if (size[axis] <= 0) size[axis] = far;
    const int material = model_.geom_matid[geom];
    std::array<double, 2> repeat{1, 1};
    if (material >= 0) {
      repeat = numbers<2>(model_.mat_texrepeat + 2 * material);
      if (endless || model_.mat_texuniform[material] != 0)
        for (std::size_t axis = 0; axis < 2; ++axis) repeat[axis] *= 2 * size[axis];
    }
    const std::string key = "plane " + text_of({size[0], size[1], 0}) + text_of({repeat[0], repeat[1], 0});
    return file_.mesh(key, with_picture(geom), [&] { return rectangle(size[0], size[1], repeat); });
  }

  [[nodiscard]] std::optional<int> mesh(int geom) {
    const int mesh = model_.geom_dataid[geom];
    if (mesh < 0 || model_.mesh_facenum[mesh] == 0 || model_.mesh_vertnum[mesh] == 0) return std::nullopt;
    const bool has_texture = model_.mesh_texcoordadr[mesh] >= 0;
    return file_.mesh("mesh " + std::to_string(mesh), has_texture ? with_picture(geom) : plain(geom), [&] {
      Shape shape;
      const std::size_t first = 3 * at(model_.mesh_vertadr[mesh]), count = 3 * at(model_.mesh_vertnum[mesh]);
      shape.positions.assign(model_.mesh_vert + first, model_.mesh_vert + first + count);
      shape.normals.assign(model_.mesh_normal + first, model_.mesh_normal + first + count);
      make_unit(shape.normals);
      if (has_texture) {
        const float* const texture = model_.mesh_texcoord + 2 * at(model_.mesh_texcoordadr[mesh]);
        shape.texture.assign(texture, texture + 2 * at(model_.mesh_vertnum[mesh]));
      }
      const int* const faces = model_.mesh_face + 3 * at(model_.mesh_faceadr[mesh]);
      shape.indices.assign(faces, faces + 3 * at(model_.mesh_facenum[mesh]));
      return shape;
    });
  }

  /// glTF requires normals of length 1.
  static void make_unit(std::vector<float>& normals) {
    for (std::size_t first = 0; first + 2 < normals.size(); first += 3) {
      const double length = std::hypot(normals[first], normals[first + 1], normals[first + 2]);
      if (length > 0)
        for (std::size_t part = 0; part < 3; ++part)
          normals[first + part] = static_cast<float>(normals[first + part] / length);
      else
        normals[first + 2] = 1;
    }
  }

  [[nodiscard]] std::optional<int> heights(int geom) {
    const int field = model_.geom_dataid[geom];
    if (field < 0) return std::nullopt;
    const std::array<double, 4> size = numbers<4>(model_.hfield_size + 4 * field);
    const int rows = model_.hfield_nrow[field], columns = model_.hfield_ncol[field];
    if (rows < 2 || columns < 2) return std::nullopt;
    return file_.mesh("heights " + std::to_string(field), plain(geom), [&] {
      std::vector<double> all;
      const float* const data = model_.hfield_data + model_.hfield_adr[field];
      for (int point = 0; point < rows * columns; ++point) all.push_back(size[2] * data[point]);
      return landscape(size[0], size[1], rows, columns, all, size[3]);
    });
  }

  void add_floor(int node) {
    if (floor_.width_m <= 0 || floor_.height_m <= 0) return;
    const double half_x = floor_.width_m / 2, half_y = floor_.height_m / 2;
    const Surface surface{
        .rgba = {1, 1, 1, 1},
        .roughness = 1,
        .texture = file_.add_picture(png_of(floor_.pixels.data(), floor_.width_px, floor_.height_px, 1))};
    const int mesh = file_.mesh("floor picture", surface, [&] { return rectangle(half_x, half_y, {1, 1}); });
    const NodeTransform placement{.position = {half_x, half_y, picture_height_m}};
    file_.add_child(node, file_.add_node("floor picture", placement, mesh, ordered_json{{"floor", true}}));
  }

  const mjModel& model_;
  const FloorPicture& floor_;
  GlbFile file_;
  std::map<int, std::optional<int>> pictures_;
};

}  // namespace

std::vector<int> moving_bodies(const mjModel& model) {
  std::vector<int> bodies;
  for (int body = 1; body < model.nbody; ++body)
    if (can_move(model, body) && (model.body_parentid[body] == 0 || has_visible_geom(model, body)))
      bodies.push_back(body);
  return bodies;
}

std::string body_name(const mjModel& model, int body) {
  const char* const name = mj_id2name(&model, mjOBJ_BODY, body);
  if (name != nullptr && *name != '\0') return name;
  std::string made = "body " + std::to_string(body);
  while (mj_name2id(&model, mjOBJ_BODY, made.c_str()) >= 0) made += '\'';
  return made;
}

std::string glb_of(const mjModel& model, std::span<const int> bodies, const FloorPicture& floor) {
  return SceneWriter(model, floor).write(bodies);
}

void read_poses(const mjData& located, std::span<const int> bodies, std::vector<BodyPose>& poses) {
  poses.resize(bodies.size());
  for (std::size_t index = 0; index < bodies.size(); ++index) {
    poses[index].position_m = numbers<3>(located.xpos + 3 * bodies[index]);
    poses[index].rotation = numbers<4>(located.xquat + 4 * bodies[index]);
  }
}

}  // namespace tessera::sim
