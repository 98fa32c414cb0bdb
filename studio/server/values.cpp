#include "server/values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <vector>

namespace tessera::server {

namespace {

using nlohmann::json;

constexpr std::array<std::size_t, 11> scalar_sizes{1, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8};

constexpr std::size_t aligned(std::size_t size, std::size_t alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

template <class T>
T as(std::span<const unsigned char> bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

json scalar(spec::Scalar kind, std::span<const unsigned char> bytes) {
  switch (kind) {
    case spec::Scalar::boolean:
      return bytes[0] != 0;
    case spec::Scalar::int8:
      return as<std::int8_t>(bytes);
    case spec::Scalar::int16:
      return as<std::int16_t>(bytes);
    case spec::Scalar::int32:
      return as<std::int32_t>(bytes);
    case spec::Scalar::int64:
      return as<std::int64_t>(bytes);
    case spec::Scalar::uint8:
      return as<std::uint8_t>(bytes);
    case spec::Scalar::uint16:
      return as<std::uint16_t>(bytes);
    case spec::Scalar::uint32:
      return as<std::uint32_t>(bytes);
    case spec::Scalar::uint64:
      return as<std::uint64_t>(bytes);
    case spec::Scalar::float32:
      return as<float>(bytes);
    case spec::Scalar::float64:
      return as<double>(bytes);
  }
  return nullptr;
}

std::vector<unsigned char> bytes_of(std::string_view hex) {
  std::vector<unsigned char> bytes(hex.size() / 2);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const char* digits = hex.data() + 2 * at;
    if (std::from_chars(digits, digits + 2, bytes[at], 16).ptr != digits + 2) return {};
  }
  return bytes;
}

}  // namespace

ValueReader::ValueReader(const spec::Model& model) : model_(model) {
  for (spec::Index instance = 0; instance < model.instances.size(); ++instance) {
    const spec::Subsystem& subsystem = model.subsystem(instance);
    const std::string path = model.instance_path(instance) + ".";
    for (const auto* buffers : {&subsystem.inputs, &subsystem.outputs, &subsystem.real})
      for (const spec::Field& buffer : *buffers) types_.emplace(path + buffer.name, &buffer.type);
  }
}

ValueReader::Layout ValueReader::element_layout(const spec::Type& type) const {
  if (type.kind == spec::Type::Kind::scalar) {
    const std::size_t size = scalar_sizes[static_cast<std::size_t>(type.scalar)];
    return {size, size};
  }
  constexpr std::size_t length = sizeof(std::uint32_t);  // of a BoundedString
  if (type.kind == spec::Type::Kind::string) return {aligned(length + type.capacity, length), length};
  Layout whole;
  for (const spec::Field& field : model_.structures[type.structure].fields) {
    const Layout one = layout(field.type);
    whole.size = aligned(whole.size, one.alignment) + one.size;
    whole.alignment = std::max(whole.alignment, one.alignment);
  }
  whole.size = std::max<std::size_t>(aligned(whole.size, whole.alignment), 1);
  return whole;
}

ValueReader::Layout ValueReader::layout(const spec::Type& type) const {
  Layout one = element_layout(type);
  if (type.extent > 0) one.size *= type.extent;
  return one;
}

json ValueReader::element(const spec::Type& type, std::span<const unsigned char> bytes) const {
  if (type.kind == spec::Type::Kind::scalar) return scalar(type.scalar, bytes);
  if (type.kind == spec::Type::Kind::string) {
    const std::size_t length = std::min<std::size_t>(as<std::uint32_t>(bytes), type.capacity);
    return std::string(reinterpret_cast<const char*>(bytes.data()) + sizeof(std::uint32_t), length);
  }
  json fields = json::object();
  std::size_t at = 0;
  for (const spec::Field& field : model_.structures[type.structure].fields) {
    const Layout one = layout(field.type);
    at = aligned(at, one.alignment);
    fields[field.name] = value(field.type, bytes.subspan(at, one.size));
    at += one.size;
  }
  return fields;
}

json ValueReader::value(const spec::Type& type, std::span<const unsigned char> bytes) const {
  if (type.extent == 0) return element(type, bytes);
  json list = json::array();
  const std::size_t size = element_layout(type).size;
  for (std::size_t index = 0; index < type.extent; ++index)
    list.push_back(element(type, bytes.subspan(index * size, size)));
  return list;
}

json ValueReader::read(const std::string& path, std::string_view hex) const {
  const auto found = types_.find(path);
  if (found == types_.end() || layout(*found->second).size * 2 != hex.size()) return nullptr;
  const std::vector<unsigned char> bytes = bytes_of(hex);
  return bytes.empty() ? json(nullptr) : value(*found->second, bytes);
}

}  // namespace tessera::server
