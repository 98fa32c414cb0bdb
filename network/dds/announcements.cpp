#include "network/dds/announcements.hpp"

#include <unistd.h>

#include <array>
#include <fstream>

namespace tessera::dds {
namespace {

/// The limit keeps other hosts from filling the memory.
constexpr std::size_t most_complaints = 1000;

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string boot_id() {
  std::string id;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), id);
  return id;
}

/// Text from other hosts, made safe for a terminal.
std::string shown(const std::string& text) {
  std::string result = text.substr(0, 64);
  for (char& letter : result)
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) letter = '?';
  return result;
}

}  // namespace

Announcement announcement_of(const Deployment& deployment) {
  static const std::string host = host_name(), boot = boot_id();
  return {.incarnation = deployment.incarnation,
          .system = deployment.system,
          .process_name = deployment.processes[deployment.process],
          .wire_version = wire_version,
          .net_hash = deployment.net_hash,
          .processes_hash = deployment.processes_hash,
          .host = host,
          .boot = boot};
}

Announcements::Announcements(const Deployment& deployment)
    : own_(announcement_of(deployment)), names_(deployment.processes.begin(), deployment.processes.end()) {}

std::optional<std::string> Announcements::hear(const Announcement& other) {
  if (told_.size() >= most_complaints || told_.contains(other)) return std::nullopt;
  std::optional<std::string> problem = problem_with(other);
  if (problem) told_.insert(other);
  return problem;
}

std::optional<std::string> Announcements::problem_with(const Announcement& other) const {
  if (other.system != own_.system) return std::nullopt;
  const std::string who = "process " + shown(other.process_name) + " on " + shown(other.host);
  if (other.wire_version != own_.wire_version)
    return who + " speaks version " + std::to_string(other.wire_version) + " of the messages, this process " +
           std::to_string(own_.wire_version) + ": neither reads the other";
  if (other.net_hash != own_.net_hash)
    return who + " executes another net of system " + own_.system + " (" + shown(other.net_hash) +
           ", this process " + own_.net_hash + "): build both from the same specification";
  if (!names_.contains(other.process_name))
    return who + " says that it is of system " + own_.system + ", whose deployment does not have it";
  if (other.processes_hash != own_.processes_hash)
    return who +
           " has another `deploy` than this one (its processes or its liveliness): build both from the "
           "same specification";
  if (other.process_name == own_.process_name && other.incarnation != own_.incarnation)
    return other.incarnation > own_.incarnation
               ? "process " + own_.process_name + " was started a second time, on " + shown(other.host) +
                     ": the other processes follow the later start and do not listen to this one any more"
               : "process " + own_.process_name + " runs already on " + shown(other.host) +
                     ": the other processes follow this later start";
  return std::nullopt;
}

}  // namespace tessera::dds
