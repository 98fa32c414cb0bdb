#include "project/verification/measured_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "replay/times/call_durations.hpp"
#include "tessera/recording.hpp"

namespace tessera::project {
namespace {

namespace fs = std::filesystem;
using spec::Duration;

constexpr std::size_t few_calls = 100;
constexpr std::size_t most_recordings_kept = 16;

/// The calls in a recording that have not failed.
struct MeasuredCalls {
  std::string problem;  ///< why there are none; empty: nothing stands in the way
  std::map<std::pair<std::string, std::string>, std::vector<Duration>> of;  ///< by subsystem and behaviour
};

MeasuredCalls read_calls(const fs::path& file) {
  MeasuredCalls calls;
  std::string problem;
  const std::optional<Recording> read = read_recording(file.string(), problem);
  if (!read) return calls.problem = std::move(problem), calls;
  if (read->clock == "simulated") {
    calls.problem = "it is of a simulated run, whose calls take the times that the specification says";
    return calls;
  }
  replay::CallReader reader;
  for (const Recording::Entry& entry : read->entries)
    if (const auto call = reader.follow(*read, entry); call && !call->failed)
      calls.of[{read->instances[call->instance], std::string(call->behaviour)}].push_back(
          Duration(call->took_ns));
  return calls;
}

/// An editor asks after each key.
std::shared_ptr<const MeasuredCalls> calls_in(const fs::path& file) {
  struct Kept {
    fs::file_time_type changed;
    std::uintmax_t size = 0;
    std::shared_ptr<const MeasuredCalls> calls;
  };
  static std::mutex mutex;
  static std::map<fs::path, Kept> kept;
  std::error_code error;
  const fs::file_time_type changed = fs::last_write_time(file, error);
  const std::uintmax_t size = error ? 0 : fs::file_size(file, error);
  const std::lock_guard lock(mutex);
  if (const auto found = kept.find(file);
      !error && found != kept.end() && found->second.changed == changed && found->second.size == size)
    return found->second.calls;
  auto calls = std::make_shared<const MeasuredCalls>(read_calls(file));
  if (kept.size() >= most_recordings_kept) kept.clear();
  if (!error) kept[file] = {changed, size, calls};
  return calls;
}

struct TextUnit {
  std::int64_t ns;
  const char* name;
};
constexpr TextUnit text_units[] = {{1'000'000'000, "s"}, {1'000'000, "ms"}, {1'000, "us"}, {1, "ns"}};

std::string number_text(std::int64_t ns, const TextUnit& unit) {
  return fmt::format("{:.6g}", static_cast<double>(ns) / static_cast<double>(unit.ns));
}

/// "1.23..4.5 ms"
std::string range_text(Duration least, Duration most) {
  const TextUnit& unit = *std::ranges::find_if(
      text_units, [&](const TextUnit& one) { return most.count() >= one.ns || one.ns == 1; });
  return fmt::format("{}..{} {}", number_text(least.count(), unit), number_text(most.count(), unit),
                     unit.name);
}

/// Two digits, outwards, and the margin of `tessera replay --takes`.
std::string proposal(Duration least, Duration most) {
  constexpr double margin = 0.2;
  const auto rounded = [](double ns, bool up) {
    std::int64_t whole = static_cast<std::int64_t>(ns), step = 1;
    while (whole / step >= 100) step *= 10;
    return Duration((whole + (up ? step - 1 : 0)) / step * step);
  };
  return range_text(rounded(static_cast<double>(least.count()) * (1 - margin), false),
                    rounded(std::max(1.0, static_cast<double>(most.count()) * (1 + margin)), true));
}

class MeasuredTimesReader {
 public:
  MeasuredTimesReader(spec::Model& model, const fs::path& project, diagnostics::Diagnostics& out)
      : model_(model), project_(project), out_(out) {}

  bool read() {
    for (const spec::DefinitionId definition : model_.definitions.ids())
      for (const spec::DefinedSubsystemId subsystem : model_.definitions[definition].subsystems.ids())
        for (spec::Behaviour& behaviour : model_.definitions[definition].subsystems[subsystem].behaviours)
          if (behaviour.takes.measured) read(definition, subsystem, behaviour);
    return good_;
  }

 private:
  void refuse(const spec::Behaviour& behaviour, std::string text, std::string hint) {
    out_.error("E385", behaviour.takes.measured->span, std::move(text), std::move(hint));
    good_ = false;
  }

  void read(spec::DefinitionId definition, spec::DefinedSubsystemId subsystem, spec::Behaviour& behaviour) {
    const std::string& name = behaviour.takes.measured->recording;
    const std::shared_ptr<const MeasuredCalls> calls = calls_in((project_ / name).lexically_normal());
    if (!calls->problem.empty())
      return refuse(behaviour, fmt::format("no times can be read from '{}': {}", name, calls->problem),
                    "name the recording of a real run (tessera run --record), relative to the specification");
    std::vector<Duration> times;
    for (const spec::Agent& agent : model_.agents) {
      if (agent.definition != definition) continue;
      const auto found = calls->of.find({model_.instance_path(agent.instance(subsystem)), behaviour.name});
      if (found != calls->of.end()) times.insert(times.end(), found->second.begin(), found->second.end());
    }
    if (times.empty())
      return refuse(behaviour,
                    fmt::format("'{}' has no call of '{}' that did not fail", name, behaviour.name),
                    named(*calls));
    compare(name, times, behaviour);
    behaviour.takes.points = spec::measured_points(std::move(times));
  }

  void compare(const std::string& name, const std::vector<Duration>& times, spec::Behaviour& behaviour) {
    spec::Takes& takes = behaviour.takes;
    const auto [least, most] = std::ranges::minmax(times);
    const std::string hint =
        fmt::format("for example within: {}, which is 20 % wider", proposal(least, most));
    if (!takes.measured->says_within)
      return refuse(
          behaviour,
          fmt::format("'takes' lacks 'within', the bounds of all calls; the {} calls in '{}' took {}",
                      times.size(), name, range_text(least, most)),
          hint);
    const auto outside = std::ranges::count_if(
        times, [&](Duration one) { return one < takes.shortest || one > takes.longest; });
    if (outside > 0)
      return refuse(
          behaviour,
          fmt::format("{} of the {} calls in '{}' are not within {}: they took {}", outside, times.size(),
                      name, range_text(takes.shortest, takes.longest), range_text(least, most)),
          hint);
    if (times.size() < few_calls)
      out_.warning("W343", takes.measured->span,
                   fmt::format("'{}' has {} calls of '{}' only", name, times.size(), behaviour.name),
                   fmt::format("with fewer than {} calls, rare long ones are missing", few_calls));
  }

  static std::string named(const MeasuredCalls& calls) {
    constexpr std::size_t most_named = 5;
    std::string text;
    std::size_t count = 0;
    for (const auto& [key, times] : calls.of)
      if (count++ < most_named) text += (text.empty() ? "" : ", ") + key.first + "." + key.second;
    if (count == 0) return "it has none at all; record the run with --record-values small";
    return "it has calls of " + text +
           (count > most_named ? fmt::format(" and {} more", count - most_named) : "");
  }

  spec::Model& model_;
  const fs::path& project_;
  diagnostics::Diagnostics& out_;
  bool good_ = true;
};

}  // namespace

bool read_measured_times(spec::Model& model, const fs::path& project, diagnostics::Diagnostics& out) {
  return MeasuredTimesReader(model, project, out).read();
}

}  // namespace tessera::project
