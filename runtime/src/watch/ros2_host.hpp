#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "assembly/assembly.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/ros2_nodes.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// The states of the subsystems, as diagnostics show them. A warning about overruns or overtime ends when there is no new one.
///
/// Threads: one at a time.
class Ros2Statuses {
 public:
  [[nodiscard]] std::vector<Ros2Status> of(const Snapshot& snapshot);

 private:
  std::map<std::string, std::uint64_t> overruns_, overtimes_;  ///< in the last snapshot
};

/// The verdicts about the net that runs, as diagnostics show them for an agent. The controller has those of its own
/// net only, and refuses to run another one, so that none is out of date.
[[nodiscard]] Ros2Status proof_status(std::string_view agent, std::span<const VerifiedProperty> verdicts);

/// A run as nodes of ROS 2 show it.
class ShownInRos2 final : public Ros2Host {
 public:
  /// nullptr: the run has no driver of ROS 2, or a warning says why it is not shown. The assembly must outlive it.
  [[nodiscard]] static std::unique_ptr<ShownInRos2> of(Assembly& assembly, const Clock& clock);

  [[nodiscard]] std::vector<Ros2Parameter> parameters() const override;
  [[nodiscard]] std::optional<std::string> set(std::span<const Change> changes) override;
  [[nodiscard]] std::vector<Ros2Status> statuses() override;
  [[nodiscard]] std::string system() const override { return std::string(assembly_.system.name); }

 private:
  ShownInRos2(Assembly& assembly, const Clock& clock) : assembly_(assembly), clock_(clock) {}

  Assembly& assembly_;
  const Clock& clock_;
  Ros2Statuses statuses_;
  std::unique_ptr<Ros2Nodes> nodes_;  ///< the last member: it uses the others
};

}  // namespace tessera
