#include "bag/conversion.hpp"

#include <algorithm>

#include "bag/event_channels.hpp"
#include "bag/raw_channel.hpp"

namespace tessera::bag {
namespace {

constexpr std::size_t raw_channel = 0, events_channel = 1, log_channel = 2;

/// The number of channels of a bag is a number of 16 bits.
constexpr std::size_t most_channels = 60'000;

Recording header_of(const Recording& recording) {
  Recording header = recording;
  header.entries.clear();
  return header;
}

}  // namespace

Conversion::Conversion(const Recording& recording, const Background& background)
    : recording_(header_of(recording)),
      channels_{raw_plan(), events_plan(), log_plan()},
      channel_of_buffer_(recording.buffers.size()),
      held_(recording.buffers.size()) {
  if (recording.scene) {
    poses_.emplace(*recording.scene);
    poses_channel_ = channels_.size();
    channels_.push_back(PoseChannel::plan());
  }
  for (std::size_t number = 0; number < recording.buffers.size(); ++number) {
    const Recording::Buffer& buffer = recording.buffers[number];
    buffers_.emplace_back();
    if (buffer.type.empty() || channels_.size() >= most_channels) continue;
    const auto ros = std::ranges::find(background.ros, buffer.path, &RosBuffer::path);
    const auto units = background.units.find(buffer.path);
    buffers_.back().emplace(
        buffer, ros == background.ros.end() ? nullptr : &*ros,
        units == background.units.end() ? std::map<std::string, std::string>() : units->second);
    channel_of_buffer_[number] = channels_.size();
    channels_.push_back(buffers_.back()->plan());
  }
}

void Conversion::convert(const Recording::Entry& entry, const Give& give) {
  const std::uint64_t time = bag_time(entry.event.time_ns);
  give({raw_channel, time, time, raw_of(entry)});
  if (entry.event.kind() == Event::Kind::value) return give_value(entry, give);
  if (entry.event.kind() == Event::Kind::poses) return give_poses(entry, give);
  if (const auto event = event_of(recording_, entry)) give({events_channel, time, time, *event});
  if (const auto log = log_of(recording_, entry)) give({log_channel, time, time, *log});
}

void Conversion::give_value(const Recording::Entry& entry, const Give& give) {
  const ValueEvent value = value_of(entry);
  const std::optional<BufferChannel>& buffer = buffers_[value.buffer];
  if (!buffer || value.has(ValueFlags::silent) || value.has(ValueFlags::failed)) return;
  Held& held = held_[value.buffer];
  if (!value.has(ValueFlags::same)) held = {std::string(value.bytes), !value.has(ValueFlags::hashed)};
  const std::uint64_t time = bag_time(entry.event.time_ns);
  Converted made{channel_of_buffer_[value.buffer],
                 time,
                 value.has(ValueFlags::stamped) ? bag_time(value.stamp_ns) : time,
                 {}};
  if (!held.is_known) {
    made.is_known = false;
    if (has_gap_ && value.has(ValueFlags::same)) give(made);
    return;
  }
  const std::optional<std::string> message = buffer->message_of(held.bytes, entry.event.time_ns);
  if (!message) return;
  made.data = *message;
  give(made);
}

void Conversion::give_poses(const Recording::Entry& entry, const Give& give) {
  if (!poses_) return;
  const std::uint64_t time = bag_time(entry.event.time_ns);
  const std::optional<std::string> message = poses_->message_of(entry);
  if (message)
    give({poses_channel_, time, time, *message});
  else if (has_gap_)
    give({poses_channel_, time, time, {}, false});
}

void Conversion::forget() {
  has_gap_ = true;
  for (Held& held : held_) held.is_known = false;
  if (poses_) poses_->forget();
}

}  // namespace tessera::bag
