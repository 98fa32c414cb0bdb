#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "network/status.hpp"
#include "project/process/network_status.hpp"

namespace tessera::project {

/// Checks texts from the network, and keeps them until they are taken. Their number is bounded: a source has one newest
/// text of each part, and only a few starts of each process of the deployment are sources.
///
/// Threads: any.
class StatusInbox final : public network::StatusReader::Listener {
 public:
  StatusInbox(std::string system, const Snapshot::Deployment& deployment);

  void heard(const network::StatusSource& source, network::StatusPart part, std::string_view text) override;
  void left(const network::StatusSource& source) override;
  void complaint(std::string_view text) override;

  [[nodiscard]] std::vector<HeardStatus> take();
  [[nodiscard]] std::string remark() const;

 private:
  /// nullopt: no process of the deployment sends this.
  [[nodiscard]] std::optional<HeardStatus> read(const network::StatusSource& source, network::StatusPart part,
                                                std::string_view text) const;
  /// Whether this start of the process may be kept: a few of each may.
  [[nodiscard]] bool admit(const network::StatusSource& source, const std::string& process);
  void keep(HeardStatus heard);

  const std::string system_;
  std::set<std::string, std::less<>> processes_;
  mutable std::mutex mutex_;
  std::map<network::StatusSource, std::string> names_;  ///< of the processes that were heard
  std::vector<HeardStatus> kept_;
  std::uint64_t dropped_ = 0;
  std::string complaint_;
};

}  // namespace tessera::project
