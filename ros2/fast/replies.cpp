// The library that sends replies by Fast DDS.
#include "ros2/fast/replies.hpp"

#include <arpa/inet.h>
#include <fastdds/rtps/common/WriteParams.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <ifaddrs.h>
#include <netdb.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

// Both sides of the call are C++; only the linkage is that of C.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif

namespace tessera::ros2 {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Code = eprosima::fastrtps::types::ReturnCode_t;

/// The bit of an endpoint's kind, the last byte of its GUID, that readers have.
constexpr std::uint8_t reader_bit = 0x04;
/// As many participants of a host as Cyclone DDS is told to look for.
constexpr std::uint32_t participants_of_a_host = 33;

using Bytes = std::vector<std::byte>;

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
    const Bytes& bytes = *static_cast<const Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const auto* const first = reinterpret_cast<const std::byte*>(payload->data);
    static_cast<Bytes*>(data)->assign(first, first + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
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

template <class Entity>
Entity* checked(Entity* entity, const char* what) {
  if (entity == nullptr) throw std::runtime_error(std::string("Fast DDS makes no ") + what);
  return entity;
}

Guid guid_of(const rtps::GUID_t& guid) {
  Guid bytes{};
  std::copy_n(guid.guidPrefix.value, participant_bytes, bytes.begin());
  std::copy_n(guid.entityId.value, bytes.size() - participant_bytes, bytes.begin() + participant_bytes);
  return bytes;
}

rtps::GUID_t guid_of(const Guid& bytes) {
  rtps::GUID_t guid;
  std::copy_n(bytes.begin(), participant_bytes, guid.guidPrefix.value);
  std::copy_n(bytes.begin() + participant_bytes, bytes.size() - participant_bytes, guid.entityId.value);
  return guid;
}

using Instant = std::chrono::steady_clock::time_point;
/// A reader that has not found the writer yet, though the writer has found it, loses what is written.
constexpr auto until_found_by_reader = std::chrono::milliseconds(100);

/// A participant for all services of a network: each takes a second or more until the clients have found it, and has
/// several threads.
class FastParticipant {
 public:
  [[nodiscard]] static std::shared_ptr<FastParticipant> of(const FastSetup& setup) {
    static std::mutex mutex;
    static std::map<std::tuple<std::uint32_t, std::string, std::string>, std::weak_ptr<FastParticipant>>
        known;
    const std::lock_guard lock(mutex);
    std::weak_ptr<FastParticipant>& one = known[{setup.domain, setup.interface, setup.peers}];
    if (auto shared = one.lock()) return shared;
    auto made = std::make_shared<FastParticipant>(setup);
    one = made;
    return made;
  }
  explicit FastParticipant(const FastSetup& setup)
      : participant_(checked(dds::DomainParticipantFactory::get_instance()->create_participant(
                                 setup.domain, participant_qos(setup)),
                             "participant")) {}
  ~FastParticipant() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  FastParticipant(const FastParticipant&) = delete;
  FastParticipant& operator=(const FastParticipant&) = delete;

  [[nodiscard]] dds::DomainParticipant* operator->() const { return participant_; }
  [[nodiscard]] dds::Topic* topic(const std::string& name, const std::string& type) {
    dds::TypeSupport support(new BytesType(type));
    support.register_type(participant_);
    return checked(participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT), "topic");
  }

 private:
  dds::DomainParticipant* participant_;
};

class Replies final : public FastReplies, private dds::DataWriterListener {
 public:
  explicit Replies(const FastSetup& setup) {
    try {
      open(setup);
    } catch (...) {
      close();
      throw;
    }
  }
  ~Replies() override { close(); }
  Replies(const Replies&) = delete;
  Replies& operator=(const Replies&) = delete;

  [[nodiscard]] Guid identity() const override { return guid_of(writer_->guid()); }

  [[nodiscard]] bool is_heard_by(const Guid& client) const override {
    const std::lock_guard lock(mutex_);
    const bool is_reader = (client.back() & reader_bit) != 0;
    const Instant found_before = Instant::clock::now() - until_found_by_reader;
    return std::ranges::any_of(readers_, [&](const auto& one) {
      const auto& [reader, since] = one;
      return since <= found_before &&
             (is_reader ? reader == client
                        : std::equal(reader.begin(), reader.begin() + participant_bytes, client.begin()));
    });
  }

  [[nodiscard]] bool write(std::span<const std::byte> message, const RelatedIdentity& request) override {
    Bytes bytes(message.begin(), message.end());
    rtps::WriteParams parameters;
    parameters.related_sample_identity().writer_guid(guid_of(request.endpoint));
    constexpr std::uint32_t bits = 32;
    parameters.related_sample_identity().sequence_number(rtps::SequenceNumber_t(
        static_cast<std::int32_t>(request.sequence >> bits), static_cast<std::uint32_t>(request.sequence)));
    return writer_->write(&bytes, parameters);
  }

  [[nodiscard]] bool await_receipt(Duration timeout) override {
    constexpr std::int64_t second = 1'000'000'000;
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(timeout).count();
    return writer_->wait_for_acknowledgments(eprosima::fastrtps::Duration_t(
               static_cast<std::int32_t>(ns / second), static_cast<std::uint32_t>(ns % second))) ==
           Code::RETCODE_OK;
  }

 private:
  void open(const FastSetup& setup) {
    participant_ = FastParticipant::of(setup);
    FastParticipant& participant = *participant_;
    topics_[0] = participant.topic(setup.reply_topic, setup.reply_type);
    topics_[1] = participant.topic(setup.request_topic, setup.request_type);
    publisher_ = checked(participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT), "publisher");
    dds::DataWriterQos offers;
    offers.user_data().data_vec({setup.user_data.begin(), setup.user_data.end()});
    offers.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    offers.durability().kind = dds::VOLATILE_DURABILITY_QOS;
    offers.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    offers.history().depth = 64;
    offers.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    writer_ = checked(publisher_->create_datawriter(topics_[0], offers, this), "writer");
    // Clients compare the number of a service's readers with that of its writers, so it has a reader too. It
    // is best-effort, and nobody reads it.
    subscriber_ = checked(participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT), "subscriber");
    dds::DataReaderQos asks;
    asks.user_data().data_vec({setup.user_data.begin(), setup.user_data.end()});
    asks.reliability().kind = dds::BEST_EFFORT_RELIABILITY_QOS;
    asks.history().depth = 1;
    asks.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    checked(subscriber_->create_datareader(topics_[1], asks), "reader");
  }

  void close() {
    if (participant_ == nullptr) return;
    FastParticipant& participant = *participant_;
    if (writer_ != nullptr) writer_->set_listener(nullptr);
    if (publisher_ != nullptr) {
      publisher_->delete_contained_entities();
      participant->delete_publisher(publisher_);
    }
    if (subscriber_ != nullptr) {
      subscriber_->delete_contained_entities();
      participant->delete_subscriber(subscriber_);
    }
    for (dds::Topic* const one : topics_)
      if (one != nullptr) participant->delete_topic(one);
    participant_.reset();
  }

  void on_publication_matched(dds::DataWriter* /*writer*/,
                              const dds::PublicationMatchedStatus& status) override {
    rtps::GUID_t guid;
    rtps::iHandle2GUID(guid, status.last_subscription_handle);
    const std::lock_guard lock(mutex_);
    if (status.current_count_change > 0)
      readers_[guid_of(guid)] = Instant::clock::now();
    else
      readers_.erase(guid_of(guid));
  }

  std::shared_ptr<FastParticipant> participant_;
  std::array<dds::Topic*, 2> topics_{};  // of replies and of requests
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  dds::DataWriter* writer_ = nullptr;
  mutable std::mutex mutex_;
  std::map<Guid, Instant> readers_;  // and since when they are matched
};

}  // namespace
}  // namespace tessera::ros2

extern "C" __attribute__((visibility("default"))) std::unique_ptr<tessera::ros2::FastReplies>
tessera_ros2_fast_replies_1(const tessera::ros2::FastSetup& setup, std::string& error) {
  try {
    return std::make_unique<tessera::ros2::Replies>(setup);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}
