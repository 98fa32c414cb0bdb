#include "bag/bag_writer.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "bag/raw_channel.hpp"

namespace tessera::bag {
namespace {

/// A chunk of so many bytes is closed. Readers decompress whole chunks.
constexpr std::size_t usual_chunk = 1U << 20U;

mcap::Metadata run_metadata(const Recording& recording) {
  return {"tessera",
          {{"bag_version", bag_version},
           {"system", recording.system},
           {"net_hash", recording.net_hash},
           {"verification_hash", recording.verification_hash},
           {"seed", std::to_string(recording.seed)},
           {"clock", recording.clock},
           {"time", "log_time and publish_time count nanoseconds from the start of the run, by this clock"}}};
}

/// Property -> verdict and method, as the header of the recording has them.
mcap::Metadata verdict_metadata(const Recording& recording) {
  mcap::Metadata metadata{"tessera.verdicts", {}};
  const auto header = nlohmann::json::parse(recording.header, nullptr, /*allow_exceptions=*/false);
  const auto text = [](const nlohmann::json& one, const char* key) {
    const auto found = one.find(key);
    return found != one.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  if (!header.is_object() || !header.contains("verdicts")) return metadata;
  for (const nlohmann::json& one : header["verdicts"]) {
    if (!one.is_object()) continue;
    const std::string method = text(one, "method");
    metadata.entries[text(one, "name")] = text(one, "verdict") + (method.empty() ? "" : " (" + method + ")");
  }
  return metadata;
}

}  // namespace

std::vector<mcap::Metadata> metadata_of(const Recording& recording) {
  return {run_metadata(recording), verdict_metadata(recording)};
}

BagWriter::BagWriter(const Recording& recording, const Background& background, const std::string& library)
    : conversion_(recording, background), writer_("", library) {
  writer_.attach({0, header_attachment, "application/json", recording.header});
  for (const Background::File& file : background.files)
    writer_.attach({0, file.name, file.media_type, file.content});
  for (const mcap::Metadata& one : metadata_of(recording)) writer_.add_metadata(one);
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas;  // by name and data
  for (const ChannelPlan& plan : conversion_.channels()) {
    mcap::Channel channel = plan.channel;
    if (!plan.schema.name.empty()) {
      const auto [found, is_new] = schemas.try_emplace({plan.schema.name, plan.schema.data});
      if (is_new)
        found->second = writer_.add_schema(plan.schema.name, plan.schema.encoding, plan.schema.data);
      channel.schema = found->second;
    }
    channels_.push_back(writer_.add_channel(std::move(channel)));
  }
}

void BagWriter::add(const Recording::Entry& entry) {
  last_ns_ = std::max(last_ns_, entry.event.time_ns);
  conversion_.convert(entry, [&](const Converted& made) {
    writer_.write(channels_[made.channel], made.log_ns, made.publish_ns, made.data);
  });
  // Only between entries: those of one chunk need no other.
  if (writer_.open_bytes() >= usual_chunk) writer_.close_chunk();
}

void BagWriter::end(std::uint64_t lost) {
  const std::uint64_t time = bag_time(last_ns_);
  writer_.write(channels_.front(), time, time, raw_end(last_ns_, lost));
  writer_.close_chunk();
}

}  // namespace tessera::bag
