#include "watch/emergency_watch.hpp"

#include <fmt/core.h>

#include <string>

#include "system/console.hpp"

namespace tessera {

void EmergencyWatch::say(News news, const RunControl& control, Time now, RecordingLane* lane) {
  if (news == News::none) return;
  const bool begins = news == News::begins;
  const std::string text =
      begins ? fmt::format("EMERGENCY STOP: {}; the devices get their safe commands until `tessera reset`",
                           control.emergency_reason())
             : "the emergency stop is over; each effector waits for new values";
  const LogLevel level = begins ? LogLevel::error : LogLevel::info;
  console::print(level, now, "tessera", text);
  if (lane != nullptr) lane->text(Event::Kind::log, now, static_cast<std::uint32_t>(level), text);
}

}  // namespace tessera
