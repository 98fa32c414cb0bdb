#include "redrive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "assembly.hpp"
#include "tessera/value_text.hpp"

namespace tessera {
namespace {

using Entry = Recording::Entry;

[[nodiscard]] std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

/// What the recording says of a buffer up to now.
struct Held {
  std::string bytes;  // of a hashed value: number and hash
  bool hashed = false, silent = false, failed = false;

  void take(const ValueEvent& value) {
    silent = value.has(ValueFlags::silent);
    failed = value.has(ValueFlags::failed);
    if (silent || failed || value.has(ValueFlags::same)) return;
    bytes = value.bytes;
    hashed = value.has(ValueFlags::hashed);
  }
};

/// Gives what is recorded of a real input.
class RecordedReceptor final : public RealReceptor {
 public:
  RecordedReceptor(const Held& held, const ValueEncoding& encoding) : held_(held), encoding_(encoding) {}
  bool read(std::span<std::byte> value) override {
    if (held_.failed) throw std::runtime_error("it threw in the recorded run");
    if (held_.silent) return false;
    return encoding_.take(value.data(), as_bytes(held_.bytes));
  }

 private:
  const Held& held_;
  const ValueEncoding& encoding_;
};

/// Takes every command: that one was refused is recorded.
class DeafEffector final : public RealEffector {
  bool write(std::span<const std::byte>) override { return true; }
};

/// A firing or a call, and what is recorded of its subsystem until the next one.
struct Moment {
  const Entry* head;
  std::vector<const Entry*> rest;
};

/// One subsystem.
class Lane {
 public:
  Lane(LoosePart& part, std::uint32_t first_buffer, const Recording& recording, RunControl& control,
       const Clock& clock)
      : recording_(recording),
        plan_(std::move(part.plan)),
        first_transition_(part.first_transition),
        first_buffer_(first_buffer),
        held_(count_buffers(part.parts.bindings)),
        operations_(with_devices(std::move(part.parts)), control, clock, nullptr),
        reads_(held_.size()) {
    report_.path = parts().path;
    std::uint32_t number = first_buffer;
    for_buffers(parts().bindings, [&](Recording::Direction direction, const auto& buffer) {
      const bool out =
          direction == Recording::Direction::output || direction == Recording::Direction::real_output;
      if (out && buffer.encoding != nullptr) {
        const std::size_t kept = std::min<std::uint64_t>(buffer.encoding->most, recording.value_limit);
        outputs_.push_back({number, buffer.value, buffer.encoding, ValueSink(kept),
                            ValueLayout::parse(recording.buffers[number].type)});
        report_.outputs.push_back({recording.buffers[number].path, 0});
      }
      ++number;
    });
  }

  void play(const Moment& moment) {
    at_ = Time(Duration(moment.head->event.time_ns));
    if (moment.head->event.kind() == Event::Kind::call)
      call(moment);
    else
      fire(moment);
  }

  /// The transition function is over, that is, the token has moved on.
  [[nodiscard]] const RedriveReport::PerSubsystem& report() const { return report_; }
  [[nodiscard]] const std::optional<Difference>& first() const { return first_; }
  /// Where the last moment was.
  [[nodiscard]] Difference here() const { return {report_.path, at_, iteration_, "", "", ""}; }

 private:
  struct Output {
    std::uint32_t number;
    const void* value;
    const ValueEncoding* encoding;
    ValueSink computed;
    std::optional<ValueLayout> layout;
  };

  [[nodiscard]] const SubsystemParts& parts() const { return operations_.parts(); }

  SubsystemParts with_devices(SubsystemParts parts) {
    const Bindings& bindings = parts.bindings;
    const std::size_t before = bindings.inputs.size() + bindings.outputs.size();
    for (std::size_t index = 0; index < bindings.real_inputs.size(); ++index)
      parts.receptors.push_back(
          std::make_unique<RecordedReceptor>(held_[before + index], *bindings.real_inputs[index].encoding));
    for (std::size_t index = 0; index < bindings.real_outputs.size(); ++index)
      parts.effectors.push_back(std::make_unique<DeafEffector>());
    return parts;
  }

  // ---------------------------------------------------------------------------------------- transition
  // function

  void call(const Moment& moment) {
    iteration_ = moment.head->event.version;
    const auto behaviour = static_cast<std::uint16_t>(moment.head->event.subject);
    take_values(moment,
                [](Recording::Direction direction) { return direction == Recording::Direction::real_input; });
    operations_.start_call(behaviour, at_);
    unfinished_ = &moment;
  }

  /// Only now is it known that the recorded one had ended, too.
  void finish_call() {
    const Moment* const moment = std::exchange(unfinished_, nullptr);
    if (moment == nullptr) return;
    const Time fired_at = std::exchange(at_, Time(Duration(moment->head->event.time_ns)));
    operations_.finish_call(at_);
    const Entry* const fault = recorded_failure(*moment);
    const std::string_view behaviour = parts().instance->net->behaviours[moment->head->event.subject].name;
    if (fault != nullptr && !operations_.has_failed() && comes_from_outside(*fault))
      operations_.fail_as_recorded(static_cast<Fault>(fault->event.version), "as in the recorded run");
    if (operations_.has_failed() != (fault != nullptr))
      differ(fmt::format("the transition function of {}", behaviour),
             fault == nullptr ? "succeeded" : fault->text, fault == nullptr ? "failed" : "succeeded");
    take_values(*moment, [](Recording::Direction direction) {
      return direction == Recording::Direction::output || direction == Recording::Direction::real_output;
    });
    compare_outputs();
    ++report_.iterations;
    at_ = fired_at;
  }

  /// What made the recorded iteration fail; nullptr: it did not.
  [[nodiscard]] static const Entry* recorded_failure(const Moment& moment) {
    for (const Entry* entry : moment.rest) {
      if (entry->event.kind() != Event::Kind::fault) continue;
      const auto fault = static_cast<Fault>(entry->event.version);
      if (fault == Fault::exception || fault == Fault::not_finite || fault == Fault::device ||
          fault == Fault::stall)
        return entry;
    }
    return nullptr;
  }

  /// No user code makes it happen again.
  [[nodiscard]] static bool comes_from_outside(const Entry& fault) {
    const auto kind = static_cast<Fault>(fault.event.version);
    return kind == Fault::device || kind == Fault::stall;
  }

  template <class Wanted>
  void take_values(const Moment& moment, Wanted wanted) {
    for (const Entry* entry : moment.rest) {
      if (entry->event.kind() != Event::Kind::value) continue;
      const ValueEvent value = value_of(*entry);
      if (wanted(recording_.buffers[value.buffer].direction)) held_[value.buffer - first_buffer_].take(value);
    }
  }

  void compare_outputs() {
    for (std::size_t index = 0; index < outputs_.size(); ++index) {
      Output& output = outputs_[index];
      output.computed.clear();
      output.encoding->put(output.value, output.computed);
      const Held& held = held_[output.number - first_buffer_];
      const std::string computed = bytes_of(output.computed);
      if (computed == held.bytes) continue;
      ++report_.outputs[index].differing;
      if (!first_) name_difference(output, held, computed);
    }
  }

  [[nodiscard]] static std::string bytes_of(const ValueSink& value) {
    if (value.whole())
      return std::string(reinterpret_cast<const char*>(value.bytes().data()), value.bytes().size());
    const std::array numbers{value.size(), value.hash()};
    return std::string(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
  }

  /// The first field that is another.
  void name_difference(const Output& output, const Held& held, const std::string& computed) {
    const std::string name = recording_.buffers[output.number].path.substr(report_.path.size() + 1);
    if (held.hashed || !output.layout) return differ(name, "a large value", "another");
    std::vector<std::pair<std::string, std::string>> recorded;
    static_cast<void>(output.layout->visit(held.bytes, [&](const std::string& path, const auto& scalar) {
      recorded.emplace_back(path, scalar.shown());
    }));
    std::size_t index = 0;
    bool named = false;
    static_cast<void>(output.layout->visit(computed, [&](const std::string& path, const auto& scalar) {
      const std::size_t at = index++;
      if (named || at >= recorded.size() || recorded[at].second == scalar.shown()) return;
      named = true;
      differ(path.empty() ? name : name + (path.starts_with('[') ? "" : ".") + path, recorded[at].second,
             scalar.shown());
    }));
    if (!named) differ(name, output.layout->shown(held.bytes), output.layout->shown(computed));
  }

  // ---------------------------------------------------------------------------------------- firings

  void fire(const Moment& moment) {
    finish_call();
    const Plan::TransitionEntry& transition =
        plan_->transitions[moment.head->event.subject - first_transition_];
    if (transition.latch != Plan::none) compare_decision(transition);
    if (transition.tells_of_timeout) {
      if (transition.guard.kind == Guard::Kind::elapsed)
        operations_.note_timeout(transition.port);
      else
        operations_.note_answer(transition.port);
    }
    for (const std::uint32_t place : plan_->outputs(transition)) start_operation(place, moment);
  }

  void start_operation(std::uint32_t place, const Moment& moment) {
    const Plan::PlaceEntry& entry = plan_->places[place];
    switch (entry.does) {
      case Does::Kind::nothing:
      case Does::Kind::call:  // recorded for itself
        break;
      case Does::Kind::count:
        operations_.count();
        break;
      case Does::Kind::write:
        operations_.write(entry.subject, entry.slot, at_);
        break;
      case Does::Kind::read:
        read(entry.subject, entry.slot, moment);
        break;
      case Does::Kind::decide:
        decided_[place] = static_cast<int>(operations_.decide(entry.subject, at_));
        break;
      case Does::Kind::route:
        decided_[place] = operations_.route(entry.subject, at_);
        break;
    }
  }

  /// The channel gets what is recorded. Of newer values the number grows; older ones have the numbers 1 and 2
  /// in turns, for a value with the number of the last is none that is read.
  void read(std::uint16_t port, std::uint16_t slot, const Moment& moment) {
    const PortLink& link = parts().ports[port];
    Time now = at_;
    for (const Entry* entry : moment.rest) {
      if (entry->event.kind() != Event::Kind::value) continue;
      const ValueEvent value = value_of(*entry);
      if (value.buffer != first_buffer_ + link.buffer) continue;
      Held& held = held_[link.buffer];
      held.take(value);
      SharedChannel::Memory& memory = link.channel->memory(slot);
      static_cast<void>(
          parts().bindings.inputs[link.buffer].encoding->take(memory.bytes.data(), as_bytes(held.bytes)));
      memory.stamp = Time(Duration(value.stamp_ns));
      memory.valid = value.has(ValueFlags::valid);
      Reads& reads = reads_[link.buffer];
      memory.sequence = value.has(ValueFlags::fresh) ? ++reads.newest : reads.older = 3 - reads.older;
      reads.last = memory.sequence;
      now = Time(Duration(entry->event.time_ns));
      return operations_.read(port, slot, now);
    }
    link.channel->memory(slot).sequence = reads_[link.buffer].last;  // nothing new
    operations_.read(port, slot, now);
  }

  void compare_decision(const Plan::TransitionEntry& transition) {
    const auto found = decided_.find(transition.latch);
    if (found == decided_.end()) return;
    const int computed = found->second;
    decided_.erase(found);
    if (computed == transition.decided) return;
    ++report_.decisions;
    if (plan_->places[transition.latch].does == Does::Kind::decide)
      operations_.accept_outcome(static_cast<Outcome>(transition.decided));
    const SubsystemNet& net = *parts().instance->net;
    std::string other = "none that the net has";
    for (const std::uint32_t index : plan_->leaving_of(transition.latch))
      if (plan_->transitions[index].latch == transition.latch &&
          plan_->transitions[index].decided == computed)
        other = net.transitions[index].name;
    differ("the transition taken", std::string(net.transitions[transition.index].name), other);
  }

  void differ(std::string what, std::string recorded, std::string computed) {
    if (first_) return;
    first_ = here();
    first_->what = std::move(what);
    first_->recorded = std::move(recorded);
    first_->computed = std::move(computed);
  }

  struct Reads {
    std::uint64_t newest = 2, older = 1, last = 0;  // numbers of values
  };

  const Recording& recording_;
  std::shared_ptr<const Plan> plan_;
  std::uint32_t first_transition_, first_buffer_;
  std::vector<Held> held_;  // per buffer
  Operations operations_;
  std::vector<Reads> reads_;  // per buffer; of inputs
  std::vector<Output> outputs_;
  std::map<std::uint32_t, int> decided_;  // per place with a token that has been decided on
  const Moment* unfinished_ = nullptr;    // the call that runs
  Time at_{};
  std::uint64_t iteration_ = 0;
  RedriveReport::PerSubsystem report_;
  std::optional<Difference> first_;
};

/// All of it.
class Play {
 public:
  Play(const System& system, RunOptions options, const Recording& recording)
      : options_(with_recorded(std::move(options), recording)),
        recording_(recording),
        assembly_(system, options_) {}

  [[nodiscard]] std::optional<RedriveReport> report(std::string& error) {
    error = complaint();
    LooseParts parts;
    if (!error.empty() || !take_apart(assembly_, clock_, parts, error)) return std::nullopt;
    error = complaint_of_buffers(parts);
    if (error.empty()) error = complaint_of_events(parts);
    if (!error.empty()) return std::nullopt;
    std::uint32_t first_buffer = 0;
    for (LoosePart& part : parts.parts) {
      const std::uint32_t count = count_buffers(part.parts.bindings);
      lanes_.push_back(std::make_unique<Lane>(part, first_buffer, recording_, assembly_.control, clock_));
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

  /// Why it cannot be run again from this recording; empty: it can.
  [[nodiscard]] std::string complaint() const {
    const System& system = assembly_.system;
    if (recording_.net_hash != system.net_hash)
      return fmt::format(
          "it is a recording of another net ({}, this controller's is {}): its specification has "
          "changed since",
          recording_.net_hash, system.net_hash);
    if (recording_.buffers.empty())
      return "it holds no values of buffers: record the run with --record-values small or all";
    if (recording_.segment.value_or(0) > 0)
      return "its beginning is gone (--record-limit), and with it what the code remembered from then";
    std::vector<std::uint32_t> next(recording_.instances.size());
    for (const Entry& entry : recording_.entries) {
      if (entry.event.instance() >= next.size()) continue;
      std::uint32_t& due = next[entry.event.instance()];
      const std::string& path = recording_.instances[entry.event.instance()];
      if (entry.event.sequence != due++)
        return fmt::format("events of {} are missing at {:.6f} s", path,
                           seconds(Duration(entry.event.time_ns)));
      if (entry.event.kind() != Event::Kind::value) continue;
      const ValueEvent value = value_of(entry);
      const Recording::Buffer& buffer = recording_.buffers[value.buffer];
      const bool in = buffer.direction == Recording::Direction::input ||
                      buffer.direction == Recording::Direction::real_input;
      if (in && value.has(ValueFlags::hashed))
        return fmt::format("the values of {} are too large and not in it: record with --record-values all",
                           buffer.path);
    }
    return "";
  }

  /// The controller's buffers must be those of the recording.
  [[nodiscard]] std::string complaint_of_buffers(const LooseParts& parts) const {
    std::size_t number = 0;
    std::string wrong;
    for (const LoosePart& part : parts.parts)
      for_buffers(part.parts.bindings, [&](Recording::Direction direction, const auto& buffer) {
        const std::string path = fmt::format("{}.{}", part.parts.path, buffer.name);
        const std::string type = buffer.encoding == nullptr ? "" : buffer.encoding->type();
        const std::size_t index = number++;
        if (!wrong.empty()) return;
        if (index >= recording_.buffers.size() || recording_.buffers[index].path != path ||
            recording_.buffers[index].direction != direction)
          wrong = fmt::format("it knows no buffer {}", path);
        else if (recording_.buffers[index].type != type)
          wrong = fmt::format("in it {} is {}, and in this controller {}", path,
                              recording_.buffers[index].type, type);
        else if (type.empty())
          wrong = fmt::format("values of {} cannot be recorded: its type has no fixed extent", path);
      });
    if (wrong.empty() && number != recording_.buffers.size())
      wrong = fmt::format("this controller has no buffer {}", recording_.buffers[number].path);
    return wrong;
  }

  /// The header is that of a recording of this net, but a damaged file may say anything.
  [[nodiscard]] std::string complaint_of_events(const LooseParts& parts) const {
    if (recording_.instances.size() != parts.parts.size()) return "it is damaged";
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
      if (!fits) return "it is damaged";
    }
    return "";
  }

  [[nodiscard]] std::vector<Moment> moments() const {
    std::vector<Moment> all;
    std::vector<std::size_t> last(recording_.instances.size(), SIZE_MAX);
    for (const Entry& entry : recording_.entries) {
      const std::uint32_t instance = entry.event.instance();
      if (instance >= last.size()) continue;
      const Event::Kind kind = entry.event.kind();
      if (kind == Event::Kind::firing || kind == Event::Kind::call) {
        last[instance] = all.size();
        all.push_back({&entry, {}});
      } else if (last[instance] != SIZE_MAX) {
        all[last[instance]].rest.push_back(&entry);
      }
    }
    std::ranges::stable_sort(all, {}, [](const Moment& moment) { return moment.head->event.time_ns; });
    return all;
  }

  void play() {
    const std::vector<Moment> all = moments();
    for (const Moment& moment : all) {
      clock_.set(Time(Duration(moment.head->event.time_ns)));
      Lane& lane = *lanes_[moment.head->event.instance()];
      lane.play(moment);
      if (assembly_.control.stopping() && !stopped_) stopped_ = lane.here();
    }
    for (const auto& lane : lanes_) {
      report_.subsystems.push_back(lane->report());
      take_first(lane->first());
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

  /// A stop that user code asked for then but not now, or the other way round.
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
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::optional<Difference> stopped_;  // when and where user code asked for it
  RedriveReport report_;
};

}  // namespace

std::optional<RedriveReport> redrive(const System& system, RunOptions options, const std::string& file,
                                     std::string& error) {
  const std::optional<Recording> recording = read_recording(file, error);
  if (!recording) return std::nullopt;
  std::optional<RedriveReport> report = Play(system, std::move(options), *recording).report(error);
  if (report) report->recording = file;
  if (!error.empty()) error = fmt::format("cannot run again from '{}': {}", file, error);
  return report;
}

std::string redrive_text(const RedriveReport& report) {
  std::string text;
  for (const RedriveReport::PerSubsystem& one : report.subsystems) {
    std::string differing;
    for (const RedriveReport::PerBuffer& output : one.outputs)
      if (output.differing > 0)
        differing +=
            fmt::format(", {} differs after {}", output.path.substr(one.path.size() + 1), output.differing);
    if (one.decisions > 0) differing += fmt::format(", {} decisions differ", one.decisions);
    text += fmt::format("  {}: {} iterations{}\n", one.path, one.iterations,
                        differing.empty() ? ", as recorded" : differing);
  }
  const std::string head =
      fmt::format("{:.3f} s of '{}' run again: ", seconds(report.recorded), report.recording);
  if (!report.first) return head + "the same\n" + text;
  const Difference& first = *report.first;
  return head + "not the same\n" + text +
         fmt::format("first at {:.6f} s: {}, iteration {}: {}: recorded {}, computed {}\n",
                     seconds(first.at.time_since_epoch()), first.subsystem, first.iteration, first.what,
                     first.recorded, first.computed);
}

std::string redrive_json(const RedriveReport& report) {
  nlohmann::ordered_json subsystems = nlohmann::ordered_json::array();
  for (const RedriveReport::PerSubsystem& one : report.subsystems) {
    nlohmann::ordered_json outputs = nlohmann::ordered_json::object();
    for (const RedriveReport::PerBuffer& output : one.outputs) outputs[output.path] = output.differing;
    subsystems.push_back({{"path", one.path},
                          {"iterations", one.iterations},
                          {"differing_decisions", one.decisions},
                          {"differing_outputs", std::move(outputs)}});
  }
  nlohmann::ordered_json json{{"recording", report.recording},
                              {"recorded_s", seconds(report.recorded)},
                              {"same", !report.first.has_value()},
                              {"first", nullptr},
                              {"subsystems", std::move(subsystems)}};
  if (report.first)
    json["first"] = {
        {"subsystem", report.first->subsystem}, {"at_s", seconds(report.first->at.time_since_epoch())},
        {"iteration", report.first->iteration}, {"what", report.first->what},
        {"recorded", report.first->recorded},   {"computed", report.first->computed}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace tessera
