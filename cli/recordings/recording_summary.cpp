#include "cli/recordings/recording_summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "replay/events.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {

using nlohmann::json;
using replay::Distribution;

namespace {

std::string shown(double seconds) {
  if (seconds < 1e-6) return fmt::format("{:.0f} ns", seconds * 1e9);
  if (seconds < 1e-3) return fmt::format("{:.1f} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.3f} ms", seconds * 1e3);
  return fmt::format("{:.3f} s", seconds);
}

/// A row of block characters, one per step of the histogram. Every value above zero is visible.
std::string bars(const Distribution& distribution) {
  if (distribution.histogram.empty()) return {};
  constexpr const char* blocks[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const std::uint64_t most = std::ranges::max(distribution.histogram);
  std::string row = "  |";
  for (const std::uint64_t count : distribution.histogram)
    row += blocks[count == 0 ? 0 : std::max<std::uint64_t>(1, count * 8 / most)];
  return row + "|";
}

void print_distribution(const std::string& name, const Distribution& distribution) {
  if (distribution.count == 0) return;
  fmt::print("  {:<28} {:>10} {:>10} {:>10} {:>10}{}\n", printable(name), shown(distribution.least),
             shown(distribution.median), shown(distribution.p99), shown(distribution.most),
             bars(distribution));
}

std::string count_of(std::uint64_t count, const char* what) {
  return count == 0 ? std::string() : fmt::format(", {} {}", count, what);
}

json to_json(const Distribution& distribution) {
  return {{"count", distribution.count},        {"least_s", distribution.least},
          {"mean_s", distribution.mean},        {"median_s", distribution.median},
          {"p99_s", distribution.p99},          {"most_s", distribution.most},
          {"histogram", distribution.histogram}};
}

}  // namespace

json recorded_from_s(const Recording& recording) {
  if (recording.entries.empty()) return nullptr;
  return static_cast<double>(recording.entries.front().event.time_ns) * 1e-9;
}

void print_summary(const Recording& recording, const std::vector<replay::SubsystemStatistics>& all) {
  const double end_s =
      recording.entries.empty() ? 0 : static_cast<double>(recording.entries.back().event.time_ns) * 1e-9;
  fmt::print("{}: {} clock, seed {}, {:.3f} s, {} events{}\n", printable(recording.system),
             printable(recording.clock), recording.seed, end_s, recording.entries.size(),
             recording.truncated ? ", cut off" : "");
  if (lacks_beginning(recording)) fmt::print("{}\n", note_on_beginning(recording));
  if (recording.truncated)
    fmt::print(
        "its end is missing: the controller was killed, the disk was full, or the run still goes on\n");
  if (recording.lost > 0) fmt::print("{} events of the run are missing in it\n", recording.lost);
  fmt::print("net {}\n", printable(recording.net_hash));
  for (const replay::SubsystemStatistics& one : all) {
    constexpr std::size_t shown_waits = 4;
    fmt::print("\n{}: {} iterations, {} firings{}{}{}{}{}{}\n", printable(one.path), one.iterations,
               one.firings, count_of(one.errors, "errors"), count_of(one.overruns, "overruns"),
               count_of(one.faults, "faults"), count_of(one.timeouts, "timeouts"),
               count_of(one.skips, "skips"), count_of(one.overwrites, "overwrites"));
    if (one.iterations > 0)
      fmt::print("  {:<28} {:>10} {:>10} {:>10} {:>10}\n", "", "least", "median", "p99", "most");
    print_distribution("period", one.period);
    print_distribution("transition function", one.call);
    print_distribution("communication", one.iteration);
    for (std::size_t wait = 0; wait < std::min(shown_waits, one.waits.size()); ++wait)
      if (one.waits[wait].time.most > 0)
        print_distribution("wait for " + one.waits[wait].channel, one.waits[wait].time);
  }
  for (const Recording::Entry& entry : recording.entries)
    if (entry.event.kind() == Event::Kind::stop)
      fmt::print("\n{}: {}\n", entry.event.version == 0 ? "ended" : "failed", printable(entry.text));
}

json summary_json(const Recording& recording, const std::vector<replay::SubsystemStatistics>& all) {
  json subsystems = json::array();
  for (const replay::SubsystemStatistics& one : all) {
    json waits = json::object();
    for (const auto& wait : one.waits) waits[wait.channel] = to_json(wait.time);
    subsystems.push_back({{"path", one.path},
                          {"firings", one.firings},
                          {"iterations", one.iterations},
                          {"errors", one.errors},
                          {"overruns", one.overruns},
                          {"faults", one.faults},
                          {"timeouts", one.timeouts},
                          {"skips", one.skips},
                          {"overwrites", one.overwrites},
                          {"period", to_json(one.period)},
                          {"transition_function", to_json(one.call)},
                          {"communication", to_json(one.iteration)},
                          {"waits", std::move(waits)}});
  }
  json written{{"system", recording.system},
               {"net_hash", recording.net_hash},
               {"verification_hash", recording.verification_hash},
               {"clock", recording.clock},
               {"seed", recording.seed},
               {"events", std::ranges::count_if(recording.entries, replay::is_listed)},
               {"truncated", recording.truncated},
               {"lost", recording.lost},
               {"subsystems", std::move(subsystems)}};
  if (lacks_beginning(recording)) written["recorded_from_s"] = recorded_from_s(recording);
  return written;
}
}  // namespace tessera::cli
