#include "ros2/dds/graph.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "ros2/arguments/rules.hpp"
#include "ros2/codec/cdr.hpp"

namespace tessera::ros2 {
namespace {

constexpr const char* topic_name = "ros_discovery_info";
constexpr const char* type_name = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
/// The user data of our writers of the topic. ROS 2 ignores it.
constexpr std::string_view own_mark = "tessera=1;";

constexpr std::size_t size_of_humble = 24;
constexpr std::size_t size_since = 16;
/// The limit for announcements that wait, and for participants that are remembered.
constexpr std::size_t most_participants = 256;

dds_entity_t checked(const char* what, dds_entity_t entity) {
  if (entity < 0)
    throw std::runtime_error(std::string(what) + " " + topic_name + ": " + dds_strretcode(entity));
  return entity;
}

dds_qos_t* new_qos(dds_history_kind_t kept, std::size_t depth) {
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, kept, static_cast<std::int32_t>(depth));
  dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PARTICIPANT);
  dds_qset_userdata(qos, own_mark.data(), own_mark.size());
  return qos;
}

/// Whether a writer that the reader has found is one of a Tessera program.
bool is_one_of_ours(dds_entity_t reader, dds_instance_handle_t writer) {
  dds_builtintopic_endpoint_t* const known = dds_get_matched_publication_data(reader, writer);
  if (known == nullptr) return false;
  void* data = nullptr;
  std::size_t size = 0;
  bool ours = false;
  if (dds_qget_userdata(known->qos, &data, &size)) {
    ours = std::string_view(static_cast<const char*>(data), size) == own_mark;
    dds_free(data);
  }
  dds_builtintopic_free_endpoint(known);
  return ours;
}

}  // namespace

std::optional<std::size_t> identifier_size_in(std::span<const std::byte> message) {
  const std::size_t shortest = encapsulation_size + size_since + sizeof(std::uint32_t);
  const std::size_t shortest_of_humble = encapsulation_size + size_of_humble + sizeof(std::uint32_t);
  if (message.size() < shortest) return std::nullopt;
  if (message.size() < shortest_of_humble) return size_since;
  const auto rest = message.subspan(encapsulation_size + size_since, size_of_humble - size_since);
  const bool humble = std::ranges::all_of(rest, [](std::byte byte) { return byte == std::byte{0}; });
  return humble ? size_of_humble : size_since;
}

Graph::Graph(dds_entity_t participant) : participant_(participant) {
  try {
    open();
  } catch (...) {
    close();
    throw;
  }
}

Graph::~Graph() { close(); }

void Graph::open() {
  topic_ = create_blob_topic(participant_, topic_name, type_name);
  checked("cannot make the topic", topic_.entity);
  dds_qos_t* qos = new_qos(DDS_HISTORY_KEEP_LAST, 1);
  writer_ = dds_create_writer(participant_, topic_.entity, qos, nullptr);
  dds_delete_qos(qos);
  checked("cannot write to", writer_);
  // All participants are one instance of this topic, which has no keys.
  qos = new_qos(DDS_HISTORY_KEEP_LAST, most_participants);
  dds_listener_t* const listener = dds_create_listener(this);
  dds_lset_data_available(listener, [](dds_entity_t, void* self) { static_cast<Graph*>(self)->hear(); });
  dds_lset_subscription_matched(listener,
                                [](dds_entity_t, const dds_subscription_matched_status_t status, void* self) {
                                  if (status.current_count_change < 0) static_cast<Graph*>(self)->hear();
                                });
  reader_ = dds_create_reader(participant_, topic_.entity, qos, nullptr);
  dds_delete_qos(qos);
  // The listener uses `reader_`, and is not called for what came before it.
  if (reader_ > 0) static_cast<void>(dds_set_listener(reader_, listener));
  dds_delete_listener(listener);
  checked("cannot read", reader_);
  hear();
}

void Graph::close() {
  for (const dds_entity_t one : {reader_, writer_, topic_.entity})
    if (one > 0) dds_delete(one);
}

void Graph::add(const std::string& node, dds_entity_t endpoint, bool writes) {
  const std::lock_guard lock(mutex_);
  endpoints_.push_back(Endpoint{node, endpoint, writes});
  announce();
}

void Graph::remove(dds_entity_t endpoint) {
  const std::lock_guard lock(mutex_);
  std::erase_if(endpoints_, [&](const Endpoint& one) { return one.entity == endpoint; });
  announce();
}

/// Threads: those of Cyclone DDS.
void Graph::hear() {
  const std::lock_guard lock(mutex_);
  take_blobs(
      reader_, most_participants,
      [](void* self, const TakenBlob& blob) { static_cast<Graph*>(self)->note(blob); }, this);
  std::array<dds_instance_handle_t, most_participants> there{};
  const dds_return_t count = dds_get_matched_publications(reader_, there.data(), there.size());
  const auto end = there.begin() + std::clamp<std::ptrdiff_t>(count, 0, most_participants);
  std::erase_if(heard_, [&](const auto& one) { return std::find(there.begin(), end, one.first) == end; });
  if (written_ != 0 && written_ != identifier_size()) announce();
}

void Graph::note(const TakenBlob& blob) {
  const auto size = identifier_size_in(blob.message);
  if (size && heard_.size() < most_participants && !is_one_of_ours(reader_, blob.writer))
    heard_[blob.writer] = *size;
}

std::size_t Graph::identifier_size() const {
  const auto is_since = [](const auto& one) { return one.second == size_since; };
  return !heard_.empty() && std::ranges::all_of(heard_, is_since) ? size_since : size_of_humble;
}

void Graph::put_identifier(CdrWriter& writer, dds_entity_t entity) const {
  dds_guid_t guid{};
  static_cast<void>(dds_get_guid(entity, &guid));
  std::memcpy(writer.numbers(1, written_), guid.v, sizeof guid.v);
}

void Graph::announce() {
  written_ = identifier_size();
  std::map<std::string, std::vector<const Endpoint*>> nodes;
  for (const Endpoint& one : endpoints_) nodes[one.node].push_back(&one);
  std::vector<std::byte> message;
  CdrWriter writer(message);
  put_identifier(writer, participant_);
  writer.length(static_cast<std::uint32_t>(nodes.size()));
  for (const auto& [full, endpoints] : nodes) {
    const NodeName node = node_name_in(full);
    writer.text(node.name_space);
    writer.text(node.name);
    for (const bool writes : {false, true}) {
      const auto belongs = [&](const Endpoint* one) { return one->writes == writes; };
      writer.length(static_cast<std::uint32_t>(std::ranges::count_if(endpoints, belongs)));
      for (const Endpoint* one : endpoints)
        if (belongs(one)) put_identifier(writer, one->entity);
    }
  }
  writer.finish();
  // If this fails, other programs see fewer nodes; the topics work all the same.
  static_cast<void>(write_blob(writer_, topic_, message));
}

}  // namespace tessera::ros2
