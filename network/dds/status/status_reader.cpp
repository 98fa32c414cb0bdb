#include "network/dds/status/status_reader.hpp"

#include "network/dds/middleware_log.hpp"
#include "network/dds/presence.hpp"
#include "network/dds/setup_error.hpp"
#include "network/dds/status/status_topic.hpp"
#include "wire.h"

namespace tessera::dds {
namespace {

/// The limit keeps a flood of messages from holding up receive() for ever.
constexpr int most_texts_at_once = 1000;
/// Each start of a process has two texts. The limit keeps invented starts from filling the memory.
constexpr int most_sources = 4096;
/// Clients come and go, and the processes shall forget them soon. A client announces itself every 4 s.
constexpr std::chrono::seconds lease_of_reader{10};

Qos qos_of_reader() {
  Qos qos = qos_of_status();
  dds_qset_resource_limits(qos.get(), most_sources, most_sources, 1);
  return qos;
}

}  // namespace

DdsStatusReader::Reading::Reading(int number, const Location& location, const std::string& system)
    : domain(number, location, lease_of_reader) {
  const dds_entity_t me = domain.participant();
  const std::string name = status_topic_name(system);
  const dds_entity_t topic =
      made(dds_create_topic(me, &tessera_wire_Status_desc, name.c_str(), nullptr, nullptr), name.c_str());
  reader = made(dds_create_reader(me, topic, qos_of_reader().get(), nullptr), "a DDS reader");
  waitset = made(dds_create_waitset(me), "a waitset");
  const dds_entity_t something = made(dds_create_readcondition(reader, DDS_ANY_STATE), "a read condition");
  made(dds_waitset_attach(waitset, something, 0), "a wait");
}

DdsStatusReader::DdsStatusReader(const network::StatusReaderSetup& setup)
    : system_(setup.system),
      domain_(setup.domain),
      location_(locate(setup.interface, setup.peers)),
      search_(location_.unresolved_hosts(), resolve),
      reading_(std::make_unique<Reading>(domain_, location_, system_)) {}

void DdsStatusReader::receive(Listener& listener, std::chrono::nanoseconds longest) {
  tell_of_unresolved(listener);
  join_found(listener);
  dds_waitset_wait(reading_->waitset, nullptr, 0, longest.count());
  take(listener);
  if (const auto text = middleware_log_report(Clock::now())) listener.complaint(*text);
}

void DdsStatusReader::tell_of_unresolved(Listener& listener) {
  for (const Location::Unresolved& one : location_.unresolved)
    listener.complaint("host " + one.host + " has no IPv4 address (" + one.why + "): it is asked for again");
  location_.unresolved.clear();
}

/// The middleware takes peers only when its domain is made.
void DdsStatusReader::join_found(Listener& listener) {
  bool any = false;
  for (const PeerSearch::Found& found : search_.take_found()) try {
      any = add_peer(location_, found.host, found.address) || any;
    } catch (const SetupError& problem) {
      listener.complaint(problem.what());
    }
  if (!any) return;
  try {
    reading_ = std::make_unique<Reading>(domain_, location_, system_);
  } catch (const SetupError& problem) {
    listener.complaint(std::string("peers cannot be added: ") + problem.what());
  }
}

void DdsStatusReader::take(Listener& listener) const {
  void* loan = nullptr;
  dds_sample_info_t info{};
  for (int taken = 0; taken < most_texts_at_once && dds_take(reading_->reader, &loan, &info, 1, 1) == 1;
       ++taken) {
    const auto& sample = *static_cast<const tessera_wire_Status*>(loan);
    const network::StatusSource source{sample.process, sample.incarnation};
    if (info.valid_data) {
      const std::string_view text(reinterpret_cast<const char*>(sample.text._buffer), sample.text._length);
      const bool whole = sample.part == static_cast<std::uint8_t>(network::StatusPart::whole);
      listener.heard(source, whole ? network::StatusPart::whole : network::StatusPart::brief, text);
    }
    if (info.instance_state != DDS_IST_ALIVE) listener.left(source);
    dds_return_loan(reading_->reader, &loan, 1);
    loan = nullptr;
  }
}

}  // namespace tessera::dds
