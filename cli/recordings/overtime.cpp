#include "cli/recordings/overtime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "tessera/printable.hpp"

namespace tessera::cli {
namespace {

using nlohmann::json;

/// "threads went on at most 1.204 ms late (robot.motor); later than the latency: 3 times"; empty: no thread slept.
std::string latest_wakeup_text(const json& summary) {
  double latest_s = 0;
  std::uint64_t late = 0;
  std::string who;
  for (const json& one : summary.value("subsystems", json::array())) {
    late += one.value("late_wakeups", std::uint64_t{0});
    if (one.value("latest_wakeup_s", 0.0) <= latest_s) continue;
    latest_s = one.value("latest_wakeup_s", 0.0);
    who = one.value("path", "");
  }
  if (latest_s <= 0) return {};
  return fmt::format(
      "threads went on at most {:.3f} ms late ({}){}\n", latest_s * 1e3, printable(who),
      late == 0 ? "" : fmt::format("; later than the latency: {} time{}", late, late == 1 ? "" : "s"));
}

}  // namespace

std::vector<report::SlowCalls> slow_calls_of(const json& summary) {
  std::vector<report::SlowCalls> all;
  if (!summary.is_object()) return all;
  for (const json& one : summary.value("overtime", json::array()))
    all.push_back({.behaviour = one.value("behaviour", ""),
                   .slow = one.value("slow", std::uint64_t{0}),
                   .calls = one.value("calls", std::uint64_t{0}),
                   .declared_ns = one.value("declared_ns", std::int64_t{0}),
                   .longest_ns = one.value("longest_ns", std::int64_t{0}),
                   .longest_at_ns = one.value("longest_at_ns", std::int64_t{0})});
  return all;
}

std::string overtime_text(const json& summary, const std::vector<report::SlowCalls>& slow_calls) {
  constexpr std::size_t shown = 12;
  std::string text;
  for (std::size_t index = 0; index < std::min(slow_calls.size(), shown); ++index) {
    const report::SlowCalls& one = slow_calls[index];
    text += fmt::format(
        "overtime: {}: {} of {} calls took longer than its takes of {:g} ms; the longest took {:.3f} ms, at "
        "{:.3f} s\n",
        printable(one.behaviour), one.slow, one.calls, static_cast<double>(one.declared_ns) * 1e-6,
        static_cast<double>(one.longest_ns) * 1e-6, static_cast<double>(one.longest_at_ns) * 1e-9);
  }
  if (slow_calls.size() > shown)
    text += fmt::format("overtime: ... and {} more behaviours\n", slow_calls.size() - shown);
  return text + (summary.is_object() ? latest_wakeup_text(summary) : "");
}

std::string indented(const std::string& lines) {
  std::istringstream all(lines);
  std::string text;
  for (std::string line; std::getline(all, line);) text += "    " + line + "\n";
  return text;
}

}  // namespace tessera::cli
