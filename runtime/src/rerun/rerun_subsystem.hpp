#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "assembly/assembly.hpp"
#include "rerun/rerun.hpp"
#include "subsystem/operations.hpp"
#include "tessera/value_text.hpp"

namespace tessera {

/// A firing or a call, and everything that is recorded about its subsystem until the next one.
struct RecordedMoment {
  const Recording::Entry* head;
  std::vector<const Recording::Entry*> rest;
};

/// The user's code of one subsystem, run again on recorded data (rerun).
///
/// Threads: one.
class RerunSubsystem {
 public:
  /// first_buffer: number of the subsystem's first buffer in the recording. part: is moved from; it was
  /// checked against the recording. recording, control and clock must outlive this object.
  RerunSubsystem(LoosePart& part, std::uint32_t first_buffer, const Recording& recording, RunControl& control,
                 const Clock& clock);

  /// Plays the next moment of this subsystem.
  void play(const RecordedMoment& moment);
  [[nodiscard]] const RerunReport::PerSubsystem& report() const { return report_; }
  [[nodiscard]] const std::optional<Difference>& first() const { return first_; }
  /// The position of the last moment.
  [[nodiscard]] Difference here() const { return {report_.path, at_, iteration_, "", "", ""}; }

 private:
  /// The value of a buffer at this point of the recording.
  struct Held {
    std::string bytes;  // of a hashed value: number and hash
    bool hashed = false, silent = false, failed = false;
    void take(const ValueEvent& value);
  };
  class RecordedReceptor;
  struct Output {
    std::uint32_t number;
    const void* value;
    const ValueEncoding* encoding;
    ValueSink computed;
    std::optional<ValueLayout> layout;
  };
  struct Reads {
    std::uint64_t newest = 2, older = 1, last = 0;  // numbers of values
  };

  [[nodiscard]] const SubsystemParts& parts() const { return operations_.parts(); }
  [[nodiscard]] SubsystemParts with_devices(SubsystemParts parts) const;
  void set_parameter(const std::string& change);
  void call(const RecordedMoment& moment);
  void finish_call();
  template <class Wanted>
  void take_values(const RecordedMoment& moment, Wanted wanted);
  void compare_outputs();
  void name_difference(const Output& output, const Held& held, std::string_view computed);
  void fire(const RecordedMoment& moment);
  void start_operation(std::uint32_t place, const RecordedMoment& moment);
  void read(std::uint16_t port, std::uint16_t slot, const RecordedMoment& moment);
  void compare_decision(const Plan::TransitionEntry& transition);
  void differ(std::string what, std::string recorded, std::string computed);

  const Recording& recording_;
  std::shared_ptr<const Plan> plan_;
  std::uint32_t first_transition_, first_buffer_;
  std::vector<Held> held_;  // per buffer
  Operations operations_;
  std::vector<Reads> reads_;  // per buffer; of inputs
  std::vector<Output> outputs_;
  std::map<std::uint32_t, int> decided_;        // per place with a token on which a condition was decided
  const RecordedMoment* unfinished_ = nullptr;  // the call that runs
  Time at_{};
  std::uint64_t iteration_ = 0;
  RerunReport::PerSubsystem report_;
  std::optional<Difference> first_;
};

}  // namespace tessera
