#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "mcap/reader.hpp"

/// Any bytes are read to their end: the first byte says whether the others follow the magic of a file. Every message
/// belongs to a channel, and none reaches outside of its chunk.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::string_view given(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string file =
      data[0] == 0 ? std::string(given) : std::string(tessera::mcap::magic) + std::string(given);
  std::uint64_t messages = 0, bytes = 0;
  const tessera::mcap::Condition condition = tessera::mcap::read(
      file, {.message =
                 [&](const tessera::mcap::ReadMessage& one) {
                   ++messages;
                   for (const char byte : one.message.data) bytes += static_cast<std::uint8_t>(byte);
                   if (one.channel.id != one.message.channel) std::abort();
                   if (one.schema != nullptr && one.schema->id != one.channel.schema) std::abort();
                 },
             .attachment = [&](const tessera::mcap::Attachment& one) { bytes += one.data.size(); },
             .metadata = [&](const tessera::mcap::Metadata& one) { bytes += one.entries.size(); },
             .gap = [&] { ++bytes; }});
  if (messages != condition.messages) std::abort();
  return bytes == UINT64_MAX ? 1 : 0;
}
