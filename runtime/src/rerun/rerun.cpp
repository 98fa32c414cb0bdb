#include "rerun/rerun.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "assembly/assembly.hpp"
#include "rerun/rerun_subsystem.hpp"
#include "tessera/result.hpp"

namespace tessera {
namespace {

using Entry = Recording::Entry;

/// Plays the whole recording.
class Play {
 public:
  Play(const System& system, RunOptions options, const Recording& recording)
      : options_(with_recorded(std::move(options), recording)),
        recording_(recording),
        assembly_(system, options_) {}

  [[nodiscard]] std::optional<RerunReport> report(std::string& error) {
    const auto refuse = [&](const Problem& problem) {
      error = problem.text;
      return std::nullopt;
    };
    if (const std::optional<Problem> wrong = complaint()) return refuse(*wrong);
    LooseParts parts;
    if (!take_apart(assembly_, clock_, parts, error)) return std::nullopt;
    if (const std::optional<Problem> wrong = complaint_of_buffers(parts)) return refuse(*wrong);
    if (const std::optional<Problem> wrong = complaint_of_events(parts)) return refuse(*wrong);
    std::uint32_t first_buffer = 0;
    for (LoosePart& part : parts.parts) {
      const std::uint32_t count = count_buffers(part.parts.bindings);
      subsystems_.push_back(
          std::make_unique<RerunSubsystem>(part, first_buffer, recording_, assembly_.control, clock_));
      first_buffer += count;
    }
    play();
    return std::move(report_);
  }

 private:
  static RunOptions with_recorded(RunOptions options, const Recording& recording) {
    options.parameters.insert(options.parameters.begin(), recording.parameters.begin(),
                              recording.parameters.end());
    options.seed = recording.seed;
    options.inject = recording.injected;
    if (recording.duration_ns) options.duration = Duration(*recording.duration_ns);
    return options;
  }

  /// The reason why this recording cannot be run again.
  [[nodiscard]] std::optional<Problem> complaint() const {
    const System& system = assembly_.system;
    if (recording_.net_hash != system.net_hash)
      return Problem{
          fmt::format("it is a recording of another net ({}, this controller's is {}): its specification has "
                      "changed since",
                      recording_.net_hash, system.net_hash)};
    if (recording_.buffers.empty())
      return Problem{"it holds no values of buffers: record the run with --record-values small or all"};
    if (lacks_beginning(recording_))
      return Problem{note_on_beginning(recording_) +
                     "\nwithout the beginning nobody knows what the code remembered"};
    if (std::ranges::any_of(recording_.entries,
                            [](const Entry& entry) { return entry.event.kind() == Event::Kind::process; }))
      return Problem{"a process dies in it, and forgets what its code would remember here"};
    std::vector<std::uint32_t> next(recording_.instances.size());
    for (const Entry& entry : recording_.entries) {
      if (entry.event.instance() >= next.size()) continue;
      std::uint32_t& due = next[entry.event.instance()];
      const std::string& path = recording_.instances[entry.event.instance()];
      if (entry.event.sequence != due++)
        return Problem{fmt::format("events of {} are missing at {:.6f} s", path,
                                   seconds(Duration(entry.event.time_ns)))};
      if (entry.event.kind() != Event::Kind::value) continue;
      const ValueEvent value = value_of(entry);
      const Recording::Buffer& buffer = recording_.buffers[value.buffer];
      const bool in = buffer.direction == Recording::Direction::input ||
                      buffer.direction == Recording::Direction::real_input;
      if (in && value.has(ValueFlags::hashed))
        return Problem{fmt::format(
            "the values of {} are too large and not in it: record with --record-values all", buffer.path)};
    }
    return std::nullopt;
  }

  /// Checks that the controller's buffers are those of the recording.
  [[nodiscard]] std::optional<Problem> complaint_of_buffers(const LooseParts& parts) const {
    std::size_t number = 0;
    std::optional<Problem> wrong;
    for (const LoosePart& part : parts.parts)
      for_buffers(part.parts.bindings, [&](Recording::Direction direction, const auto& buffer) {
        const std::string path = fmt::format("{}.{}", part.parts.path, buffer.name);
        const std::string type = buffer.encoding == nullptr ? "" : buffer.encoding->type();
        const std::size_t index = number++;
        if (wrong) return;
        if (index >= recording_.buffers.size() || recording_.buffers[index].path != path ||
            recording_.buffers[index].direction != direction)
          wrong = Problem{fmt::format("it knows no buffer {}", path)};
        else if (recording_.buffers[index].type != type)
          wrong = Problem{fmt::format("in it {} is {}, and in this controller {}", path,
                                      recording_.buffers[index].type, type)};
        else if (type.empty())
          wrong = Problem{fmt::format("values of {} cannot be recorded: its type has no fixed extent", path)};
      });
    // The memory, which is listed last, follows from the inputs.
    const bool knows_all = number >= recording_.buffers.size() ||
                           recording_.buffers[number].direction == Recording::Direction::memory;
    if (!wrong && !knows_all)
      wrong = Problem{fmt::format("this controller has no buffer {}", recording_.buffers[number].path)};
    return wrong;
  }

  /// The header belongs to a recording of this net, but the events of a damaged file may be arbitrary.
  [[nodiscard]] std::optional<Problem> complaint_of_events(const LooseParts& parts) const {
    if (recording_.instances.size() != parts.parts.size()) return Problem{"it is damaged"};
    for (const Entry& entry : recording_.entries) {
      const Event& event = entry.event;
      if (event.instance() >= parts.parts.size()) continue;
      const LoosePart& part = parts.parts[event.instance()];
      const bool fits = event.kind() == Event::Kind::firing
                            ? event.subject >= part.first_transition &&
                                  event.subject - part.first_transition < part.plan->transitions.size()
                        : event.kind() == Event::Kind::call
                            ? event.subject < part.parts.instance->net->behaviours.size()
                            : true;
      if (!fits) return Problem{"it is damaged"};
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<RecordedMoment> moments() const {
    std::vector<RecordedMoment> all;
    std::vector<std::optional<std::size_t>> last(recording_.instances.size());
    for (const Entry& entry : recording_.entries) {
      const std::uint32_t instance = entry.event.instance();
      if (instance >= last.size()) continue;
      const Event::Kind kind = entry.event.kind();
      if (kind == Event::Kind::firing || kind == Event::Kind::call || kind == Event::Kind::parameter) {
        last[instance] = all.size();
        all.push_back({&entry, {}});
      } else if (last[instance]) {
        all[*last[instance]].rest.push_back(&entry);
      }
    }
    std::ranges::stable_sort(all, {},
                             [](const RecordedMoment& moment) { return moment.head->event.time_ns; });
    return all;
  }

  void play() {
    const std::vector<RecordedMoment> all = moments();
    for (const RecordedMoment& moment : all) {
      clock_.set(Time(Duration(moment.head->event.time_ns)));
      RerunSubsystem& subsystem = *subsystems_[moment.head->event.instance()];
      subsystem.play(moment);
      if (assembly_.control.stopping() && !stopped_) stopped_ = subsystem.here();
    }
    for (const auto& subsystem : subsystems_) {
      report_.subsystems.push_back(subsystem->report());
      take_first(subsystem->first());
    }
    compare_stop();
    if (!recording_.entries.empty())
      report_.recorded = Duration(std::ranges::max_element(recording_.entries, {}, [](const Entry& entry) {
                                    return entry.event.time_ns;
                                  })->event.time_ns);
  }

  void take_first(const std::optional<Difference>& difference) {
    if (difference && (!report_.first || difference->at < report_.first->at)) report_.first = difference;
  }

  /// Compares whether user code asked for a stop now and in the recording.
  void compare_stop() {
    std::string recorded = "goes on";
    bool asserted = false;
    Difference end{"tessera", {}, 0, "the end", "", ""};
    for (const Entry& entry : recording_.entries) {
      const Event::Kind kind = entry.event.kind();
      if (kind == Event::Kind::fault && entry.event.version == static_cast<std::uint32_t>(Fault::assertion))
        asserted = true;
      const bool of_user_code = entry.event.version == 0 || asserted;
      if (kind != Event::Kind::stop || !entry.text.starts_with("stopped: ") || !of_user_code) continue;
      recorded = entry.text;
      end.at = Time(Duration(entry.event.time_ns));
    }
    const std::string computed =
        stopped_ ? fmt::format("stopped: {}", assembly_.control.reason()) : std::string("goes on");
    if (recorded == computed) return;
    Difference difference = stopped_ ? *stopped_ : end;
    difference.what = "the end";
    difference.recorded = recorded;
    difference.computed = computed;
    take_first(difference);
  }

  RunOptions options_;
  const Recording& recording_;
  Assembly assembly_;
  SimulatedClock clock_;
  std::vector<std::unique_ptr<RerunSubsystem>> subsystems_;
  std::optional<Difference> stopped_;  // when and where user code asked for a stop
  RerunReport report_;
};

}  // namespace

std::optional<RerunReport> rerun(const System& system, RunOptions options, const std::string& file,
                                 std::string& error) {
  const std::optional<Recording> recording = read_recording(file, error);
  if (!recording) return std::nullopt;
  std::optional<RerunReport> report = Play(system, std::move(options), *recording).report(error);
  if (report)
    report->recording = file;
  else
    error = fmt::format("cannot run again from '{}': {}", file, error);
  return report;
}

}  // namespace tessera
