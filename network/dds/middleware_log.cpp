#include "network/dds/middleware_log.hpp"

#include <dds/ddsrt/log.h>

#include <algorithm>
#include <mutex>
#include <string_view>
#include <utility>

namespace tessera::dds {
namespace {

struct Kept {
  std::mutex mutex;
  std::uint64_t lines = 0;  ///< since the last report
  std::string newest;
  std::chrono::steady_clock::time_point next = std::chrono::steady_clock::time_point::min();
};

/// It is never destroyed: threads of the middleware may log to the end of the process.
Kept& kept() {
  static Kept* const all = new Kept;
  return *all;
}

/// Makes text that may come from the network safe for a terminal.
std::string shown(std::string_view text) {
  constexpr std::size_t longest = 200;
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  std::string result(text.substr(0, longest));
  std::ranges::replace_if(
      result, [](char letter) { return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f; }, '?');
  return result;
}

void keep(void* /*context*/, const dds_log_data_t* data) {
  const std::string_view line(data->message, data->size);
  const std::lock_guard lock(kept().mutex);
  ++kept().lines;
  kept().newest = shown(line);
}

}  // namespace

void keep_middleware_log() {
  dds_set_log_sink(&keep, nullptr);
  static_cast<void>(take_newest_log_line());  // of an earlier run in this program
}

std::string take_newest_log_line() {
  const std::lock_guard lock(kept().mutex);
  kept().lines = 0;
  std::string newest = std::exchange(kept().newest, {});
  return newest.empty() ? newest : ": " + newest;
}

std::optional<std::string> middleware_log_report(std::chrono::steady_clock::time_point now) {
  const std::lock_guard lock(kept().mutex);
  if (kept().lines == 0 || now < kept().next) return std::nullopt;
  kept().next = now + std::chrono::seconds(1);
  const std::uint64_t lines = std::exchange(kept().lines, 0);
  const std::string newest = std::exchange(kept().newest, {});
  return "Cyclone DDS complains" +
         (lines == 1 ? "" : " (" + std::to_string(lines) + " times), the last time") + ": " + newest;
}

}  // namespace tessera::dds
