#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "bag/channel.hpp"
#include "tessera/recording.hpp"

/// The channel that holds the recording itself, an entry in each message: 24 bytes of the event, then its text,
/// as the file of a recording has them (docs/reference/recordings.md). The header is an attachment.
namespace tessera::bag {

inline constexpr const char* raw_topic = "/tessera/recording";
inline constexpr const char* raw_encoding = "x-tessera-recording";
inline constexpr const char* header_attachment = "recording_header.json";

[[nodiscard]] ChannelPlan raw_plan();
/// The message of an entry.
[[nodiscard]] std::string raw_of(const Recording::Entry& entry);
/// The message of the last event of a recording.
[[nodiscard]] std::string raw_end(std::int64_t time_ns, std::uint64_t lost);

/// The first bytes of the file of a recording with this header.
[[nodiscard]] std::string file_start(std::string_view header);
/// The bytes of the entry in the file; empty: the message is none of this channel.
[[nodiscard]] std::string file_bytes(std::string_view raw);

}  // namespace tessera::bag
