#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "tessera/time.hpp"
#include "tessera/value_encoding.hpp"

namespace tessera {

/// The newest value of a sender, on its way to the thread that sends it. No thread waits: there are three
/// boxes, one of the writer, one of the reader, and one in between, which each side exchanges for its own. A
/// value that was not taken is overwritten.
///
/// Threads: one that writes and publishes, one that takes and reads. The exchange of the box in between
/// releases the written bytes and acquires the read ones.
class Outbox {
 public:
  struct Box {
    explicit Box(std::size_t longest) : bytes(longest) {}
    std::uint64_t number = 0;  ///< of the value; 0: none yet
    Time stamp{};
    bool valid = false;
    ValueSink bytes;
  };
  /// longest: bytes of the longest encoded value.
  explicit Outbox(std::size_t longest) : boxes_{Box(longest), Box(longest), Box(longest)} {}

  /// The box that the writer fills.
  [[nodiscard]] Box& back() { return boxes_[back_]; }
  void publish() {
    back_ = between_.exchange(static_cast<std::uint8_t>(back_ | fresh), std::memory_order_acq_rel) & number;
  }

  /// Takes the newest value; false: none has been published since.
  [[nodiscard]] bool take() {
    if ((between_.load(std::memory_order_acquire) & fresh) == 0) return false;
    front_ = between_.exchange(front_, std::memory_order_acq_rel) & number;
    return true;
  }
  /// The value that was taken last.
  [[nodiscard]] const Box& front() const { return boxes_[front_]; }

 private:
  static constexpr std::uint8_t fresh = 4, number = 3;
  std::array<Box, 3> boxes_;
  std::uint8_t back_ = 0;   // used by the writer only
  std::uint8_t front_ = 1;  // used by the reader only
  std::atomic<std::uint8_t> between_{2};
};

}  // namespace tessera
