#pragma once

#include <memory>
#include <string>

#include "tessera/ros2.hpp"

namespace tessera::ros2 {

/// One side of a service, as docs/use/ros2.md describes it. The receptor and the effector of an agent with the
/// same service and role work together. nullptr and `error`: the binding is wrong.
///
/// Client: the effector sends a request when the field `call` has a new number that is not 0. The receptor
/// gives each call's reply once.
/// Server: the receptor gives each request once. The effector replies to the request whose number is in
/// `call`.
[[nodiscard]] std::unique_ptr<RealReceptor> make_service_receptor(const Ros2Binding& binding,
                                                                  std::string& error);
[[nodiscard]] std::unique_ptr<RealEffector> make_service_effector(const Ros2Binding& binding,
                                                                  std::string& error);

}  // namespace tessera::ros2
