#include "sim/scene/glb.hpp"

#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace tessera::sim {
namespace {

using nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// The numbers of glTF's constants.
constexpr int unsigned_short = 5123, unsigned_int = 5125, floating = 5126;
constexpr int vertex_data = 34962, index_data = 34963;
constexpr int linear = 9729, linear_mipmap = 9987, repeating = 10497;
constexpr std::uint32_t magic = 0x46546C67, version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

template <class Number>
ordered_json list_of(const std::vector<Number>& numbers) {
  return ordered_json(numbers);
}

/// glTF uses linear light.
double linear_light(float screen) {
  const double s = std::clamp(static_cast<double>(screen), 0.0, 1.0);
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// Smallest and largest of each of the three coordinates.
std::pair<std::vector<double>, std::vector<double>> box_of(const std::vector<float>& positions) {
  std::vector<double> least(3, HUGE_VAL), most(3, -HUGE_VAL);
  for (std::size_t at = 0; at < positions.size(); ++at) {
    least[at % 3] = std::min(least[at % 3], static_cast<double>(positions[at]));
    most[at % 3] = std::max(most[at % 3], static_cast<double>(positions[at]));
  }
  return {least, most};
}

void put_word(std::string& bytes, std::size_t number) {
  const auto word = static_cast<std::uint32_t>(number);
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

GlbFile::GlbFile() {
  json_ = {{"asset", {{"version", "2.0"}, {"generator", "Tessera"}}}, {"scene", 0}};
  json_["nodes"] = ordered_json::array();
}

int GlbFile::add_view(const void* data, std::size_t bytes, std::optional<int> target) {
  data_.resize((data_.size() + 3) / 4 * 4, '\0');
  ordered_json view{{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes}};
  if (target) view["target"] = *target;
  data_.append(static_cast<const char*>(data), bytes);
  json_["bufferViews"].push_back(std::move(view));
  return static_cast<int>(json_["bufferViews"].size()) - 1;
}

int GlbFile::add_accessor(const void* data, std::size_t bytes, int target, const Accessor& accessor) {
  const int view = add_view(data, bytes, target);
  json_["accessors"].push_back({{"bufferView", view},
                                {"componentType", accessor.component},
                                {"count", accessor.count},
                                {"type", accessor.type}});
  return static_cast<int>(json_["accessors"].size()) - 1;
}

ordered_json GlbFile::primitive_of(const Shape& shape) {
  const std::size_t count = shape.positions.size() / 3;
  ordered_json attributes;
  const auto add = [&](const char* name, const std::vector<float>& numbers, const char* type) {
    attributes[name] =
        add_accessor(numbers.data(), numbers.size() * sizeof(float), vertex_data, {floating, type, count});
  };
  add("POSITION", shape.positions, "VEC3");
  const auto [least, most] = box_of(shape.positions);
  json_["accessors"].back()["min"] = list_of(least);
  json_["accessors"].back()["max"] = list_of(most);
  add("NORMAL", shape.normals, "VEC3");
  if (!shape.texture.empty()) add("TEXCOORD_0", shape.texture, "VEC2");
  int indices = 0;
  if (count < 65535) {
    const std::vector<std::uint16_t> small(shape.indices.begin(), shape.indices.end());
    indices = add_accessor(small.data(), small.size() * sizeof(std::uint16_t), index_data,
                           {unsigned_short, "SCALAR", small.size()});
  } else {
    indices = add_accessor(shape.indices.data(), shape.indices.size() * sizeof(std::uint32_t), index_data,
                           {unsigned_int, "SCALAR", shape.indices.size()});
  }
  return {{"attributes", std::move(attributes)}, {"indices", indices}};
}

int GlbFile::material_of(const Surface& surface) {
  const auto known = materials_.find(surface);
  if (known != materials_.end()) return known->second;
  std::vector<double> colour;
  for (std::size_t at = 0; at < 3; ++at) colour.push_back(linear_light(surface.rgba[at]));
  const double alpha = std::clamp(static_cast<double>(surface.rgba[3]), 0.0, 1.0);
  std::vector<double> emitted;
  const double emission = std::clamp(static_cast<double>(surface.emission), 0.0, 1.0);
  for (const double part : colour) emitted.push_back(part * emission);
  colour.push_back(alpha);
  ordered_json look{{"baseColorFactor", list_of(colour)},
                    {"metallicFactor", 0},
                    {"roughnessFactor", std::clamp(static_cast<double>(surface.roughness), 0.0, 1.0)}};
  if (surface.texture) look["baseColorTexture"] = {{"index", *surface.texture}};
  ordered_json material{{"pbrMetallicRoughness", std::move(look)}};
  if (emission > 0) material["emissiveFactor"] = list_of(emitted);
  if (alpha < 1) material["alphaMode"] = "BLEND";
  json_["materials"].push_back(std::move(material));
  return materials_[surface] = static_cast<int>(json_["materials"].size()) - 1;
}

int GlbFile::add_mesh(const std::string& key, const Surface& surface) {
  ordered_json primitive = shapes_.at(key);
  Surface used = surface;
  if (!primitive["attributes"].contains("TEXCOORD_0")) used.texture.reset();
  primitive["material"] = material_of(used);
  json_["meshes"].push_back({{"primitives", ordered_json::array({std::move(primitive)})}});
  return meshes_[{key, surface}] = static_cast<int>(json_["meshes"].size()) - 1;
}

int GlbFile::add_picture(const std::string& png) {
  const int view = add_view(png.data(), png.size(), std::nullopt);
  if (!json_.contains("samplers"))
    json_["samplers"] = ordered_json::array(
        {{{"magFilter", linear}, {"minFilter", linear_mipmap}, {"wrapS", repeating}, {"wrapT", repeating}}});
  json_["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  json_["textures"].push_back({{"sampler", 0}, {"source", json_["images"].size() - 1}});
  return static_cast<int>(json_["textures"].size()) - 1;
}

int GlbFile::add_node(const std::string& name, const NodeTransform& placement, std::optional<int> mesh,
                      const ordered_json& extras) {
  const auto& [position, rotation, scale] = placement;
  ordered_json node;
  if (!name.empty()) node["name"] = name;
  if (position != NodeTransform{}.position) node["translation"] = position;
  if (rotation != NodeTransform{}.rotation) {
    double length = 0;
    for (const double part : rotation) length += part * part;
    length = std::sqrt(length);
    node["rotation"] = {rotation[1] / length, rotation[2] / length, rotation[3] / length,
                        rotation[0] / length};
  }
  if (scale != NodeTransform{}.scale) node["scale"] = scale;
  if (mesh) node["mesh"] = *mesh;
  if (!extras.is_null()) node["extras"] = extras;
  json_["nodes"].push_back(std::move(node));
  return static_cast<int>(json_["nodes"].size()) - 1;
}

void GlbFile::add_child(int parent, int child) {
  json_["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(child);
}

std::string GlbFile::bytes(int root) {
  json_["scenes"] = ordered_json::array({{{"nodes", {root}}}});
  data_.resize((data_.size() + 3) / 4 * 4, '\0');
  if (!data_.empty()) json_["buffers"] = ordered_json::array({{{"byteLength", data_.size()}}});
  std::string text = json_.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  constexpr std::size_t head = 12, chunk_head = 8;
  const std::size_t whole = head + chunk_head + text.size() + (data_.empty() ? 0 : chunk_head + data_.size());
  if (whole > UINT32_MAX) throw std::runtime_error("the scene of the world is larger than 4 GB");
  std::string file;
  file.reserve(whole);
  for (const std::size_t word :
       {std::size_t{magic}, std::size_t{version}, whole, text.size(), std::size_t{json_chunk}})
    put_word(file, word);
  file += text;
  if (data_.empty()) return file;
  put_word(file, data_.size());
  put_word(file, binary_chunk);
  return file + data_;
}

std::string png_of(const std::uint8_t* pixels, std::uint32_t width, std::uint32_t height, int channels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, pixels, 0, nullptr) == 0)
    throw std::runtime_error(std::string("a picture of the scene: ") + image.message);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr) == 0)
    throw std::runtime_error(std::string("a picture of the scene: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace tessera::sim
