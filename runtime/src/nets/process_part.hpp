#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "tessera/tables.hpp"

namespace tessera {

/// The part of a system that runs here: all of it, or the agents of one process. Its tables number instances
/// and channels anew; all code uses these numbers except recordings, messages to other processes, and the
/// hash.
///
/// A channel that ends in another process has no port there. One between two other processes is left out.
///
/// It can be moved but not copied, because its tables refer to it.
struct ProcessPart {
  ProcessPart() = default;
  ProcessPart(const ProcessPart&) = delete;
  ProcessPart& operator=(const ProcessPart&) = delete;
  ProcessPart(ProcessPart&&) = default;
  ProcessPart& operator=(ProcessPart&&) = default;
  ~ProcessPart() = default;

  const System* whole = nullptr;
  std::optional<std::uint32_t> process;  ///< into System::processes of the whole; nullopt: all run here
  System system;                         ///< of the part; refers to the vectors below
  std::vector<std::uint32_t> instances;  ///< in the whole, per instance of the part
  std::vector<std::uint32_t> agents;     ///< the same for agents
  std::vector<std::uint32_t> channels;   ///< the same for channels

  std::vector<Instance> own_instances;
  std::vector<Channel> own_channels;

  /// The channel of the whole.
  [[nodiscard]] const Channel& original(std::uint32_t channel) const {
    return whole->channels[channels[channel]];
  }
  [[nodiscard]] bool is_networked(std::uint32_t channel) const {
    return whole->is_networked(original(channel));
  }
  /// Whether the instance of the whole runs here.
  [[nodiscard]] bool has(std::uint32_t instance) const {
    return !process || whole->process_of[instance] == *process;
  }
};

[[nodiscard]] ProcessPart all_of(const System& whole);
/// nullopt: no process has that name.
[[nodiscard]] std::optional<ProcessPart> part_of(const System& whole, std::string_view process);

}  // namespace tessera
