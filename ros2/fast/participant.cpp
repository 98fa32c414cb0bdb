#include "ros2/fast/participant.hpp"

#include <arpa/inet.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <ifaddrs.h>
#include <netdb.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <tuple>

namespace tessera::ros2 {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// As many participants of a host as Cyclone DDS is told to look for.
constexpr std::uint32_t participants_of_a_host = 33;

/// Samples are the bytes of a message, with their encapsulation.
class BytesType final : public dds::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = sizeof(std::uint32_t);
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const FastBytes& bytes = *static_cast<const FastBytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const auto* const first = reinterpret_cast<const std::byte*>(payload->data);
    static_cast<FastBytes*>(data)->assign(first, first + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const FastBytes*>(data)->size()); };
  }
  void* createData() override { return new FastBytes; }
  void deleteData(void* data) override { delete static_cast<FastBytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*key*/, bool /*md5*/) override { return false; }
};

/// "127.0.0.1" for "lo" and for itself.
std::string address_of_interface(const std::string& interface) {
  in_addr address{};
  if (inet_pton(AF_INET, interface.c_str(), &address) == 1) return interface;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) throw std::runtime_error("the network interfaces cannot be read");
  std::string found;
  for (const ifaddrs* one = first; one != nullptr && found.empty(); one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET || interface != one->ifa_name)
      continue;
    sockaddr_in of_interface{};
    std::memcpy(&of_interface, one->ifa_addr, sizeof of_interface);
    char text[INET_ADDRSTRLEN]{};
    if (inet_ntop(AF_INET, &of_interface.sin_addr, text, sizeof text) != nullptr) found = text;
  }
  freeifaddrs(first);
  if (found.empty()) throw std::runtime_error("the interface '" + interface + "' has no IPv4 address");
  return found;
}

std::string address_of_host(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  addrinfo* first = nullptr;
  if (getaddrinfo(host.c_str(), nullptr, &hints, &first) != 0 || first == nullptr)
    throw std::runtime_error("the host '" + host + "' has no IPv4 address");
  sockaddr_in of_host{};
  std::memcpy(&of_host, first->ai_addr, sizeof of_host);
  freeaddrinfo(first);
  char text[INET_ADDRSTRLEN]{};
  return inet_ntop(AF_INET, &of_host.sin_addr, text, sizeof text) == nullptr ? "" : text;
}

std::vector<std::string> addresses_of(const std::string& list) {
  std::vector<std::string> addresses;
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    std::string host = list.substr(at, comma - at);
    std::erase(host, ' ');
    if (!host.empty()) addresses.push_back(address_of_host(host));
    at = comma + 1;
  }
  return addresses;
}

dds::DomainParticipantQos participant_qos(const FastSetup& setup) {
  const std::string address = address_of_interface(setup.interface);
  std::vector<std::string> peers = addresses_of(setup.peers);
  if (peers.empty() && address.starts_with("127.")) peers.push_back(address);
  dds::DomainParticipantQos qos;
  qos.name("tessera");
  qos.transport().use_builtin_transports = false;
  auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList.push_back(address);
  transport->maxInitialPeersRange = participants_of_a_host;
  qos.transport().user_transports.push_back(transport);
  auto& builtin = qos.wire_protocol().builtin;
  builtin.avoid_builtin_multicast = true;
  for (const std::string& peer : peers) {
    rtps::Locator_t locator;
    rtps::IPLocator::setIPv4(locator, peer);
    builtin.initialPeersList.push_back(locator);
  }
  builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
  return qos;
}

}  // namespace

std::shared_ptr<FastParticipant> FastParticipant::of(const FastSetup& setup) {
  static std::mutex mutex;
  static std::map<std::tuple<std::uint32_t, std::string, std::string>, std::weak_ptr<FastParticipant>> known;
  const std::lock_guard lock(mutex);
  std::weak_ptr<FastParticipant>& one = known[{setup.domain, setup.interface, setup.peers}];
  if (auto shared = one.lock()) return shared;
  auto made = std::make_shared<FastParticipant>(setup);
  one = made;
  return made;
}

/// Fast DDS announces a participant shortly before it listens. Another one that answers at once is not heard, and
/// announces itself again only after 3 s. It answers a new participant, however.
FastParticipant::FastParticipant(const FastSetup& setup) {
  constexpr int most_tries = 3;
  make(setup);
  for (int tries = 1; tries < most_tries && !finds_another(); ++tries) {
    remove();
    make(setup);
  }
}

FastParticipant::~FastParticipant() { remove(); }

void FastParticipant::make(const FastSetup& setup) {
  participant_ = checked_fast(dds::DomainParticipantFactory::get_instance()->create_participant(
                                  setup.domain, participant_qos(setup), this, dds::StatusMask::none()),
                              "participant");
}

void FastParticipant::remove() {
  participant_->set_listener(nullptr);
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

/// There is one, or this would not have been made.
bool FastParticipant::finds_another() {
  constexpr auto longest = std::chrono::milliseconds(100);
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, longest, [this] { return found_; });
}

void FastParticipant::on_participant_discovery(dds::DomainParticipant* /*participant*/,
                                               rtps::ParticipantDiscoveryInfo&& info) {
  const auto& vendor_first = info.info.m_guid.guidPrefix.value;
  if (info.status != rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT || vendor_first[0] != 0x01 ||
      vendor_first[1] != 0x0f)
    return;
  {
    const std::lock_guard lock(mutex_);
    found_ = true;
  }
  changed_.notify_all();
}

dds::Topic* FastParticipant::topic(const std::string& name, const std::string& type) {
  if (auto* const made = dynamic_cast<dds::Topic*>(participant_->lookup_topicdescription(name))) return made;
  dds::TypeSupport support(new BytesType(type));
  support.register_type(participant_);
  return checked_fast(participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT), "topic");
}

}  // namespace tessera::ros2
