#include "server/recordings/notices.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::server {

using nlohmann::json;

namespace {

/// The subsystem that has written the entry; empty: the system.
std::string_view writer(const Recording& header, const Event& event) {
  const std::uint32_t instance = event.instance();
  return instance < header.instances.size() ? std::string_view(header.instances[instance])
                                            : std::string_view();
}

/// "NAME\nINCARNATION" of a process.
std::string process_text(const Recording::Entry& entry) {
  const std::string name = entry.text.substr(0, entry.text.find('\n'));
  return fmt::format("process {} {}", name, entry.event.version == 1 ? "begins again" : "has died");
}

const char* level_of(const Event& event) {
  constexpr std::array<const char*, 3> levels{"info", "warning", "error"};
  switch (event.kind()) {
    case Event::Kind::log:
      return levels[std::min<std::size_t>(event.version, levels.size() - 1)];
    case Event::Kind::fault:
      return event.is_told_fault() ? "warning" : "error";
    case Event::Kind::stop:
      return event.version == 0 ? "info" : "error";
    case Event::Kind::safe:
      return event.version == static_cast<std::uint32_t>(SafeEvent::refused) ? "error" : "warning";
    case Event::Kind::overrun:
      return "warning";
    default:
      return "info";
  }
}

}  // namespace

std::optional<json> notice_of(const Recording& header, const Recording::Entry& entry) {
  const Event& event = entry.event;
  std::string kind, text = entry.text;
  switch (event.kind()) {
    case Event::Kind::log:
      kind = "message";
      break;
    case Event::Kind::stop:
      kind = "end";
      break;
    case Event::Kind::fault:
      kind = "fault";
      break;
    case Event::Kind::safe:
      kind = "safe";
      break;
    case Event::Kind::parameter:
      kind = "parameter";
      break;
    case Event::Kind::overrun:
      kind = "overrun";
      text =
          fmt::format("missed {} {} of its rate", event.subject, event.subject == 1 ? "instant" : "instants");
      break;
    case Event::Kind::process:
      kind = "message";
      text = process_text(entry);
      break;
    default:
      return std::nullopt;
  }
  return json{{"t", event.time_ns},
              {"kind", std::move(kind)},
              {"who", writer(header, event)},
              {"text", std::move(text)},
              {"level", level_of(event)}};
}

void Notices::add(json notice) {
  std::deque<json>& kept = by_kind_[notice.at("kind").get<std::string>()];
  kept.push_back(std::move(notice));
  if (kept.size() <= most_) return;
  kept.pop_front();
  ++dropped_;
}

json Notices::kept() const {
  std::vector<json> all;
  for (const auto& [kind, notices] : by_kind_) all.insert(all.end(), notices.begin(), notices.end());
  std::ranges::stable_sort(all, {}, [](const json& one) { return one.at("t").get<std::int64_t>(); });
  return {{"notices", std::move(all)}, {"dropped", dropped_}};
}

json Notices::take() {
  if (by_kind_.empty()) return nullptr;
  json all = kept();
  by_kind_.clear();
  dropped_ = 0;
  return all;
}

}  // namespace tessera::server
