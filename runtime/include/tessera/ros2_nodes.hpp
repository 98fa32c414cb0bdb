#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tessera {

/// A parameter of a subsystem, as nodes of ROS 2 offer it.
struct Ros2Parameter {
  /// The numbers are those of rcl_interfaces/msg/ParameterType.
  enum class Kind : std::uint8_t {
    boolean = 1,
    integer = 2,
    real = 3,
    text = 4,
    booleans = 6,
    integers = 7,
    reals = 8
  };
  std::string path;  ///< "robot.control.v"
  Kind kind = Kind::real;
  std::string value;                                          ///< as `--set` takes it, without its unit
  std::string unit{};                                         ///< empty: none
  double minimum = -std::numeric_limits<double>::infinity();  ///< of a number, or of each element
  double maximum = std::numeric_limits<double>::infinity();
  std::size_t longest = 0;   ///< bytes of a text
  std::size_t elements = 0;  ///< of an array
};

/// The state of a subsystem, as diagnostics of ROS 2 show it.
struct Ros2Status {
  /// The numbers are those of diagnostic_msgs/msg/DiagnosticStatus.
  enum class Level : std::uint8_t { ok = 0, warn = 1, error = 2, stale = 3 };
  std::string path;  ///< "robot.control"
  Level level = Level::ok;
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;
};

/// The run that nodes of ROS 2 show.
///
/// Threads: one at a time, which may be another one than the run's.
class Ros2Host {
 public:
  Ros2Host() = default;
  Ros2Host(const Ros2Host&) = delete;
  Ros2Host& operator=(const Ros2Host&) = delete;
  virtual ~Ros2Host() = default;
  /// All parameters, always in the same order, with the values that were requested last.
  [[nodiscard]] virtual std::vector<Ros2Parameter> parameters() const = 0;
  /// A path and a value, as `--set` takes it.
  using Change = std::pair<std::string, std::string>;
  /// Requests all of them, or none. Returns why none; nullopt: they will take place.
  [[nodiscard]] virtual std::optional<std::string> set(std::span<const Change> changes) = 0;
  /// All subsystems. It compares with the last call.
  [[nodiscard]] virtual std::vector<Ros2Status> statuses() = 0;
  [[nodiscard]] virtual std::string system() const = 0;
};

/// Serves the parameters and publishes the diagnostics of a run, from construction to destruction, at each node
/// that has drivers.
class Ros2Nodes {
 public:
  Ros2Nodes() = default;
  Ros2Nodes(const Ros2Nodes&) = delete;
  Ros2Nodes& operator=(const Ros2Nodes&) = delete;
  virtual ~Ros2Nodes() = default;
};

/// The function that the library for ROS 2 exports. nullptr: `error`, or without one: there is no node.
/// Call it when the devices are open. host: must outlive what it makes.
using Ros2NodesMaker = std::unique_ptr<Ros2Nodes> (*)(Ros2Host& host, std::string& error);
inline constexpr const char* ros2_nodes_function = "tessera_ros2_nodes_1";

/// The orders that a managed node of ROS 2 gets.
enum class LifecycleOrder : std::uint8_t { configure, cleanup, activate, deactivate, shutdown };
/// How an order ended. failure: nothing has changed. error: the run has failed.
enum class LifecycleOutcome : std::uint8_t { success = 0, failure = 1, error = 2 };

struct ManagedNodeSetup {
  std::string node;                     ///< its name, before the rules of `--ros-args`
  std::optional<std::uint32_t> domain;  ///< nullopt: that of ROS_DOMAIN_ID
  std::string interface = "lo", peers;  ///< as of drivers (docs/use/ros2.md)
};

/// A managed node of ROS 2: the services of lifecycle_msgs and the topic of its transitions. It begins unconfigured.
///
/// Threads: one at a time. Nothing is answered between calls of `serve`.
class ManagedNode {
 public:
  ManagedNode() = default;
  ManagedNode(const ManagedNode&) = delete;
  ManagedNode& operator=(const ManagedNode&) = delete;
  virtual ~ManagedNode() = default;
  [[nodiscard]] virtual std::string name() const = 0;  ///< "/patrol"
  /// Answers requests. Returns an order that a client gave and that fits the state: `finish` must be called when it has
  /// ended, and until then no other one is returned.
  [[nodiscard]] virtual std::optional<LifecycleOrder> serve() = 0;
  /// The same for an order of this process. false: it does not fit the state.
  [[nodiscard]] virtual bool begin(LifecycleOrder order) = 0;
  virtual void finish(LifecycleOutcome outcome) = 0;
  /// The run has failed without an order: the node is unconfigured again.
  virtual void fail() = 0;
};

/// The function that the library for ROS 2 exports. nullptr and `error`: there is no such node.
using ManagedNodeMaker = std::unique_ptr<ManagedNode> (*)(const ManagedNodeSetup& setup, std::string& error);
inline constexpr const char* managed_node_function = "tessera_ros2_managed_node_1";

}  // namespace tessera
