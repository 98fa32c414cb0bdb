#pragma once

#include <condition_variable>
#include <cstddef>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros2/fast/service.hpp"

namespace tessera::ros2 {

/// A sample: the bytes of a message, with their encapsulation.
using FastBytes = std::vector<std::byte>;

/// The entity itself. Throws std::runtime_error: it is nullptr.
template <class Entity>
[[nodiscard]] Entity* checked_fast(Entity* entity, const char* what) {
  if (entity == nullptr) throw std::runtime_error(std::string("Fast DDS makes no ") + what);
  return entity;
}

/// A participant for all services of a network: each takes a second or more until the other side has found it, and has
/// several threads.
///
/// Threads: any.
class FastParticipant : private eprosima::fastdds::dds::DomainParticipantListener {
 public:
  /// Throws std::runtime_error.
  [[nodiscard]] static std::shared_ptr<FastParticipant> of(const FastSetup& setup);
  explicit FastParticipant(const FastSetup& setup);
  ~FastParticipant() override;
  FastParticipant(const FastParticipant&) = delete;
  FastParticipant& operator=(const FastParticipant&) = delete;

  [[nodiscard]] eprosima::fastdds::dds::DomainParticipant* operator->() const { return participant_; }
  /// A new topic, or the one with that name, whose samples are FastBytes. Its type has no keys.
  [[nodiscard]] eprosima::fastdds::dds::Topic* topic(const std::string& name, const std::string& type);

 private:
  void make(const FastSetup& setup);
  void remove();
  [[nodiscard]] bool finds_another();
  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant* participant,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool found_ = false;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
};

}  // namespace tessera::ros2
