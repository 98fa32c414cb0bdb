#pragma once

#include <dds/dds.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ros2/codec/related_identity.hpp"
#include "ros2/dds/graph.hpp"

namespace tessera::ros2 {

/// The network of a participant.
struct Network {
  std::uint32_t domain = 0;
  std::string interface = "lo";  ///< a name or an address
  std::string peers{};           ///< "10.0.0.2, cart.local"

  auto operator<=>(const Network&) const = default;
};

[[nodiscard]] bool is_loopback(const Network& network);

/// The configuration of Cyclone DDS for that network: one interface and no other. On loopback, or with peers,
/// no multicast is sent; otherwise only discovery uses it. Throws std::runtime_error: no interface or host
/// has that name.
[[nodiscard]] std::string configuration_of(const Network& network);

/// The domain of ROS_DOMAIN_ID, or 0. Throws std::runtime_error: the variable is no number from 0 to 232.
[[nodiscard]] std::uint32_t domain_of_environment();

/// A participant of DDS, shared by all drivers of this process with the same network.
///
/// Threads: any.
class Participant {
 public:
  /// Throws std::runtime_error.
  [[nodiscard]] static std::shared_ptr<Participant> of(const Network& network);
  /// Those that are open in this process.
  [[nodiscard]] static std::vector<std::shared_ptr<Participant>> all();
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] dds_entity_t entity() const { return participant_; }
  /// The nodes of this process in this domain.
  [[nodiscard]] Graph& graph() { return *graph_; }
  [[nodiscard]] const Network& network() const { return network_; }
  /// Whether a participant of Fast DDS was found in the domain.
  [[nodiscard]] bool knows_fast_dds() const;
  /// Notes that an agent has drivers in that node. node: its full name.
  void note(const std::string& node, const std::string& agent);
  /// The nodes that had drivers, and their agents.
  [[nodiscard]] std::map<std::string, std::set<std::string>> nodes();
  /// Whether the advice about a missing other side was given.
  [[nodiscard]] std::atomic<bool>& advised() const { return advised_; }
  /// A text that identifies the two endpoints of a client or server of a service as belonging together.
  [[nodiscard]] std::string new_service_identity();

 private:
  explicit Participant(const Network& network);
  void open(const Network& network);

  const Network network_;
  std::mutex mutex_;
  std::map<std::string, std::set<std::string>> nodes_;
  dds_entity_t domain_ = 0, participant_ = 0;
  std::optional<Graph> graph_;
  mutable std::atomic<bool> advised_{false};
  std::uint32_t services_ = 0;
};

}  // namespace tessera::ros2
