#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "network/dds/deployment.hpp"

namespace tessera::dds {

/// The version of the messages that carry values, states and signs of life. Messages of another version are
/// never read.
inline constexpr std::uint32_t wire_version = 2;

/// The description of itself that each process sends to all others of its domain.
struct Announcement {
  std::uint64_t incarnation = 0;
  std::string system, process_name;
  std::uint32_t wire_version = 0;
  std::string net_hash, processes_hash;
  std::string host, boot;

  auto operator<=>(const Announcement&) const = default;
};

/// The announcement of this process.
[[nodiscard]] Announcement announcement_of(const Deployment& deployment);

/// Reports processes of the same system that cannot work together with this one. Without a report, they would
/// silently never connect. Each is reported once.
class Announcements {
 public:
  explicit Announcements(const Deployment& deployment);
  /// The complaint; nullopt: there is none, or it was made before.
  [[nodiscard]] std::optional<std::string> hear(const Announcement& other);

 private:
  [[nodiscard]] std::optional<std::string> problem_with(const Announcement& other) const;

  Announcement own_;
  std::set<std::string> names_;  ///< of the processes of the deployment
  std::set<Announcement> told_;
};

}  // namespace tessera::dds
