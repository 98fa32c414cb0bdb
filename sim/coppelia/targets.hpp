#pragma once

#include <string>
#include <vector>

#include "sim/coppelia/devices.hpp"

/// The objects that devices name.
namespace tessera::coppelia {

/// "joint", "vision sensor", ...
[[nodiscard]] const char* word_for(Object::Type type);

/// The objects that the request names; each has one of these types. Empty without a scene. Throws
/// sim::DeviceError.
[[nodiscard]] std::vector<Object> objects_of(const DeviceContext& context, const DriverRequest& request,
                                             const std::vector<Object::Type>& types);
/// The only object of the request, of any type if `types` is empty. Without a scene, an object without a
/// handle.
[[nodiscard]] Object only_object_of(const DeviceContext& context, const DriverRequest& request,
                                    const std::vector<Object::Type>& types);

}  // namespace tessera::coppelia
