#pragma once

#include <cstddef>
#include <utility>

namespace tessera::explore {

/// Zeroed memory directly from the system. It grows without being copied and takes no RAM until it is used.
///
/// Throws std::bad_alloc. Threads: one at a time.
class MappedMemory {
 public:
  MappedMemory() = default;
  MappedMemory(MappedMemory&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  MappedMemory& operator=(MappedMemory&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  MappedMemory(const MappedMemory&) = delete;
  MappedMemory& operator=(const MappedMemory&) = delete;
  ~MappedMemory() { release(); }

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
