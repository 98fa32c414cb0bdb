#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>

namespace tessera {

/// 0 to `Most` elements, stored in place, so that it travels through a channel without allocation. It is used
/// like a std::vector, except that it refuses what it cannot hold: an element that it does not have, and one
/// more than `Most`. The exception makes the behaviour fail, as every exception of user code does.
///
/// Errors: std::out_of_range from operator[], front and back; std::length_error from push_back, resize and
///         constructors.
template <class T, std::size_t Most, class Storage = std::array<T, Most>>
class BoundedSequence {
 public:
  using value_type = T;
  using size_type = std::size_t;
  using iterator = T*;
  using const_iterator = const T*;

  BoundedSequence() = default;
  BoundedSequence(std::initializer_list<T> values) { assign(values.begin(), values.end()); }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == Most; }
  /// The largest number of elements.
  [[nodiscard]] static constexpr std::size_t capacity() { return Most; }
  [[nodiscard]] static constexpr std::size_t max_size() { return Most; }

  [[nodiscard]] const T* data() const { return elements_.data(); }
  [[nodiscard]] const T* begin() const { return elements_.data(); }
  [[nodiscard]] const T* end() const { return elements_.data() + size_; }
  [[nodiscard]] const T& operator[](std::size_t index) const { return elements_.data()[checked(index)]; }
  [[nodiscard]] const T& at(std::size_t index) const { return (*this)[index]; }
  [[nodiscard]] const T& front() const { return (*this)[0]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - std::size_t{1}]; }

  [[nodiscard]] T* data() { return elements_.data(); }
  [[nodiscard]] T* begin() { return elements_.data(); }
  [[nodiscard]] T* end() { return elements_.data() + size_; }
  [[nodiscard]] T& operator[](std::size_t index) { return elements_.data()[checked(index)]; }
  [[nodiscard]] T& at(std::size_t index) { return (*this)[index]; }
  [[nodiscard]] T& front() { return (*this)[0]; }
  [[nodiscard]] T& back() { return (*this)[size_ - std::size_t{1}]; }

  void push_back(const T& value) {
    const T copy = value;  // which may be one of its own elements
    resize(std::size_t{size_} + 1);
    elements_.data()[size_ - 1] = copy;
  }
  void pop_back() {
    if (size_ > 0) resize(std::size_t{size_} - 1);
  }
  void clear() { resize(0); }
  /// New elements are T{}.
  void resize(std::size_t size) {
    if (size > Most)
      throw std::length_error(std::to_string(size) + " elements for a sequence of at most " +
                              std::to_string(Most));
    if (size < size_) {
      // A place without an element is T{} again, as new elements are.
      T* const all = elements_.data();
      for (std::size_t index = size; index < size_; ++index) all[index] = T{};
    }
    size_ = static_cast<std::uint32_t>(size);
  }
  template <class Iterator>
  void assign(Iterator first, Iterator last) {
    clear();
    for (; first != last; ++first) push_back(*first);
  }

  friend bool operator==(const BoundedSequence& a, const BoundedSequence& b) {
    if (a.size_ != b.size_) return false;
    for (std::size_t index = 0; index < a.size_; ++index)
      if (!(a.data()[index] == b.data()[index])) return false;
    return true;
  }

 private:
  [[nodiscard]] std::size_t checked(std::size_t index) const {
    if (index >= size_)
      throw std::out_of_range("element " + std::to_string(index) + " of a sequence of " +
                              std::to_string(size_));
    return index;
  }

  std::uint32_t size_ = 0;
  Storage elements_{};
};

}  // namespace tessera
