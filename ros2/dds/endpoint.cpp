#include "ros2/dds/endpoint.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "network/dds/middleware_log.hpp"
#include "ros2/dds/misfits.hpp"

namespace tessera::ros2 {
namespace {

dds_duration_t dds_time_of(Duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

dds_qos_t* new_qos(const Qos& qos, const std::string& user_data) {
  dds_qos_t* const made = dds_create_qos();
  constexpr dds_duration_t longest_block = DDS_MSECS(100);
  dds_qset_reliability(made, qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       longest_block);
  dds_qset_durability(made, qos.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(made, DDS_HISTORY_KEEP_LAST, qos.depth);
  dds_qset_writer_data_lifecycle(made, false);
  if (qos.lifespan > Duration::zero()) dds_qset_lifespan(made, dds_time_of(qos.lifespan));
  if (!user_data.empty()) dds_qset_userdata(made, user_data.data(), user_data.size());
  return made;
}

std::string user_data_in(const dds_builtintopic_endpoint_t& known) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(known.qos, &data, &size)) return {};
  std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  return text;
}

Guid bytes_of(const dds_guid_t& guid) {
  Guid bytes{};
  std::copy_n(guid.v, bytes.size(), bytes.begin());
  return bytes;
}

void tell_of_middleware() {
  if (const auto text = dds::middleware_log_report(std::chrono::steady_clock::now()))
    std::fprintf(stderr, "warning: %s\n", text->c_str());
}

}  // namespace

Endpoint::Endpoint(const EndpointSetup& setup, bool writes)
    : participant_(Participant::of(setup.network)),
      state_(new ListenerState{setup.path, setup.topic, setup.dds_topic, setup.dds_type,
                               !writes && !setup.user_data.empty(), setup.on_message}),
      writes_(writes),
      depth_(static_cast<std::size_t>(setup.qos.depth)) {
  topic_ = create_blob_topic(participant_->entity(), setup.dds_topic.c_str(), setup.dds_type.c_str());
  if (topic_.entity < 0)
    throw std::runtime_error("cannot make the topic " + setup.topic + ": " + dds_strretcode(topic_.entity));
  dds_qos_t* const qos = new_qos(setup.qos, setup.user_data);
  dds_listener_t* const listener = dds_create_listener(state_.get());
  dds_lset_offered_incompatible_qos(
      listener, [](dds_entity_t, const dds_offered_incompatible_qos_status_t, void* state) {
        static_cast<ListenerState*>(state)->misfit = true;
      });
  dds_lset_requested_incompatible_qos(
      listener, [](dds_entity_t, const dds_requested_incompatible_qos_status_t, void* state) {
        static_cast<ListenerState*>(state)->misfit = true;
      });
  if (!writes && state_->on_message)
    dds_lset_data_available(
        listener, [](dds_entity_t, void* state) { static_cast<const ListenerState*>(state)->on_message(); });
  if (state_->remembers)
    dds_lset_subscription_matched(
        listener, [](dds_entity_t reader, const dds_subscription_matched_status_t status, void* state) {
          if (status.current_count_change > 0)
            remember(reader, status.last_publication_handle, *static_cast<ListenerState*>(state));
        });
  entity_ = writes ? dds_create_writer(participant_->entity(), topic_.entity, qos, listener)
                   : dds_create_reader(participant_->entity(), topic_.entity, qos, listener);
  dds_delete_listener(listener);
  dds_delete_qos(qos);
  if (entity_ < 0) {
    dds_delete(topic_.entity);
    throw std::runtime_error("cannot use the topic " + setup.topic + ": " + dds_strretcode(entity_));
  }
  participant_->graph().add(setup.node, entity_, writes);
  participant_->note(setup.node, setup.path.substr(0, setup.path.find('.')));
  if (writes && setup.sole_writer) look_for_other_writers(setup);
}

/// Without a look at the other writers, everything else works.
void Endpoint::look_for_other_writers(const EndpointSetup& setup) {
  try {
    other_writers_.emplace(participant_->entity(), entity_, setup.dds_topic);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "warning: %s: %s\n", setup.path.c_str(), error.what());
  }
}

std::vector<OtherWriters::Writer> Endpoint::new_other_writers() {
  if (!other_writers_) return {};
  return other_writers_->look(OtherWriters::Clock::now());
}

void Endpoint::take_for_ours(const Guid& writer) {
  if (other_writers_) other_writers_->take_for_ours(writer);
}

Endpoint::~Endpoint() {
  other_writers_.reset();
  participant_->graph().remove(entity_);
  dds_delete(entity_);
  dds_delete(topic_.entity);
}

bool Endpoint::has_other_side() const {
  dds_publication_matched_status_t readers{};
  dds_subscription_matched_status_t writers{};
  return writes_ ? dds_get_publication_matched_status(entity_, &readers) == DDS_RETCODE_OK &&
                       readers.current_count > 0
                 : dds_get_subscription_matched_status(entity_, &writers) == DDS_RETCODE_OK &&
                       writers.current_count > 0;
}

bool Endpoint::await_other_side(Duration timeout) const {
  constexpr auto between_looks = std::chrono::milliseconds(5);
  const auto until = std::chrono::steady_clock::now() + timeout;
  while (!has_other_side()) {
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(between_looks);
  }
  return true;
}

bool Endpoint::tell_of_misfits() const {
  const auto found =
      misfits(participant_->entity(), entity_, writes_, state_->topic, state_->dds_topic, state_->dds_type);
  for (const std::string& text : found) {
    const std::lock_guard lock(state_->mutex);
    if (!state_->told.insert(text).second) continue;
    std::fprintf(stderr, "warning: %s: %s, so that nothing passes between them; see docs/use/ros2.md\n",
                 state_->path.c_str(), text.c_str());
  }
  return !found.empty();
}

bool Endpoint::write(std::span<const std::byte> message) {
  tell_of_middleware();
  tell_if_misfit();
  return write_blob(entity_, topic_, message) == DDS_RETCODE_OK;
}

bool Endpoint::await_receipt(Duration timeout) const {
  return dds_wait_for_acks(entity_, dds_time_of(timeout)) == DDS_RETCODE_OK;
}

void Endpoint::remember(dds_entity_t reader, dds_instance_handle_t writer, ListenerState& state) {
  constexpr std::size_t most_writers = 4096;
  dds_builtintopic_endpoint_t* const known = dds_get_matched_publication_data(reader, writer);
  if (known == nullptr) return;
  const std::lock_guard lock(state.mutex);
  if (state.found.size() >= most_writers)
    state.found.clear();  // writers that still exist are found in
                          // `others`
  state.found[writer] = user_data_in(*known);
  dds_builtintopic_free_endpoint(known);
}

std::optional<std::string> Endpoint::user_data_of(dds_instance_handle_t writer) const {
  {
    const std::lock_guard lock(state_->mutex);
    if (const auto known = state_->found.find(writer); known != state_->found.end()) return known->second;
  }
  for (const Other& one : others())
    if (one.handle == writer) return one.user_data;
  return std::nullopt;
}

std::vector<Endpoint::Other> Endpoint::others() const {
  constexpr std::size_t most = 64;
  std::array<dds_instance_handle_t, most> handles{};
  const dds_return_t count = writes_ ? dds_get_matched_subscriptions(entity_, handles.data(), most)
                                     : dds_get_matched_publications(entity_, handles.data(), most);
  std::vector<Other> others;
  for (std::size_t index = 0; index < std::min(most, static_cast<std::size_t>(std::max(count, 0))); ++index) {
    dds_builtintopic_endpoint_t* const known =
        writes_ ? dds_get_matched_subscription_data(entity_, handles[index])
                : dds_get_matched_publication_data(entity_, handles[index]);
    if (known == nullptr) continue;
    others.push_back({handles[index], user_data_in(*known), bytes_of(known->key)});
    dds_builtintopic_free_endpoint(known);
  }
  return others;
}

std::uint64_t Endpoint::identity() const {
  dds_instance_handle_t handle = 0;
  static_cast<void>(dds_get_instance_handle(entity_, &handle));
  return handle;
}

Guid Endpoint::guid() const {
  dds_guid_t guid{};
  static_cast<void>(dds_get_guid(entity_, &guid));
  return bytes_of(guid);
}

void Endpoint::take(void (*use)(void*, const TakenBlob&), void* context) const {
  tell_of_middleware();
  tell_if_misfit();
  take_blobs(entity_, depth_, use, context);
}

}  // namespace tessera::ros2
