#include "replay/values.hpp"

#include <fmt/core.h>

#include <cstring>

namespace tessera::replay {

std::string length_path(const std::string& sequence) {
  return sequence.empty() ? "size()" : sequence + ".size()";
}

ValueTrack::ValueTrack(const Recording& recording) : recording_(recording), held_(recording.buffers.size()) {
  for (std::size_t buffer = 0; buffer < held_.size(); ++buffer)
    held_[buffer].layout = ValueLayout::parse(recording.buffers[buffer].type);
}

std::optional<ValueTrack::Change> ValueTrack::follow(const Recording::Entry& entry) {
  if (entry.event.kind() != Event::Kind::value) return std::nullopt;
  const ValueEvent event = value_of(entry);
  if (event.buffer >= held_.size()) return std::nullopt;
  Held& held = held_[event.buffer];
  if (!event.has(ValueFlags::same | ValueFlags::silent | ValueFlags::failed)) {
    held.bytes = event.bytes;
    held.hashed = event.has(ValueFlags::hashed);
  }
  return Change{event.buffer, recording_.buffers[event.buffer],     event, held.bytes,
                held.hashed,  held.layout ? &*held.layout : nullptr};
}

ValueTrack::Value ValueTrack::value(std::uint32_t buffer) const {
  const Held& held = held_.at(buffer);
  return {held.bytes, held.hashed, held.layout ? &*held.layout : nullptr};
}

std::string text_of(const ValueTrack::Change& change) {
  if (change.event.has(ValueFlags::silent)) return "no value";
  if (change.event.has(ValueFlags::failed)) return "the device has failed";
  std::string text;
  if (change.hashed && change.bytes.size() >= 2 * sizeof(std::uint64_t)) {
    std::uint64_t size = 0, hash = 0;
    std::memcpy(&size, change.bytes.data(), sizeof size);
    std::memcpy(&hash, change.bytes.data() + sizeof size, sizeof hash);
    text = fmt::format("{} bytes, hash {:016x}", size, hash);
  } else {
    text = change.layout == nullptr ? fmt::format("{} bytes", change.bytes.size())
                                    : change.layout->shown(change.bytes);
  }
  if (change.event.has(ValueFlags::stamped) && !change.event.has(ValueFlags::valid)) text += ", invalid";
  return text;
}

}  // namespace tessera::replay
