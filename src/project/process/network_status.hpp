#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "project/process/control_messages.hpp"

namespace tessera::project {

/// What a process of another machine (or of this one) has sent over the network. Any program there can have written it; it
/// is checked as far as one can: it has a form that this version reads, and names a process of the deployment.
struct HeardStatus {
  enum class What : std::uint8_t {
    told,
    ended,    ///< it has said so
    vanished  ///< the middleware does not know it any more: it took its leave, or was silent for 20 s
  };
  What what = What::told;
  std::string process, incarnation;
  Snapshot snapshot;  ///< if it sent one
  std::string line;   ///< the same, as JSON of plain letters; empty: it was a brief one
};

/// Where what processes tell over the network comes from.
///
/// Threads: one.
class StatusFeed {
 public:
  virtual ~StatusFeed() = default;
  /// Removes and returns what has come since the last call. Never waits.
  [[nodiscard]] virtual std::vector<HeardStatus> take() = 0;
  /// What a person should know, the newest of each kind: why the network is not heard, what was dropped. Empty: nothing.
  [[nodiscard]] virtual std::string remark() const = 0;
};
/// Opens one for a system that meets there.
using OpenFeed =
    std::function<std::unique_ptr<StatusFeed>(const std::string& system, const Snapshot::Deployment& where)>;

/// Loads the library of the network, and reads with it, in a thread of its own.
/// library: libtessera_dds.so. If it cannot be loaded, or the network not be entered, `remark` says why.
[[nodiscard]] OpenFeed feed_of_library(const std::filesystem::path& library);

}  // namespace tessera::project
