#include "recorder/value_recorder.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tessera {

std::uint32_t count_buffers(const Bindings& bindings) {
  return static_cast<std::uint32_t>(bindings.inputs.size() + bindings.outputs.size() +
                                    bindings.real_inputs.size() + bindings.real_outputs.size());
}

std::uint32_t count_memory(const Bindings& bindings, std::uint64_t limit) {
  std::uint32_t count = 0;
  for_memory(bindings, limit, [&](const Bindings::Remembered&) { ++count; });
  return count;
}

ValueRecorder::Buffer::Buffer(std::uint32_t its_number, const void* its_value,
                              const ValueEncoding* its_encoding, std::uint64_t limit)
    : number(its_number),
      value(its_value),
      encoding(its_encoding),
      written(encoding == nullptr ? 0 : std::min<std::uint64_t>(encoding->most, limit)),
      now(encoding == nullptr ? 0 : std::min<std::uint64_t>(encoding->most, limit)) {}

ValueRecorder::ValueRecorder(const Bindings& bindings, std::uint32_t first_buffer, std::uint32_t first_memory,
                             std::uint64_t limit, RecordingLane& lane)
    : lane_(lane) {
  std::uint32_t number = first_buffer;
  for (const Bindings::Incoming& input : bindings.inputs) {
    inputs_.emplace_back(number++, input.value, input.encoding, limit);
    arrivals_.push_back(input.arrival);
  }
  for (const Bindings::Outgoing& output : bindings.outputs)
    results_.emplace_back(number++, output.value, output.encoding, limit);
  for (const Bindings::Incoming& input : bindings.real_inputs)
    real_inputs_.emplace_back(number++, input.value, input.encoding, limit);
  for (const Bindings::RealOutgoing& output : bindings.real_outputs)
    results_.emplace_back(number++, output.value, output.encoding, limit);
  number = first_memory;
  first_memory_ = results_.size();
  for_memory(bindings, limit, [&](const Bindings::Remembered& field) {
    results_.emplace_back(number++, field.value, field.encoding, limit);
  });
}

/// Whether the value has changed; `written` becomes the present value.
bool ValueRecorder::changed(Buffer& buffer) {
  buffer.now.clear();
  buffer.encoding->put(buffer.value, buffer.now);
  if (std::exchange(buffer.known, true) && buffer.now == buffer.written) return false;
  std::swap(buffer.now, buffer.written);
  return true;
}

/// stamp: empty or 8 bytes.
void ValueRecorder::write(Buffer& buffer, Time now, std::uint32_t flags, std::span<const std::byte> stamp) {
  if (buffer.written.whole()) return lane_.value(now, buffer.number, flags, stamp, buffer.written.bytes());
  const std::array numbers{buffer.written.size(), buffer.written.hash()};
  lane_.value(now, buffer.number, flags | ValueFlags::hashed, stamp, std::as_bytes(std::span(numbers)));
}

void ValueRecorder::input(std::size_t index, Time now, Time written, bool newer) {
  Buffer& buffer = inputs_[index];
  if (buffer.encoding == nullptr) return;
  const Arrival& arrival = *arrivals_[index];
  const std::array stamp{written.time_since_epoch().count()};
  const auto stamp_bytes = std::as_bytes(std::span(stamp));
  const std::uint32_t flags =
      ValueFlags::stamped | (arrival.valid ? ValueFlags::valid : 0) | (newer ? ValueFlags::fresh : 0);
  if (changed(buffer))
    write(buffer, now, flags, stamp_bytes);
  else
    lane_.value(now, buffer.number, flags | ValueFlags::same, stamp_bytes, {});
}

void ValueRecorder::real_input(std::size_t index, Time now, Reading reading) {
  Buffer& buffer = real_inputs_[index];
  if (buffer.encoding == nullptr) return;
  if (reading == Reading::value) {
    const bool was_silent = std::exchange(buffer.silent, false);
    if (changed(buffer))
      write(buffer, now, ValueFlags::fresh, {});
    else if (was_silent)
      lane_.value(now, buffer.number, ValueFlags::fresh | ValueFlags::same, {}, {});
    return;
  }
  const bool failed = reading == Reading::failed;
  if (std::exchange(buffer.silent, true) && !failed) return;
  lane_.value(now, buffer.number, failed ? ValueFlags::failed : ValueFlags::silent, {}, {});
  // If the device then has no value or throws again, that is recorded again.
  if (failed) buffer.silent = false, buffer.known = false;
}

void ValueRecorder::results(Time now) {
  for (Buffer& buffer : results_)
    if (buffer.encoding != nullptr && changed(buffer)) write(buffer, now, 0, {});
}

void ValueRecorder::memory(Time now) {
  for (std::size_t field = first_memory_; field < results_.size(); ++field)
    if (changed(results_[field])) write(results_[field], now, 0, {});
}

}  // namespace tessera
