#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tessera/recording.hpp"
#include "tessera/transition_role.hpp"

/// The way of readings through the subsystems of a recording.
namespace tessera::replay {

/// The steps of one subsystem that move readings, in their order.
struct Steps {
  struct Step {
    enum class Kind : std::uint8_t {
      started,      ///< the subsystem starts, perhaps again: its channels are as at first
      called,       ///< the transition function begins, and the devices are read
      finished,     ///< it has ended, and the devices have their commands
      withheld,     ///< it has ended, and the devices have no new commands
      transferred,  ///< a value is sent to a channel, or taken from it
      lost          ///< some steps are missing here
    } kind;
    std::int64_t time_ns = 0;
    std::uint32_t channel = 0, version = 0;  ///< transferred: of the recording, and of the channel
    std::uint32_t last_version = 0;          ///< transferred: that of the last firing of its block
    bool failed = false;                     ///< withheld: its outputs are those of the call before
  };
  std::vector<Step> all;
  bool is_whole = false;  ///< its first event is the first one of the run
  bool has_calls = false;
};

/// Reads the steps of one subsystem from its events.
class StepReader {
 public:
  /// header: of the recording, or of the segment. Entries of other subsystems must not come.
  void take(const Recording& header, const Recording::Entry& entry);
  [[nodiscard]] Steps finish() { return std::move(steps_); }

 private:
  void follow_sequence(const Event& event);
  void follow_device(const Event& event, const std::string& text);
  void fire(const TransitionRole& role, const Event& event);
  void follow_channel(Step step, std::uint32_t channel, const Event& event);

  Steps steps_;
  std::optional<std::uint32_t> next_;
  /// The channels of this iteration, with the step that moves their value.
  std::map<std::uint32_t, std::optional<std::size_t>> accessed_;
  std::set<std::string> safe_;  // devices with their safe command
  bool in_call_ = false, failed_ = false;
};

/// The time of a reading, or one of these.
using ReadingTime = std::int64_t;
inline constexpr ReadingTime no_reading = std::numeric_limits<std::int64_t>::min();  ///< it reflects none
inline constexpr ReadingTime unknown_reading = no_reading + 1;                       ///< events are missing
[[nodiscard]] constexpr bool is_known(ReadingTime reading) { return reading > unknown_reading; }

/// A value that was sent.
struct SentReading {
  std::uint32_t start = 0;  ///< the how manieth start of the sender
  std::uint32_t version = 0;
  ReadingTime reading = no_reading;
};
/// The values of one channel in their order.
struct SentReadings {
  std::vector<SentReading> all;
  bool is_whole = false;  ///< nothing was sent before the first one
};

/// A call of the last subsystem of a way.
struct ReadingCommand {
  std::uint32_t start = 0;
  std::int64_t time_ns = 0;
  ReadingTime reading = no_reading;
  bool withheld = false;
};

/// The values that the first subsystem of a way sends, and the moments of its readings, which are kept in `readings`
/// as commands at their own time.
[[nodiscard]] SentReadings readings_sent(const Steps& steps, std::uint32_t channel,
                                         std::vector<ReadingCommand>& readings);
/// The values that a subsystem on the way sends.
[[nodiscard]] SentReadings readings_sent_on(const Steps& steps, std::uint32_t from,
                                            const SentReadings& arriving, std::uint32_t to);
/// The commands of the last subsystem. Lost ones are told as one of an unknown reading.
[[nodiscard]] std::vector<ReadingCommand> commands_of(const Steps& steps, std::uint32_t from,
                                                      const SentReadings& arriving);

}  // namespace tessera::replay
