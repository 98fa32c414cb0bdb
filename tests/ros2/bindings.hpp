// Drivers of topics for tests, as a specification would make them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros2/definitions/resolver.hpp"
#include "ros2/drivers/drivers.hpp"
#include "tessera/fields.hpp"

namespace tessera::ros2 {

struct Motion {
  double v{}, omega{};
  TESSERA_FIELDS(Motion, v, omega)
};

/// A domain for this process, so that tests do not hear each other.
inline std::uint32_t test_domain() { return 60 + static_cast<std::uint32_t>(getpid()) % 150; }

template <class Value>
Ros2Binding binding(const std::string& topic, const std::string& type, const std::string& fields = "") {
  std::vector<Mistake> mistakes;
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  const auto message = resolve(type, folders, mistakes);
  Ros2Binding made;
  made.path = "robot.part.buffer";
  made.topic = topic;
  made.type = type;
  made.definition = message == nullptr ? "" : bundle_of(*message);
  made.fields = fields;
  made.interface = "lo";
  made.domain = test_domain();
  made.encoding = value_encoding_of<Value>();
  return made;
}

inline std::unique_ptr<RealReceptor> opened_receptor(const Ros2Binding& binding) {
  std::string error;
  auto receptor = make_receptor(binding, error);
  if (receptor == nullptr) throw std::runtime_error(error);
  EXPECT_TRUE(receptor->open());
  return receptor;
}

inline std::unique_ptr<RealEffector> opened_effector(const Ros2Binding& binding) {
  std::string error;
  auto effector = make_effector(binding, error);
  if (effector == nullptr) throw std::runtime_error(error);
  EXPECT_TRUE(effector->open());
  return effector;
}

template <class Value>
bool write(RealEffector& effector, const Value& value) {
  return effector.write(std::as_bytes(std::span(&value, 1)));
}
template <class Value>
bool read(RealReceptor& receptor, Value& value) {
  return receptor.read(std::as_writable_bytes(std::span(&value, 1)));
}

}  // namespace tessera::ros2
