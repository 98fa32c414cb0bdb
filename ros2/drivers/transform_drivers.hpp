#pragma once

#include <memory>
#include <string>

#include "tessera/device.hpp"
#include "tessera/ros2.hpp"

namespace tessera::ros2 {

/// The driver of a transform: the receptor gives the pose of `binding.frame` in `binding.in`, the effector broadcasts
/// it. nullptr and `error`: the binding is wrong.
[[nodiscard]] std::unique_ptr<RealReceptor> make_transform_receptor(const Ros2Binding& binding,
                                                                    std::string& error);
[[nodiscard]] std::unique_ptr<RealEffector> make_transform_effector(const Ros2Binding& binding,
                                                                    std::string& error);

}  // namespace tessera::ros2
