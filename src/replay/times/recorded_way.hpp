#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "replay/times/ages.hpp"
#include "replay/times/call_durations.hpp"
#include "replay/times/reading_trace.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

/// How one command came about: the calls of the subsystems of a chain meanwhile, and the way of its value.
struct RecordedWay {
  struct Call {
    std::string subsystem, behaviour;
    std::int64_t begin_ns = 0, end_ns = 0;
  };
  struct Hop {
    std::string channel, from, to;  ///< between two subsystems
    std::int64_t written_ns = 0, read_ns = 0;
  };
  std::vector<Call> calls;  ///< in their order
  std::vector<Hop> hops;    ///< from the receptor on; empty: events are missing
};

/// The time of a chain to explain: one that `Ages` has measured.
struct ExplainedTime {
  enum class Of : std::uint8_t { age, reaction } of = Of::age;
  std::int64_t from_ns = 0, to_ns = 0;
};

/// Finds the way of one command in a recording, which comes entry by entry.
class RecordedWayReader {
 public:
  RecordedWayReader(const Recording& header, MeasuredChain chain, const ExplainedTime& time);
  void take(const Recording& header, const Recording::Entry& entry);
  [[nodiscard]] RecordedWay finish();

 private:
  /// Along one of the ways over the channels; empty: the command has not come along it.
  [[nodiscard]] std::vector<RecordedWay::Hop> hops_along(
      const std::vector<std::uint32_t>& channels, const std::vector<std::string>& names,
      const std::unordered_map<std::uint32_t, Steps>& steps) const;

  MeasuredChain chain_;
  ExplainedTime time_;
  std::unordered_map<std::string, std::uint32_t> channels_;
  std::vector<std::uint32_t> lanes_;  // instances of the subsystems
  std::unordered_map<std::uint32_t, StepReader> readers_;
  CallReader calls_;
  RecordedWay way_;
};

}  // namespace tessera::replay
