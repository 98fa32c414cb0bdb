#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tessera/control_messages.hpp"

namespace tessera::project {

/// The state that a process of another machine (or of this one) has sent over the network. Any program there can have
/// written it. It was checked: this version reads its form, and it names a process of the deployment.
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

/// The source of the states that processes send over the network.
///
/// Threads: one.
class StatusFeed {
 public:
  virtual ~StatusFeed() = default;
  /// Removes and returns what has come since the last call. Never waits.
  [[nodiscard]] virtual std::vector<HeardStatus> take() = 0;
  /// The newest remarks for a person: why nothing is heard, which messages were dropped. Empty: none.
  [[nodiscard]] virtual std::string remark() const = 0;
};
/// Opens one for a system that meets there.
using OpenFeed =
    std::function<std::unique_ptr<StatusFeed>(const std::string& system, const Snapshot::Deployment& where)>;

/// Loads the library of the network, and reads with it, in a thread of its own.
/// library: libtessera_dds.so. If it cannot be loaded, or the network not be entered, `remark` says why.
[[nodiscard]] OpenFeed feed_of_library(const std::filesystem::path& library);

}  // namespace tessera::project
