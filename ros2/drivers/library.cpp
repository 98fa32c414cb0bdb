// The exported functions of the library. Controllers load it at run time, so they need no DDS to build.
#include <optional>

#include "ros2/arguments/arguments.hpp"
#include "ros2/dds/clock.hpp"
#include "ros2/drivers/drivers.hpp"
#include "ros2/drivers/managed_node.hpp"
#include "ros2/drivers/nodes.hpp"

// Both sides of the call are C++; only the linkage is that of C.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif

extern "C" {

__attribute__((visibility("default"))) std::unique_ptr<tessera::RealReceptor> tessera_ros2_receptor_4(
    const tessera::Ros2Binding& binding, std::string& error) {
  return tessera::ros2::make_receptor(binding, error);
}

__attribute__((visibility("default"))) std::unique_ptr<tessera::RealEffector> tessera_ros2_effector_4(
    const tessera::Ros2Binding& binding, std::string& error) {
  return tessera::ros2::make_effector(binding, error);
}

__attribute__((visibility("default"))) std::unique_ptr<tessera::Ros2Clock> tessera_ros2_clock_2(
    const std::string& interface, std::string& error) {
  return tessera::ros2::make_clock(interface, error);
}

__attribute__((visibility("default"))) std::unique_ptr<tessera::Ros2Nodes> tessera_ros2_nodes_1(
    tessera::Ros2Host& host, std::string& error) {
  return tessera::ros2::make_nodes(host, error);
}

__attribute__((visibility("default"))) bool tessera_ros2_arguments_1(tessera::Ros2Arguments& arguments,
                                                                     std::string& error) {
  const std::optional<tessera::Problem> wrong = tessera::ros2::apply_arguments(arguments);
  if (wrong) error = wrong->text;
  return !wrong;
}

__attribute__((visibility("default"))) std::unique_ptr<tessera::ManagedNode> tessera_ros2_managed_node_1(
    const tessera::ManagedNodeSetup& setup, std::string& error) {
  return tessera::ros2::make_managed_node(setup, error);
}
}
