#include "ros2/dds/other_writers.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace tessera::ros2 {
namespace {

bool same(const dds_guid_t& one, const dds_guid_t& other, std::size_t bytes) {
  return std::memcmp(one.v, other.v, bytes) == 0;
}

/// "01.10.ab...": as `ros2 topic info -v` writes it.
std::string text_of(const dds_guid_t& guid) {
  std::string text;
  for (std::size_t index = 0; index < participant_bytes; ++index) {
    if (index > 0) text += '.';
    for (const unsigned half : {guid.v[index] / 16U, guid.v[index] % 16U}) text += "0123456789abcdef"[half];
  }
  return text;
}

}  // namespace

OtherWriters::OtherWriters(dds_entity_t participant, dds_entity_t own, std::string dds_topic)
    : topic_(std::move(dds_topic)) {
  static_cast<void>(dds_get_guid(own, &own_));
  static_cast<void>(dds_get_guid(participant, &participant_));
  reader_ = dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  if (reader_ < 0)
    throw std::runtime_error("cannot see the other publishers of " + topic_ + ": " + dds_strretcode(reader_));
}

OtherWriters::~OtherWriters() { dds_delete(reader_); }

std::vector<OtherWriters::Writer> OtherWriters::look(Clock::time_point now) {
  std::vector<Writer> found;
  if (now < next_look_) return found;
  next_look_ = now + between_looks;
  constexpr std::size_t most = 32;
  for (;;) {
    std::array<void*, most> samples{};
    std::array<dds_sample_info_t, most> infos{};
    const dds_return_t count = dds_take(reader_, samples.data(), infos.data(), most, most);
    if (count <= 0) return found;
    for (std::size_t index = 0; index < static_cast<std::size_t>(count); ++index) {
      if (!infos[index].valid_data || infos[index].instance_state != DDS_ALIVE_INSTANCE_STATE) continue;
      const auto& writer = *static_cast<const dds_builtintopic_endpoint_t*>(samples[index]);
      if (writer.topic_name != topic_ || same(writer.key, own_, sizeof own_.v)) continue;
      if (ours_ && std::memcmp(writer.key.v, ours_->data(), participant_bytes) == 0) continue;
      found.push_back({writer.type_name, text_of(writer.participant_key),
                       same(writer.participant_key, participant_, participant_bytes)});
    }
    static_cast<void>(dds_return_loan(reader_, samples.data(), count));
  }
}

}  // namespace tessera::ros2
