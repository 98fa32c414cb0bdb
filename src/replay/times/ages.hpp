#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "replay/times/reading_trace.hpp"
#include "tessera/recording.hpp"

/// How old the readings are that commands act on, as a recording tells.
namespace tessera::replay {

/// A way of values from one device to another.
struct MeasuredChain {
  std::string name;   ///< "robot[3].camera -> robot[3].control -> robot[3].motor"
  std::string group;  ///< chains of one group are measured together: "robot[].camera -> ..."
  std::vector<std::string> subsystems;  ///< at least two
  /// Names of channels, each from a subsystem to the next one. Two subsystems may have several.
  std::vector<std::vector<std::string>> ways;
};

/// Times in nanoseconds. Quantiles are by nearest rank.
struct MeasuredTimes {
  std::uint64_t count = 0;
  std::int64_t least = 0, median = 0, p95 = 0, p99 = 0, most = 0;
  /// Numbers of times in equal steps from least to most; empty if all are equal.
  std::vector<std::uint64_t> histogram;
  /// The greatest one: of which chain, in which recording (counted from 0), from the reading to the end of the
  /// command.
  std::string worst_chain;
  std::size_t worst_recording = 0;
  std::int64_t worst_from_ns = 0, worst_to_ns = 0;
};

struct ChainAges {
  std::string group;
  std::uint64_t chains = 0;
  /// From the moment at which the device was read to the end of any command that is based on it: one per command.
  MeasuredTimes age;
  /// From the worst moment for an event, just after a reading, to the end of the first command that reflects it: one
  /// per reading.
  MeasuredTimes reaction;
  /// Commands that were not given: the call had failed, or the device had its safe command.
  std::uint64_t withheld = 0;
  std::string why;  ///< nothing could be measured, because of this; empty: nothing stands against it
};

/// Measures chains in any number of recordings: of several runs, or of the processes of one.
///
/// A receive takes the newest value that was sent before it, in the order of the versions of its channel. Its reading
/// is that of the call that sent it. Values that a subsystem keeps in its memory do not count. If events are missing,
/// times that depend on them are left out.
class Ages {
 public:
  explicit Ages(std::vector<MeasuredChain> chains);
  /// Linear in the recording. A chain of which the recording has no subsystem is not measured in it.
  void add(const Recording& recording);
  /// The same for a recording that is read piece by piece: its header, all its entries, and its end.
  void begin(const Recording& header);
  void take(const Recording& header, const Recording::Entry& entry);
  void end();
  /// By group, in order of first appearance.
  [[nodiscard]] std::vector<ChainAges> finish() const;

 private:
  struct Sample {
    std::int64_t from_ns = 0, to_ns = 0;
    std::uint32_t chain = 0, recording = 0;
  };
  struct Group {
    std::string name;
    std::uint64_t chains = 0, withheld = 0;
    std::vector<Sample> ages, reactions;
    std::string why;
  };
  [[nodiscard]] MeasuredTimes times_of(const std::vector<Sample>& samples) const;

  std::vector<MeasuredChain> chains_;
  std::vector<std::size_t> group_of_;  // per chain
  std::vector<Group> groups_;
  std::uint32_t recordings_ = 0;

  /// The recording that is being read.
  struct Reading {
    std::unordered_map<std::string, std::uint32_t> instances, channels;
    std::set<std::string> networked;
    std::unordered_map<std::uint32_t, StepReader> readers;
  } reading_;
};

}  // namespace tessera::replay
