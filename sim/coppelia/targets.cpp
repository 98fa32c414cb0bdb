#include "sim/coppelia/targets.hpp"

#include <algorithm>
#include <utility>

#include "sim/devices/device_error.hpp"

namespace tessera::coppelia {
namespace {

using sim::DeviceError;

std::string words_for(const std::vector<Object::Type>& types) {
  std::string words;
  for (const Object::Type type : types) words += (words.empty() ? "" : " or ") + std::string(word_for(type));
  return words.empty() ? "object" : words;
}

std::vector<std::string> names_of(LockStep& scene, const std::vector<Object::Type>& types) {
  std::vector<Object::Type> listed = types;
  if (listed.empty()) listed = {Object::Type::shape, Object::Type::dummy};
  std::vector<std::string> names;
  scene.use([&](Simulator& simulator) {
    for (const Object::Type type : listed)
      for (std::string& path : simulator.paths(type)) names.push_back(std::move(path));
  });
  return names;
}

Object object_of(const DeviceContext& context, const DriverRequest& request, const std::string& name,
                 const std::vector<Object::Type>& types) {
  const auto object = context.scene->find(request.agent(), name);
  const bool fits = object && (types.empty() || std::ranges::find(types, object->type) != types.end());
  if (fits) return *object;
  const std::vector<std::string> names = names_of(*context.scene, types);
  if (object)
    throw DeviceError("'" + name + "' is a " + word_for(object->type) + ", not a " + words_for(types),
                      "the world has: " + sim::short_list(names), name);
  throw DeviceError(sim::unknown_name(words_for(types), name, names));
}

}  // namespace

const char* word_for(Object::Type type) {
  using Type = Object::Type;
  switch (type) {
    case Type::joint:
      return "joint";
    case Type::vision_sensor:
      return "vision sensor";
    case Type::proximity_sensor:
      return "proximity sensor";
    case Type::force_sensor:
      return "force sensor";
    case Type::shape:
      return "shape";
    case Type::dummy:
      return "dummy";
    case Type::other:
      break;
  }
  return "object";
}

std::vector<Object> objects_of(const DeviceContext& context, const DriverRequest& request,
                               const std::vector<Object::Type>& types) {
  std::vector<Object> objects;
  if (context.scene == nullptr) return objects;
  for (const std::string& name : request.targets) objects.push_back(object_of(context, request, name, types));
  return objects;
}

Object only_object_of(const DeviceContext& context, const DriverRequest& request,
                      const std::vector<Object::Type>& types) {
  if (request.targets.size() != 1) throw DeviceError("'" + request.kind + "' has one target, not a list", "");
  return context.scene == nullptr ? Object{} : object_of(context, request, request.targets[0], types);
}

}  // namespace tessera::coppelia
