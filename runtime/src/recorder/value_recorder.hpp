#pragma once

#include <cstdint>
#include <vector>

#include "recorder/recorder.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/value_encoding.hpp"

namespace tessera {

/// Writes the values of one subsystem's buffers into its lane when they change and when its transition
/// functions begin. `tessera rerun` needs them to run the user's code again.
///
/// *Order of buffers.* The buffers of a subsystem are numbered in this order: inputs, outputs,
/// real inputs, real outputs. The fields of memory of all subsystems follow the buffers of all.
///
/// Threads: the subsystem's. Only the constructor allocates.
class ValueRecorder {
 public:
  /// limit: larger values are recorded by size and hash only. first_memory: the number of its first field of
  /// memory.
  ValueRecorder(const Bindings& bindings, std::uint32_t first_buffer, std::uint32_t first_memory,
                std::uint64_t limit, RecordingLane& lane);

  void call(Time now, std::uint32_t behaviour, std::uint64_t iteration) {
    lane_.call(now, behaviour, iteration);
  }
  /// stamp: of what has been read, which may be invalid. newer: than all that has been read.
  void input(std::size_t index, Time now, Time stamp, bool newer);
  enum class Reading : std::uint8_t { value, silent, failed };
  void real_input(std::size_t index, Time now, Reading reading);
  /// Records the outputs and the fields of memory that have changed.
  void results(Time now);
  /// Records the fields of memory that have changed.
  void memory(Time now);

 private:
  struct Buffer {
    Buffer(std::uint32_t its_number, const void* its_value, const ValueEncoding* its_encoding,
           std::uint64_t limit);
    std::uint32_t number;
    const void* value;
    const ValueEncoding* encoding;  // nullptr: not recorded
    ValueSink written, now;
    bool known = false;   // `written` is the value in the recording
    bool silent = false;  // the recording says that the device has no value
  };
  [[nodiscard]] static bool changed(Buffer& buffer);
  void write(Buffer& buffer, Time now, std::uint32_t flags, std::span<const std::byte> stamp);

  RecordingLane& lane_;
  std::vector<Buffer> inputs_, results_, real_inputs_;
  std::size_t first_memory_ = 0;          // in results_
  std::vector<const Arrival*> arrivals_;  // of inputs_
};

/// Calls `visit(direction, buffer)` in the order in which they are numbered.
template <class Visit>
void for_buffers(const Bindings& bindings, Visit visit) {
  using Direction = Recording::Direction;
  for (const Bindings::Incoming& buffer : bindings.inputs) visit(Direction::input, buffer);
  for (const Bindings::Outgoing& buffer : bindings.outputs) visit(Direction::output, buffer);
  for (const Bindings::Incoming& buffer : bindings.real_inputs) visit(Direction::real_input, buffer);
  for (const Bindings::RealOutgoing& buffer : bindings.real_outputs) visit(Direction::real_output, buffer);
}

/// Calls `visit(field)` for the fields of memory that are recorded, in the order in which they are numbered.
/// Fields that may be longer than the limit are not: they would have to be read as a whole each time.
template <class Visit>
void for_memory(const Bindings& bindings, std::uint64_t limit, Visit visit) {
  for (const Bindings::Remembered& field : bindings.memory)
    if (field.encoding != nullptr && field.encoding->most <= limit) visit(field);
}

/// The number of fields of memory that are recorded.
[[nodiscard]] std::uint32_t count_memory(const Bindings& bindings, std::uint64_t limit);

/// The number of buffers of a subsystem that are numbered.
[[nodiscard]] std::uint32_t count_buffers(const Bindings& bindings);

}  // namespace tessera
