#pragma once

#include <memory>

#include "ros2/codec/translator.hpp"
#include "ros2/dds/endpoint.hpp"
#include "tessera/repetition.hpp"
#include "tessera/ros2.hpp"

namespace tessera::ros2 {

/// The parts of a driver of a topic or of one side of a service or action.
struct Prepared {
  std::shared_ptr<const Structure> message;  ///< of the buffer
  Translator translator;
  EndpointSetup endpoint;  ///< for a service or action: without the DDS names
  const ValueEncoding* encoding;
  Duration wait;
  bool one_publisher = false;
};

/// Throws std::runtime_error: the binding is wrong.
[[nodiscard]] Prepared prepare(const Ros2Binding& binding, Direction direction);

}  // namespace tessera::ros2
