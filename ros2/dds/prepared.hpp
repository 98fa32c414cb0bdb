#pragma once

#include <cstdint>

#include "ros2/codec/plan.hpp"
#include "ros2/dds/endpoint.hpp"
#include "tessera/ros2.hpp"

namespace tessera::ros2 {

/// What a driver is made of, of a topic or of one side of a service.
struct Prepared {
  Plan plan;
  EndpointSetup endpoint;  ///< of a service: without the names of DDS
  const ValueEncoding* encoding;
  Duration wait;
};

/// Throws std::runtime_error: the binding is wrong.
[[nodiscard]] Prepared prepare(const Ros2Binding& binding, Direction direction);

/// Whether the n-th of a kind of event is told: the 1st, 10th, 100th and so on.
[[nodiscard]] bool is_told(std::uint64_t count);

}  // namespace tessera::ros2
