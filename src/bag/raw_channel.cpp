#include "bag/raw_channel.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace tessera::bag {

ChannelPlan raw_plan() {
  return {{}, {0, 0, raw_topic, raw_encoding, {{"format", std::string(recording_magic)}}}};
}

std::string raw_of(const Recording::Entry& entry) {
  std::string bytes(reinterpret_cast<const char*>(&entry.event), sizeof entry.event);
  return bytes + entry.text;
}

std::string raw_end(std::int64_t time_ns, std::uint64_t lost) {
  Event end;
  end.time_ns = time_ns;
  end.subject =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, std::numeric_limits<std::uint32_t>::max()));
  end.origin = system_instance << 8U | static_cast<std::uint32_t>(Event::Kind::end);
  return raw_of({end, {}});
}

std::string file_start(std::string_view header) {
  std::string start(recording_magic);
  const auto length = static_cast<std::uint32_t>(header.size());
  start.append(reinterpret_cast<const char*>(&length), sizeof length);
  start += header;
  start.resize((start.size() + 7) / 8 * 8);
  return start;
}

std::string file_bytes(std::string_view raw) {
  Event event;
  if (raw.size() < sizeof event) return {};
  std::memcpy(&event, raw.data(), sizeof event);
  const std::uint64_t text = event.has_text() ? event.subject : 0;
  if (raw.size() - sizeof event != text) return {};
  std::string bytes(raw);
  bytes.resize((bytes.size() + sizeof event - 1) / sizeof event * sizeof event);
  return bytes;
}

}  // namespace tessera::bag
