#include "sim/devices/kinds.hpp"

#include <algorithm>
#include <array>

namespace tessera::sim {
namespace {

template <class Device>
struct Kind {
  std::string_view name;
  std::unique_ptr<Device> (*make)(const DeviceContext&, const DriverRequest&);
};

constexpr std::array receptors = std::to_array<Kind<RealReceptor>>({{"sensor", sensor},
                                                                    {"joint_position", joint_position},
                                                                    {"joint_velocity", joint_velocity},
                                                                    {"scan", scan},
                                                                    {"pose", pose},
                                                                    {"contact", contact},
                                                                    {"camera", camera},
                                                                    {"depth", depth},
                                                                    {"labels", labels},
                                                                    {"reflectance", reflectance}});
constexpr std::array effectors = std::to_array<Kind<RealEffector>>({{"actuator", actuator},
                                                                    {"velocity", actuator},
                                                                    {"weld", weld},
                                                                    {"mocap", mocap},
                                                                    {"place", place},
                                                                    {"colour", colour}});

template <class Kinds>
auto make(const Kinds& kinds, const char* what, const DeviceContext& context, const DriverRequest& request) {
  const auto found = std::ranges::find_if(kinds, [&](const auto& kind) { return kind.name == request.kind; });
  if (found != kinds.end()) return found->make(context, request);
  std::vector<std::string> names;
  for (const auto& kind : kinds) names.emplace_back(kind.name);
  throw DeviceError(unknown_name(what, request.kind, names));
}

}  // namespace

std::unique_ptr<RealReceptor> make_receptor(const DeviceContext& context, const DriverRequest& request) {
  return make(receptors, "receptor", context, request);
}

std::unique_ptr<RealEffector> make_effector(const DeviceContext& context, const DriverRequest& request) {
  return make(effectors, "effector", context, request);
}

}  // namespace tessera::sim
