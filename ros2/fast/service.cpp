// The library that carries services by Fast DDS.
#include "ros2/fast/service.hpp"

#include <fastdds/rtps/common/WriteParams.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "ros2/fast/participant.hpp"

// Both sides of the call are C++; only the linkage is that of C.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif

namespace tessera::ros2 {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Code = eprosima::fastrtps::types::ReturnCode_t;
using Instant = std::chrono::steady_clock::time_point;

/// The bit of an endpoint's kind, the last byte of its GUID, that readers have.
constexpr std::uint8_t reader_bit = 0x04;
/// A reader that has not found the writer yet, though the writer has found it, loses what is written.
constexpr auto until_found_by_reader = std::chrono::milliseconds(100);
/// Messages that wait until the driver is asked.
constexpr std::int32_t kept_messages = 64;
constexpr std::uint32_t bits_of_low = 32;

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

Guid guid_of(const rtps::InstanceHandle_t& handle) {
  rtps::GUID_t guid;
  rtps::iHandle2GUID(guid, handle);
  return guid_of(guid);
}

std::int64_t number_of(const rtps::SequenceNumber_t& sequence) {
  constexpr std::int64_t of_high = std::int64_t{1} << bits_of_low;
  return sequence.high * of_high + sequence.low;
}

class Service final : public FastService, private dds::DataWriterListener, private dds::DataReaderListener {
 public:
  explicit Service(const FastSetup& setup) : is_client_(setup.is_client) {
    try {
      open(setup);
    } catch (...) {
      close();
      throw;
    }
  }
  ~Service() override { close(); }
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  [[nodiscard]] Guid identity() const override { return guid_of(writer_->guid()); }

  [[nodiscard]] std::vector<Message> take() override {
    std::vector<Message> messages;
    const rtps::GUID_t nobody = rtps::GUID_t::unknown();
    FastBytes bytes;
    dds::SampleInfo info;
    while (reader_->take_next_sample(&bytes, &info) == Code::RETCODE_OK) {
      const rtps::GUID_t& related = info.related_sample_identity.writer_guid();
      if (!info.valid_data || related == nobody) continue;
      if (is_client_ && related != reader_->guid() && related != writer_->guid()) continue;
      const rtps::SampleIdentity& request = is_client_ ? info.related_sample_identity : info.sample_identity;
      messages.push_back({{guid_of(related), number_of(request.sequence_number())}, bytes});
    }
    return messages;
  }

  [[nodiscard]] bool await_receipt(Duration timeout) override {
    constexpr std::int64_t second = 1'000'000'000;
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(timeout).count();
    return writer_->wait_for_acknowledgments(eprosima::fastrtps::Duration_t(
               static_cast<std::int32_t>(ns / second), static_cast<std::uint32_t>(ns % second))) ==
           Code::RETCODE_OK;
  }

  [[nodiscard]] bool is_heard_by(const Guid& client) const override {
    const std::lock_guard lock(mutex_);
    const bool is_reader = (client.back() & reader_bit) != 0;
    const Instant found_before = Instant::clock::now() - until_found_by_reader;
    return std::ranges::any_of(readers_, [&](const auto& one) {
      const auto& [reader, since] = one;
      return since <= found_before && (is_reader ? reader == client : same_participant(reader, client));
    });
  }

  [[nodiscard]] bool is_there(const Guid& client) const override {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(writers_, [&](const Guid& one) { return same_participant(one, client); });
  }

  [[nodiscard]] bool reply(std::span<const std::byte> message, const RelatedIdentity& request) override {
    FastBytes bytes(message.begin(), message.end());
    rtps::WriteParams parameters;
    parameters.related_sample_identity().writer_guid(guid_of(request.endpoint));
    parameters.related_sample_identity().sequence_number(
        rtps::SequenceNumber_t(static_cast<std::int32_t>(request.sequence >> bits_of_low),
                               static_cast<std::uint32_t>(request.sequence)));
    return writer_->write(&bytes, parameters);
  }

  [[nodiscard]] std::size_t servers() const override {
    const std::lock_guard lock(mutex_);
    // Others would misread a request.
    if (!std::ranges::all_of(readers_, [](const auto& reader) { return is_fast(reader.first); })) return 0;
    return static_cast<std::size_t>(std::ranges::count_if(readers_, [&](const auto& reader) {
      return std::ranges::any_of(writers_,
                                 [&](const Guid& one) { return same_participant(one, reader.first); });
    }));
  }

  [[nodiscard]] std::optional<std::int64_t> request(std::span<const std::byte> message) override {
    FastBytes bytes(message.begin(), message.end());
    rtps::WriteParams parameters;
    parameters.related_sample_identity().writer_guid(reader_->guid());
    if (!writer_->write(&bytes, parameters)) return std::nullopt;
    return number_of(parameters.sample_identity().sequence_number());
  }

 private:
  void open(const FastSetup& setup) {
    participant_ = FastParticipant::of(setup);
    FastParticipant& participant = *participant_;
    topics_[0] = participant.topic(setup.request_topic, setup.request_type);
    topics_[1] = participant.topic(setup.reply_topic, setup.reply_type);
    subscriber_ = checked_fast(participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT), "subscriber");
    dds::DataReaderQos asks;
    asks.user_data().data_vec({setup.user_data.begin(), setup.user_data.end()});
    asks.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    asks.durability().kind = dds::VOLATILE_DURABILITY_QOS;
    asks.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    asks.history().depth = kept_messages;
    asks.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    reader_ = checked_fast(subscriber_->create_datareader(topics_[is_client_ ? 1 : 0], asks, this), "reader");
    publisher_ = checked_fast(participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT), "publisher");
    dds::DataWriterQos offers;
    offers.user_data().data_vec({setup.user_data.begin(), setup.user_data.end()});
    offers.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    offers.durability().kind = dds::VOLATILE_DURABILITY_QOS;
    offers.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    offers.history().depth = kept_messages;
    offers.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    writer_ =
        checked_fast(publisher_->create_datawriter(topics_[is_client_ ? 0 : 1], offers, this), "writer");
  }

  void close() {
    if (participant_ == nullptr) return;
    FastParticipant& participant = *participant_;
    if (writer_ != nullptr) writer_->set_listener(nullptr);
    if (reader_ != nullptr) reader_->set_listener(nullptr);
    if (publisher_ != nullptr) {
      publisher_->delete_contained_entities();
      participant->delete_publisher(publisher_);
    }
    if (subscriber_ != nullptr) {
      subscriber_->delete_contained_entities();
      participant->delete_subscriber(subscriber_);
    }
    for (dds::Topic* const one : topics_)  // refused if another service uses it
      if (one != nullptr) participant->delete_topic(one);
    participant_.reset();
  }

  void on_publication_matched(dds::DataWriter* /*writer*/,
                              const dds::PublicationMatchedStatus& status) override {
    const Guid guid = guid_of(status.last_subscription_handle);
    const std::lock_guard lock(mutex_);
    if (status.current_count_change > 0)
      readers_[guid] = Instant::clock::now();
    else
      readers_.erase(guid);
  }

  void on_subscription_matched(dds::DataReader* /*reader*/,
                               const dds::SubscriptionMatchedStatus& status) override {
    const Guid guid = guid_of(status.last_publication_handle);
    const std::lock_guard lock(mutex_);
    if (status.current_count_change > 0)
      writers_.insert(guid);
    else
      writers_.erase(guid);
  }

  const bool is_client_;
  std::shared_ptr<FastParticipant> participant_;
  std::array<dds::Topic*, 2> topics_{};  // of requests and of replies
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  dds::DataWriter* writer_ = nullptr;
  dds::DataReader* reader_ = nullptr;
  mutable std::mutex mutex_;
  std::map<Guid, Instant> readers_;  // and since when they are matched
  std::set<Guid> writers_;
};

}  // namespace
}  // namespace tessera::ros2

extern "C" __attribute__((visibility("default"))) std::unique_ptr<tessera::ros2::FastService>
tessera_ros2_fast_service_2(const tessera::ros2::FastSetup& setup, std::string& error) {
  try {
    return std::make_unique<tessera::ros2::Service>(setup);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}
