#include "ros2/dds/domain.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <vector>

#include "network/dds/middleware_log.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::uint32_t highest_domain = 232;
/// Each domain object has a number of its own inside the process, so that two parts that use the same domain
/// with different settings stay apart.
constexpr std::uint32_t first_number = 0x7e55'0000;
constexpr const char* user_data = "enclave=/;";

bool is_host(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == ':' || c == '-' || c == '_';
  });
}
bool is_address(std::string_view text) {
  return text.find_first_not_of("0123456789.") == std::string_view::npos ||
         text.find(':') != std::string_view::npos;
}

std::vector<std::string> hosts_of(std::string_view list) {
  std::vector<std::string> hosts;
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string host(list.substr(0, comma));
    std::erase(host, ' ');
    if (!is_host(host)) throw std::runtime_error("'" + host + "' is no name and no address of a host");
    hosts.push_back(std::move(host));
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return hosts;
}

[[noreturn]] void refuse(const std::string& what, dds_return_t code) {
  throw std::runtime_error(what + ": " + dds_strretcode(code) + dds::take_newest_log_line());
}

dds_entity_t checked(const std::string& what, dds_entity_t entity) {
  if (entity < 0) refuse(what, entity);
  return entity;
}

}  // namespace

bool is_loopback(const Network& network) {
  return network.interface == "lo" || network.interface.starts_with("127.");
}

std::string configuration_of(const Network& network) {
  if (!is_host(network.interface))
    throw std::runtime_error("'" + network.interface + "' is no name and no address of a network interface");
  std::vector<std::string> peers = hosts_of(network.peers);
  if (is_loopback(network) && peers.empty()) peers.emplace_back("127.0.0.1");
  // Nodes of Fast DDS announce themselves to a multicast group at first. If it hears that, Cyclone DDS has found them
  // before they find it; if not, it misses the list of their topics that they send at once, and has it a second later.
  const bool multicast = network.peers.empty();
  const char* const on_interface = !multicast ? "false" : is_loopback(network) ? "true" : "default";
  std::string text = "<CycloneDDS><Domain><General><Interfaces><NetworkInterface ";
  text += (is_address(network.interface) ? "address=\"" : "name=\"") + network.interface + "\"";
  text += std::string(" multicast=\"") + on_interface + "\"/></Interfaces>";
  text += std::string("<AllowMulticast>") + (multicast ? "spdp" : "false") + "</AllowMulticast></General>";
  text += "<Discovery><ExternalDomainId>" + std::to_string(network.domain) + "</ExternalDomainId>";
  // The default is about 8 s, in which a node that starts later, and announces itself once, finds nobody.
  text += "<SPDPInterval>1s</SPDPInterval>";
  text +=
      "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers>";
  for (const std::string& peer : peers) text += "<Peer Address=\"" + peer + "\"/>";
  text += "</Peers></Discovery>";
  // Whoever closes a writer waits for the receipts that matter (`Endpoint::await_receipt`). By default Cyclone DDS
  // itself waits up to 1 s for each writer, so that some writers with a dead subscriber hold the end of a run.
  text += "<Internal><WriterLingerDuration>0 s</WriterLingerDuration></Internal>";
  return text + "</Domain></CycloneDDS>";
}

std::uint32_t domain_of_environment() {
  const char* const text = std::getenv("ROS_DOMAIN_ID");
  if (text == nullptr || *text == '\0') return 0;
  const char* const end = text + std::strlen(text);
  std::uint32_t domain = 0;
  const auto [behind, problem] = std::from_chars(text, end, domain);
  if (problem == std::errc() && behind == end && domain <= highest_domain) return domain;
  throw std::runtime_error("ROS_DOMAIN_ID is '" + std::string(text) + "', and not a number from 0 to 232");
}

namespace {

struct KnownParticipants {
  std::mutex mutex;
  std::map<Network, std::weak_ptr<Participant>> all;
};
KnownParticipants& known_participants() {
  static KnownParticipants known;
  return known;
}

}  // namespace

std::shared_ptr<Participant> Participant::of(const Network& network) {
  KnownParticipants& known = known_participants();
  const std::lock_guard lock(known.mutex);
  std::weak_ptr<Participant>& one = known.all[network];
  if (auto shared = one.lock()) return shared;
  const std::shared_ptr<Participant> made(new Participant(network));
  one = made;
  return made;
}

std::vector<std::shared_ptr<Participant>> Participant::all() {
  KnownParticipants& known = known_participants();
  const std::lock_guard lock(known.mutex);
  std::vector<std::shared_ptr<Participant>> open;
  for (const auto& [network, one] : known.all)
    if (auto shared = one.lock()) open.push_back(std::move(shared));
  return open;
}

Participant::Participant(const Network& network) : network_(network) {
  try {
    open(network);
  } catch (...) {
    graph_.reset();
    if (domain_ > 0) dds_delete(domain_);
    throw;
  }
}

/// Deleting the domain deletes all that is in it.
Participant::~Participant() {
  graph_.reset();
  dds_delete(domain_);
}

void Participant::open(const Network& network) {
  const std::string configuration = configuration_of(network);
  dds::keep_middleware_log();
  std::uint32_t number = first_number;
  do domain_ = dds_create_domain(number, configuration.c_str());
  while (domain_ == DDS_RETCODE_PRECONDITION_NOT_MET && ++number < first_number + 0x1000);
  checked("cannot open DDS on the interface '" + network.interface + "'", domain_);
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_userdata(qos, user_data, std::strlen(user_data));
  participant_ = dds_create_participant(number, qos, nullptr);
  dds_delete_qos(qos);
  checked("cannot take part in domain " + std::to_string(network.domain) + " of DDS", participant_);
  graph_.emplace(participant_);
}

bool Participant::knows_fast_dds() const {
  const dds_entity_t reader =
      dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
  if (reader < 0) return false;
  constexpr std::size_t most = 64;
  std::array<void*, most> samples{};
  std::array<dds_sample_info_t, most> infos{};
  const dds_return_t count = dds_take(reader, samples.data(), infos.data(), most, most);
  bool found = false;
  for (std::size_t index = 0; index < static_cast<std::size_t>(std::max(count, 0)); ++index) {
    if (!infos[index].valid_data || infos[index].instance_state != DDS_ALIVE_INSTANCE_STATE) continue;
    Guid guid{};
    std::copy_n(static_cast<const dds_builtintopic_participant_t*>(samples[index])->key.v, guid.size(),
                guid.begin());
    found = found || is_fast(guid);
  }
  if (count > 0) static_cast<void>(dds_return_loan(reader, samples.data(), count));
  dds_delete(reader);
  return found;
}

void Participant::note(const std::string& node, const std::string& agent) {
  const std::lock_guard lock(mutex_);
  nodes_[node].insert(agent);
}

std::map<std::string, std::set<std::string>> Participant::nodes() {
  const std::lock_guard lock(mutex_);
  return nodes_;
}

std::string Participant::new_service_identity() {
  const std::lock_guard lock(mutex_);
  dds_guid_t guid{};
  static_cast<void>(dds_get_guid(participant_, &guid));
  std::string identity;
  for (const unsigned char byte : guid.v)
    for (const unsigned half : {byte / 16U, byte % 16U}) identity += "0123456789abcdef"[half];
  return identity + "." + std::to_string(++services_);
}

}  // namespace tessera::ros2
