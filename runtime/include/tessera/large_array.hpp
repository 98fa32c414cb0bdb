#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace tessera {

/// A fixed array for images and clouds of points. It is a value like std::array, but copies share their
/// elements until one of them is written to. So a value goes through channels without being copied. An
/// output that is written to again is copied once.
///
/// *Writing.* Every access that could change elements - data(), begin() and [] of an array that is not const
/// - first makes sure that no other array shares them. Call `data()` once, or use a range-based for, rather
/// than calling [] a million times. Such a pointer must not be used after the array has been copied.
///
/// *Memory.* There are at least as many blocks of a type as arrays of it. So writing finds a free block and
/// allocates nothing; making an array may allocate. Blocks are kept for later arrays of the type.
///
/// Threads: as an int; different threads may use different copies at once.
template <class T, std::size_t N>
class LargeArray {
 public:
  using value_type = T;
  using size_type = std::size_t;
  using iterator = T*;
  using const_iterator = const T*;

  LargeArray() : block_(Blocks::instance().first_owned()) { block_->elements.fill(T{}); }
  LargeArray(std::initializer_list<T> values) : LargeArray() {
    std::copy_n(values.begin(), std::min(values.size(), N), block_->elements.begin());
  }
  LargeArray(const LargeArray& other) : block_(other.shared()) { Blocks::instance().one_array_more(); }
  LargeArray& operator=(const LargeArray& other) {
    if (block_ != other.block_) {
      Block* const former = block_;
      block_ = other.shared();
      former->owners.fetch_sub(1, std::memory_order_acq_rel);
    }
    return *this;
  }
  ~LargeArray() {
    block_->owners.fetch_sub(1, std::memory_order_acq_rel);
    Blocks::instance().one_array_less();
  }

  [[nodiscard]] static constexpr std::size_t size() { return N; }
  [[nodiscard]] static constexpr bool empty() { return N == 0; }
  [[nodiscard]] const T* data() const { return block_->elements.data(); }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + N; }
  [[nodiscard]] const T& operator[](std::size_t index) const { return data()[index]; }
  [[nodiscard]] const T& front() const { return data()[0]; }
  [[nodiscard]] const T& back() const { return data()[N - 1]; }

  [[nodiscard]] T* data() { return own().data(); }
  [[nodiscard]] T* begin() { return data(); }
  [[nodiscard]] T* end() { return data() + N; }
  [[nodiscard]] T& operator[](std::size_t index) { return data()[index]; }
  void fill(const T& value) { own(/*keeping=*/false).fill(value); }

  friend bool operator==(const LargeArray& a, const LargeArray& b) {
    return a.block_ == b.block_ || a.block_->elements == b.block_->elements;
  }

 private:
  struct Block {
    std::atomic<std::uint32_t> owners{0};
    Block* next = nullptr;
    alignas(64) std::array<T, N> elements{};
  };

  /// All blocks of the type, in a list that only grows.
  class Blocks {
   public:
    /// Never destroyed, because arrays with static storage duration may outlive it.
    static Blocks& instance() {
      static Blocks& blocks = *new Blocks;
      return blocks;
    }
    Block* first_owned() {
      one_array_more();
      for (;;)
        if (Block* const block = free_one()) return block;
    }
    void one_array_more() {
      const std::uint64_t arrays = arrays_.fetch_add(1, std::memory_order_acq_rel) + 1;
      for (std::uint64_t blocks = blocks_.load(std::memory_order_acquire); blocks < arrays;) {
        if (!blocks_.compare_exchange_weak(blocks, blocks + 1, std::memory_order_acq_rel)) continue;
        auto* const made = new Block;
        made->next = first_.load(std::memory_order_relaxed);
        while (!first_.compare_exchange_weak(made->next, made, std::memory_order_acq_rel)) continue;
        break;
      }
    }
    void one_array_less() { arrays_.fetch_sub(1, std::memory_order_acq_rel); }
    /// A block that the caller then owns. nullptr: none is free at the moment.
    Block* free_one() {
      for (Block* block = first_.load(std::memory_order_acquire); block != nullptr; block = block->next) {
        std::uint32_t none = 0;
        if (block->owners.load(std::memory_order_relaxed) == 0 &&
            block->owners.compare_exchange_strong(none, 1, std::memory_order_acq_rel))
          return block;
      }
      return nullptr;
    }

   private:
    std::atomic<Block*> first_{nullptr};
    std::atomic<std::uint64_t> blocks_{0}, arrays_{0};
  };

  Block* shared() const {
    block_->owners.fetch_add(1, std::memory_order_relaxed);
    return block_;
  }

  /// The elements, which no other array shares after the call. keeping: they keep their values.
  std::array<T, N>& own(bool keeping = true) {
    while (block_->owners.load(std::memory_order_acquire) != 1) {
      Block* const own = Blocks::instance().free_one();
      if (own == nullptr) continue;  // the other array has taken the last free block, so this one is ours now
      if (keeping) own->elements = block_->elements;
      block_->owners.fetch_sub(1, std::memory_order_acq_rel);
      block_ = own;
    }
    return block_->elements;
  }

  Block* block_;
};

}  // namespace tessera
