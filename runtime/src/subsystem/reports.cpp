#include "subsystem/reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <thread>

#include "system/console.hpp"

namespace tessera {

void Reports::log(LogLevel level, std::string_view text) const {
  while (control_.abandoned()) std::this_thread::sleep_for(std::chrono::seconds(1));
  const Time now = clock_.now();
  console::print(level, now, parts_.path, text);
  if (lane_ != nullptr) lane_->text(Event::Kind::log, now, static_cast<std::uint32_t>(level), text);
}

void Reports::report(Fault fault, std::string_view place, std::string_view what, RecordingLane* lane) const {
  write({fault}, place, what, parts_.effectors.empty() ? "" : "; the devices get the safe command", lane);
}

void Reports::tell(Fault fault, std::string_view place, std::string_view what, RecordingLane* lane) const {
  write({fault, /*is_told=*/true}, place, what, "", lane);
}

void Reports::write(Written fault, std::string_view place, std::string_view what, std::string_view effect,
                    RecordingLane* lane) const {
  const Time now = clock_.now();
  std::array<char, 768> text;
  const auto end =
      fmt::format_to_n(text.data(), text.size(), "{}.{}: {}{}", parts_.path, place, what, effect);
  const std::string_view line(text.data(), std::min(end.size, text.size()));
  if (lane != nullptr)
    lane->text(Event::Kind::fault, now,
               static_cast<std::uint32_t>(fault.of) | (fault.is_told ? told_fault : 0U), line);
  const std::size_t path = std::min(parts_.path.size() + 1 + place.size(), line.size());
  console::print(fault.is_told ? LogLevel::warning : LogLevel::error, now, line.substr(0, path),
                 line.substr(std::min(path + 2, line.size())));
}

void Reports::fail_run(std::string_view what) const {
  std::array<char, 512> reason;
  const auto end = fmt::format_to_n(reason.data(), reason.size(), "{}: {}", parts_.path, what);
  control_.request_stop({reason.data(), std::min(end.size, reason.size())}, /*fault=*/true);
}

}  // namespace tessera
