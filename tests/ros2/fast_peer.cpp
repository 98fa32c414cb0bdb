#include "fast_peer.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <memory>
#include <stdexcept>

namespace fast {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

dds::DomainParticipantQos on_loopback(bool multicast) {
  dds::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  loopback->interfaceWhiteList.emplace_back("127.0.0.1");
  qos.transport().user_transports.push_back(loopback);
  auto& builtin = qos.wire_protocol().builtin;
  if (multicast) return qos;
  builtin.avoid_builtin_multicast = true;
  rtps::Locator_t here;
  rtps::IPLocator::setIPv4(here, 127, 0, 0, 1);
  builtin.initialPeersList.push_back(here);
  builtin.discovery_config.initial_announcements.count = 20;
  builtin.discovery_config.initial_announcements.period = {0, 100'000'000};
  return qos;
}

}  // namespace

Peer::Peer(std::uint32_t domain, Reach reach) {
  const dds::DomainParticipantQos qos =
      reach == Reach::all ? dds::PARTICIPANT_QOS_DEFAULT : on_loopback(reach == Reach::announced);
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  if (participant_ == nullptr) throw std::runtime_error("Fast DDS makes no participant");
  publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
}

Peer::~Peer() {
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

dds::Topic* Peer::topic(dds::TypeSupport& type, const std::string& name) {
  type.register_type(participant_);
  if (auto* const known = participant_->lookup_topicdescription(name))
    return dynamic_cast<dds::Topic*>(known);
  return participant_->create_topic(name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
}

dds::DataWriter* Peer::make_writer(dds::TypeSupport type, const std::string& name, bool reliable,
                                   const std::string& user_data, bool transient_local) {
  dds::DataWriterQos qos;
  qos.user_data().data_vec({user_data.begin(), user_data.end()});
  qos.reliable_writer_qos().times.heartbeatPeriod = {0, 20'000'000};  // not 3 s, so that receipts come soon
  qos.reliability().kind = reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = transient_local ? 1 : 10;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return publisher_->create_datawriter(topic(type, name), qos);
}

dds::DataReader* Peer::make_reader(dds::TypeSupport type, const std::string& name, bool transient_local,
                                   const std::string& user_data) {
  dds::DataReaderQos qos;
  qos.user_data().data_vec({user_data.begin(), user_data.end()});
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind =
      transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 100;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return subscriber_->create_datareader(topic(type, name), qos);
}

bool Peer::is_matched(dds::DataWriter& writer) {
  dds::PublicationMatchedStatus status;
  writer.get_publication_matched_status(status);
  return status.current_count > 0;
}

int Peer::found_by(dds::DataWriter& writer) {
  dds::PublicationMatchedStatus status;
  writer.get_publication_matched_status(status);
  return status.total_count;
}

bool Peer::is_matched(dds::DataReader& reader) {
  dds::SubscriptionMatchedStatus status;
  reader.get_subscription_matched_status(status);
  return status.current_count > 0;
}

}  // namespace fast
