#include "replay/times/reading_trace.hpp"

#include <map>
#include <optional>

#include "replay/source.hpp"
#include "tessera/transition_role.hpp"

namespace tessera::replay {
namespace {

using Moved = Steps::Step::Kind;

/// Reads the steps of one subsystem from its events.
class StepReader {
 public:
  void take(const Recording& recording, const Recording::Entry& entry) {
    const Event& event = entry.event;
    if (is_counted(event)) follow_sequence(event);
    if (event.kind() == Event::Kind::call) {
      steps_.has_calls = true;
      in_call_ = true;
      failed_ = false;
      steps_.all.push_back({Moved::called, event.time_ns});
    } else if (event.kind() == Event::Kind::fault) {
      failed_ = failed_ || (in_call_ && !event.is_told_fault());
    } else if (event.kind() == Event::Kind::safe) {
      follow_device(event, entry.text);
    } else if (event.kind() == Event::Kind::firing) {
      fire(recording.transitions[event.subject].role, event);
    }
  }
  [[nodiscard]] Steps finish() { return std::move(steps_); }

 private:
  void follow_sequence(const Event& event) {
    if (!next_)
      steps_.is_whole = event.sequence == 0;
    else if (event.sequence != *next_) {
      steps_.all.push_back({Moved::lost, event.time_ns});
      accessed_.clear();
      in_call_ = false;
    }
    next_ = event.sequence + 1;
  }

  /// "DEVICE: what happened".
  void follow_device(const Event& event, const std::string& text) {
    const std::string device = text.substr(0, text.find(": "));
    if (event.version == static_cast<std::uint32_t>(SafeEvent::ended))
      safe_.erase(device);
    else
      safe_.insert(device);
  }

  void fire(const TransitionRole& role, const Event& event) {
    if (role.step == Step::start) {
      steps_.all.push_back({Moved::started, event.time_ns});
      accessed_.clear();
    } else if (role.step == Step::begin_sending) {
      const bool withheld = failed_ || !safe_.empty();
      steps_.all.push_back({withheld ? Moved::withheld : Moved::finished, event.time_ns, 0, 0, 0, failed_});
      in_call_ = failed_ = false;
    } else if (role.ends_iteration()) {
      accessed_.clear();
    } else if (role.communicates() && role.channel) {
      follow_channel(role.step, *role.channel, event);
    }
  }

  /// The first firing of an end in an iteration decides: a block that begins otherwise moves no value.
  void follow_channel(Step step, std::uint32_t channel, const Event& event) {
    const auto [moved, is_first] = accessed_.try_emplace(channel, std::nullopt);
    if (moved->second) steps_.all[*moved->second].last_version = event.version;
    if (!is_first || (step != Step::transfer && step != Step::overwrite)) return;
    moved->second = steps_.all.size();
    steps_.all.push_back({Moved::transferred, event.time_ns, channel, event.version, event.version});
  }

  Steps steps_;
  std::optional<std::uint32_t> next_;
  /// The channels of this iteration, with the step that moves their value.
  std::map<std::uint32_t, std::optional<std::size_t>> accessed_;
  std::set<std::string> safe_;  // devices with their safe command
  bool in_call_ = false, failed_ = false;
};

/// The reading that a receive finds. Receives must come in their order.
class Arrivals {
 public:
  explicit Arrivals(const SentReadings& sent) : sent_(sent) {}
  [[nodiscard]] ReadingTime newest(std::uint32_t start, std::uint32_t version) {
    const auto is_before_this = [&](const SentReading& one) {
      return one.start < start || (one.start == start && is_before(one.version, version));
    };
    while (next_ < sent_.all.size() && is_before_this(sent_.all[next_])) ++next_;
    if (next_ > 0 && sent_.all[next_ - 1].start == start) return sent_.all[next_ - 1].reading;
    return sent_.is_whole || start > 0 ? no_reading : unknown_reading;
  }

 private:
  const SentReadings& sent_;
  std::size_t next_ = 0;
};

/// Follows the reading that the outputs of one subsystem reflect.
class Follower {
 public:
  /// arriving: nullptr: its devices are read at each call.
  Follower(const Steps& steps, std::optional<std::uint32_t> from, const SentReadings* arriving)
      : steps_(steps), from_(from), reading_(steps.is_whole ? no_reading : unknown_reading), held_(reading_) {
    if (arriving != nullptr) arrivals_.emplace(*arriving);
  }

  /// `after(step, reading, start)` is told of each step, after it.
  template <class After>
  void follow(After&& after) {
    bool begun = false;
    for (const Steps::Step& step : steps_.all) {
      switch (step.kind) {
        case Moved::started:
          // A recording may begin with the first start.
          start_ += begun ? 1U : 0U;
          reading_ = held_ = no_reading;
          break;
        case Moved::lost:
          reading_ = held_ = unknown_reading;
          called_.reset();
          break;
        case Moved::called:
          called_ = step.time_ns;
          break;
        case Moved::transferred:
          if (arrivals_ && step.channel == *from_) held_ = arrivals_->newest(start_, step.version);
          break;
        case Moved::finished:
        case Moved::withheld:
          if (!step.failed) reading_ = arrivals_ ? held_ : called_.value_or(unknown_reading);
          break;
      }
      begun = true;
      after(step, reading_, start_);
    }
  }

 private:
  const Steps& steps_;
  std::optional<std::uint32_t> from_;
  std::optional<Arrivals> arrivals_;
  ReadingTime reading_, held_;
  std::optional<std::int64_t> called_;
  std::uint32_t start_ = 0;
};

/// Collects what is sent into a channel.
class Sending {
 public:
  Sending(const Steps& steps, std::uint32_t channel) : channel_(channel) { sent_.is_whole = steps.is_whole; }
  void take(const Steps::Step& step, ReadingTime reading, std::uint32_t start) {
    // A lost value may be newer than all that is known of the last one, and older than the next.
    if (step.kind == Moved::lost && !sent_.all.empty())
      sent_.all.push_back({start, last_version_ + 1, unknown_reading});
    if (step.kind == Moved::lost && sent_.all.empty()) sent_.is_whole = false;
    if (step.kind != Moved::transferred || step.channel != channel_) return;
    sent_.all.push_back({start, step.version, reading});
    last_version_ = step.last_version;
  }
  [[nodiscard]] SentReadings finish() { return std::move(sent_); }

 private:
  std::uint32_t channel_, last_version_ = 0;
  SentReadings sent_;
};

}  // namespace

std::unordered_map<std::uint32_t, Steps> steps_in(const Recording& recording,
                                                  const std::set<std::uint32_t>& instances) {
  std::unordered_map<std::uint32_t, StepReader> readers;
  for (const std::uint32_t instance : instances) readers[instance];
  for (const Recording::Entry& entry : recording.entries)
    if (const auto reader = readers.find(entry.event.instance()); reader != readers.end())
      reader->second.take(recording, entry);
  std::unordered_map<std::uint32_t, Steps> result;
  for (auto& [instance, reader] : readers) result.emplace(instance, reader.finish());
  return result;
}

SentReadings readings_sent(const Steps& steps, std::uint32_t channel, std::vector<ReadingCommand>& readings) {
  Sending sending(steps, channel);
  Follower(steps, {}, nullptr).follow([&](const Steps::Step& step, ReadingTime reading, std::uint32_t start) {
    const bool is_read = (step.kind == Moved::finished || step.kind == Moved::withheld) && !step.failed;
    if (is_read && is_known(reading)) readings.push_back({start, reading, reading});
    sending.take(step, reading, start);
  });
  return sending.finish();
}

SentReadings readings_sent_on(const Steps& steps, std::uint32_t from, const SentReadings& arriving,
                              std::uint32_t to) {
  Sending sending(steps, to);
  Follower(steps, from, &arriving)
      .follow([&](const Steps::Step& step, ReadingTime reading, std::uint32_t start) {
        sending.take(step, reading, start);
      });
  return sending.finish();
}

std::vector<ReadingCommand> commands_of(const Steps& steps, std::uint32_t from,
                                        const SentReadings& arriving) {
  std::vector<ReadingCommand> commands;
  Follower(steps, from, &arriving)
      .follow([&](const Steps::Step& step, ReadingTime reading, std::uint32_t start) {
        if (step.kind == Moved::finished || step.kind == Moved::withheld)
          commands.push_back({start, step.time_ns, reading, step.kind == Moved::withheld});
        if (step.kind == Moved::lost) commands.push_back({start, step.time_ns, unknown_reading});
      });
  return commands;
}

}  // namespace tessera::replay
