#include "network/dds/endpoints.hpp"

#include <atomic>
#include <memory>
#include <string>

#include "network/dds/announcements.hpp"
#include "network/dds/closed_sockets.hpp"
#include "network/dds/middleware_log.hpp"
#include "network/dds/settings.hpp"
#include "network/dds/setup_error.hpp"
#include "network/dds/status/status_topic.hpp"
#include "wire.h"

namespace tessera::dds {

dds_entity_t made(dds_entity_t entity, const char* what) {
  if (entity < 0)
    throw SetupError(std::string(what) + " cannot be made: " + dds_strretcode(entity) +
                     take_newest_log_line());
  return entity;
}

namespace {

Qos new_qos() { return {dds_create_qos(), &dds_delete_qos}; }

}  // namespace

Qos newest(dds_reliability_kind_t reliability, dds_durability_kind_t durability) {
  Qos qos = new_qos();
  dds_qset_reliability(qos.get(), reliability, 0);
  dds_qset_durability(qos.get(), durability);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return qos;
}

std::string plain_topic_name(std::string name) {
  for (char& letter : name)
    if (std::string_view("*[]?\"").find(letter) != std::string_view::npos) letter = '_';
  return name;
}

namespace {

Qos qos_of_data() { return newest(DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_VOLATILE); }
Qos qos_of_state() { return newest(DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_TRANSIENT_LOCAL); }
Qos qos_of_alive() { return newest(DDS_RELIABILITY_BEST_EFFORT, DDS_DURABILITY_VOLATILE); }

/// "tessera/2/line/0a1b/2c3d/data". Other versions, systems, nets and lists of processes have other names.
std::string topic_name(const Deployment& deployment, const char* what) {
  return plain_topic_name("tessera/" + std::to_string(wire_version) + "/" + deployment.system + "/" +
                          deployment.net_hash + "/" + deployment.processes_hash + "/" + what);
}

/// A number, because some implementations take names like "cart[0]" as patterns.
Qos in_partitions(const std::vector<ProcessNumber>& processes) {
  std::vector<std::string> names;
  for (const ProcessNumber process : processes) names.push_back(std::to_string(process));
  std::vector<const char*> pointers;
  for (const std::string& name : names) pointers.push_back(name.c_str());
  Qos qos = new_qos();
  dds_qset_partition(qos.get(), static_cast<std::uint32_t>(pointers.size()), pointers.data());
  return qos;
}

std::uint32_t next_number_of_domain() {
  static std::atomic<std::uint32_t> next{0x7e55e7a0U};  // far from the numbers that other programs use
  return next++;
}

}  // namespace

Domain::Domain(int number, const Location& location, std::chrono::seconds lease) {
  const std::string xml = settings(number, location, lease);
  keep_middleware_log();
  const OpenSockets before = open_sockets();
  const std::uint32_t id = next_number_of_domain();
  domain_ = made(dds_create_domain(id, xml.c_str()), "the DDS domain");
  try {
    close_sockets_to_other_interfaces(before, number, location);
    participant_ = made(dds_create_participant(id, nullptr, nullptr), "the DDS participant");
  } catch (...) {
    dds_delete(domain_);
    throw;
  }
}

Domain::~Domain() { dds_delete(domain_); }

Endpoints::Endpoints(const Deployment& deployment, int domain, const Location& location)
    : domain_(domain, location) {
  const dds_entity_t me = domain_.participant();
  const auto topic = [&](const dds_topic_descriptor_t& type, const std::string& name) {
    return made(dds_create_topic(me, &type, name.c_str(), nullptr, nullptr), name.c_str());
  };
  data_topic_ = topic(tessera_wire_Data_desc, topic_name(deployment, "data"));
  state_topic_ = topic(tessera_wire_State_desc, topic_name(deployment, "state"));
  alive_topic_ = topic(tessera_wire_Alive_desc, topic_name(deployment, "alive"));
  announcement_topic_ = topic(tessera_wire_Announcement_desc, "tessera/processes");
  waitset_ = made(dds_create_waitset(me), "a waitset");
  guard_ = made(dds_create_guardcondition(me), "a guard condition");
  made(dds_waitset_attach(waitset_, guard_, 0), "a wait");
  make_readers(deployment);
  for (const ProcessNumber peer : deployment.peers) make_writers(deployment, peer);
  make_alive_writer(deployment);
  make_status_writer(deployment);
  announce(deployment);
}

void Endpoints::make_readers(const Deployment& deployment) {
  const dds_entity_t me = domain_.participant();
  const dds_entity_t mine = made(
      dds_create_subscriber(me, in_partitions({deployment.process}).get(), nullptr), "the DDS subscriber");
  const auto reader = [&](dds_entity_t parent, dds_entity_t topic, const Qos& qos) {
    const dds_entity_t one = made(dds_create_reader(parent, topic, qos.get(), nullptr), "a DDS reader");
    wait_for(one);
    return one;
  };
  data_ = reader(mine, data_topic_, qos_of_data());
  state_ = reader(mine, state_topic_, qos_of_state());
  alive_ = reader(mine, alive_topic_, qos_of_alive());
  announcements_ = reader(me, announcement_topic_, qos_of_state());
}

void Endpoints::wait_for(dds_entity_t reader) const {
  const dds_entity_t something = made(dds_create_readcondition(reader, DDS_ANY_STATE), "a read condition");
  made(dds_waitset_attach(waitset_, something, 0), "a wait");
}

void Endpoints::make_writers(const Deployment& deployment, ProcessNumber peer) {
  const dds_entity_t publisher = made(
      dds_create_publisher(domain_.participant(), in_partitions({peer}).get(), nullptr), "a DDS publisher");
  const auto writer = [&](dds_entity_t topic, const Qos& qos) {
    return made(dds_create_writer(publisher, topic, qos.get(), nullptr), "a DDS writer");
  };
  Writers& writers = writers_[peer];
  if (deployment.sends_to(peer)) writers.data = writer(data_topic_, qos_of_data());
  if (deployment.receives_from(peer)) writers.state = writer(state_topic_, qos_of_state());
}

void Endpoints::make_alive_writer(const Deployment& deployment) {
  if (deployment.peers.empty()) return;
  const dds_entity_t publisher =
      made(dds_create_publisher(domain_.participant(), in_partitions(deployment.peers).get(), nullptr),
           "a DDS publisher");
  alive_writer_ =
      made(dds_create_writer(publisher, alive_topic_, qos_of_alive().get(), nullptr), "a DDS writer");
}

void Endpoints::make_status_writer(const Deployment& deployment) {
  const dds_entity_t me = domain_.participant();
  const std::string name = status_topic_name(deployment.system);
  const dds_entity_t topic =
      made(dds_create_topic(me, &tessera_wire_Status_desc, name.c_str(), nullptr, nullptr), name.c_str());
  status_writer_ = made(dds_create_writer(me, topic, qos_of_status().get(), nullptr), "a DDS writer");
}

void Endpoints::announce(const Deployment& deployment) const {
  const dds_entity_t writer =
      made(dds_create_writer(domain_.participant(), announcement_topic_, qos_of_state().get(), nullptr),
           "a DDS writer");
  Announcement own = announcement_of(deployment);
  const tessera_wire_Announcement sample{.incarnation = own.incarnation,
                                         .system = own.system.data(),
                                         .process_name = own.process_name.data(),
                                         .wire_version = own.wire_version,
                                         .net_hash = own.net_hash.data(),
                                         .processes_hash = own.processes_hash.data(),
                                         .host = own.host.data(),
                                         .boot = own.boot.data()};
  made(dds_write(writer, &sample), "the announcement of this process");
}

Endpoints::Writers Endpoints::to(ProcessNumber peer) const {
  const auto found = writers_.find(peer);
  return found == writers_.end() ? Writers{} : found->second;
}

void Endpoints::wait(dds_duration_t longest) const { dds_waitset_wait(waitset_, nullptr, 0, longest); }

bool Endpoints::was_woken() const {
  bool woken = false;
  return dds_take_guardcondition(guard_, &woken) == DDS_RETCODE_OK && woken;
}

}  // namespace tessera::dds
