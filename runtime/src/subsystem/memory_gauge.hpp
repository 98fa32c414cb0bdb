#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/control_messages.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/value_encoding.hpp"
#include "tessera/value_text.hpp"

namespace tessera {

/// The memory of a running subsystem as observers see it: all fields at one moment, the end of an iteration.
///
/// Threads: `show` the subsystem's; `read` any. Neither waits for the other. Only the constructor and `read`
/// allocate.
class MemoryGauge {
 public:
  /// Fields beyond this total size are not shown, so that `show` takes little time.
  static constexpr std::size_t most_bytes = 4096;

  explicit MemoryGauge(const Bindings& bindings);
  void show();

  /// Empty: there is no memory, or it changes so fast that no moment could be read.
  [[nodiscard]] std::vector<Snapshot::MemoryField> read() const;

 private:
  struct Source {
    std::string name;
    const void* value;
    const ValueEncoding* encoding;
    ValueLayout layout;
  };
  [[nodiscard]] bool copy(std::vector<std::uint64_t>& words) const;
  std::vector<Source> sources_;
  ValueSink now_, shown_;
  std::vector<std::uint64_t> ends_;                // of the fields in `now_`
  std::atomic<std::uint64_t> version_{0};          // odd: words_ change
  std::vector<std::atomic<std::uint64_t>> words_;  // the ends of all fields, then their bytes
};

}  // namespace tessera
