#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace tessera {

/// A string of at most `Capacity` bytes, stored in place, so that it travels through a channel without
/// allocation. Longer text is cut.
template <std::size_t Capacity>
class BoundedString {
 public:
  BoundedString() = default;
  // NOLINTBEGIN(google-explicit-constructor): text is a BoundedString wherever one is expected.
  BoundedString(std::string_view text) { assign(text); }
  BoundedString(const char* text) : BoundedString(std::string_view(text)) {}

  operator std::string_view() const { return view(); }
  // NOLINTEND(google-explicit-constructor)
  [[nodiscard]] std::string_view view() const { return {bytes_.data(), size_}; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }

  friend bool operator==(const BoundedString& a, std::string_view b) { return a.view() == b; }
  // Without this overload, a comparison with a literal is ambiguous.
  friend bool operator==(const BoundedString& a, const char* b) { return a.view() == b; }
  friend bool operator==(const BoundedString& a, const BoundedString& b) { return a.view() == b.view(); }

 private:
  void assign(std::string_view text) {
    size_ = static_cast<std::uint32_t>(text.size() < Capacity ? text.size() : Capacity);
    std::memcpy(bytes_.data(), text.data(), size_);
  }
  std::uint32_t size_ = 0;
  std::array<char, Capacity> bytes_{};
};

}  // namespace tessera
