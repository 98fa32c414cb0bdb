#pragma once

#include <cstddef>
#include <utility>

namespace tessera::explore {

/// Zeroed memory that grows. Much of it comes directly from the system: it grows without being copied, and takes no RAM
/// until it is used.
///
/// Throws std::bad_alloc. Threads: one at a time.
class ZeroedMemory {
 public:
  ZeroedMemory() = default;
  ZeroedMemory(ZeroedMemory&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  ZeroedMemory& operator=(ZeroedMemory&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ZeroedMemory(const ZeroedMemory&) = delete;
  ZeroedMemory& operator=(const ZeroedMemory&) = delete;
  ~ZeroedMemory() { release(); }

  /// Grows to at least `bytes` and keeps the contents; the memory may move.
  void grow(std::size_t bytes);
  void release() noexcept;
  [[nodiscard]] void* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace tessera::explore
