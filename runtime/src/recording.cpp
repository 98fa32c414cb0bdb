#include "tessera/recording.hpp"

#include <fmt/core.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace tessera {
namespace {

constexpr std::string_view magic = "TESSREC1";

/// false when the JSON lacks what every recording has.
[[nodiscard]] bool read_header(Recording& recording) {
  const nlohmann::json header = nlohmann::json::parse(recording.header, nullptr, /*allow_exceptions=*/false);
  if (!header.is_object()) return false;
  try {
    header.at("system").get_to(recording.system);
    header.at("net_hash").get_to(recording.net_hash);
    header.at("verification_hash").get_to(recording.verification_hash);
    header.at("clock").get_to(recording.clock);
    header.at("seed").get_to(recording.seed);
    header.at("instances").get_to(recording.instances);
    for (const nlohmann::json& transition : header.at("transitions"))
      recording.transitions.push_back(
          {transition.at(0).get<std::string>(), transition.at(1).get<std::uint32_t>()});
  } catch (const nlohmann::json::exception&) {
    return false;
  }
  return true;
}

[[nodiscard]] bool makes_sense(const Event& event, const Recording& recording) {
  if (event.instance() != 0xffffff && event.instance() >= recording.instances.size()) return false;
  switch (event.kind()) {
    case Event::Kind::firing:
      return event.subject < recording.transitions.size();
    case Event::Kind::log:
    case Event::Kind::stop:
    case Event::Kind::overrun:
      return true;
    case Event::Kind::fault:
      return !name_of(static_cast<Fault>(event.version)).empty();
  }
  return false;
}

/// Events up to the first that is cut or damaged.
void read_events(std::string_view bytes, Recording& recording) {
  while (!bytes.empty()) {
    recording.truncated = true;  // until this event is known to be whole
    if (bytes.size() < sizeof(Event)) return;
    Recording::Entry entry;
    std::memcpy(&entry.event, bytes.data(), sizeof(Event));
    bytes.remove_prefix(sizeof(Event));
    if (!makes_sense(entry.event, recording)) return;
    if (entry.event.has_text()) {
      const std::size_t length = entry.event.subject;
      const std::size_t padded = (length + sizeof(Event) - 1) / sizeof(Event) * sizeof(Event);
      if (padded > bytes.size()) return;
      entry.text = bytes.substr(0, length);
      bytes.remove_prefix(padded);
    }
    recording.entries.push_back(std::move(entry));
    recording.truncated = false;
  }
}

}  // namespace

std::string_view name_of(Fault fault) {
  switch (fault) {
    case Fault::net:
      return "net";
    case Fault::assertion:
      return "assertion";
    case Fault::exception:
      return "exception";
    case Fault::not_finite:
      return "not finite";
    case Fault::device:
      return "device";
    case Fault::stale:
      return "stale";
    case Fault::stall:
      return "stall";
  }
  return "";
}

std::optional<Recording> read_recording(const std::string& path, std::string& error) {
  std::ifstream file(path, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad()) {
    error = fmt::format("cannot read '{}'", path);
    return std::nullopt;
  }
  std::string_view bytes = content;
  std::uint32_t length = 0;
  const std::size_t before_header = magic.size() + sizeof length;
  if (bytes.size() < before_header || !bytes.starts_with(magic)) {
    error = fmt::format("'{}' is no recording of Tessera", path);
    return std::nullopt;
  }
  std::memcpy(&length, bytes.data() + magic.size(), sizeof length);
  const std::size_t start_of_events = (before_header + length + 7) / 8 * 8;
  Recording recording;
  if (bytes.size() >= before_header + length) recording.header = bytes.substr(before_header, length);
  if (recording.header.empty() || !read_header(recording)) {
    error = fmt::format("the header of '{}' is damaged", path);
    return std::nullopt;
  }
  if (bytes.size() < start_of_events)
    recording.truncated = true;
  else
    read_events(bytes.substr(start_of_events), recording);
  return recording;
}

}  // namespace tessera
