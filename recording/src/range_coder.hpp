#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// Arithmetic coding of bits: the more probable a bit, the less space it takes. The interval is halved as in
/// G. N. N. Martin, Range encoding, 1979.
namespace tessera {

/// The probability that the next bit of a kind is 0, learned from the bits before it.
class BitModel {
 public:
  [[nodiscard]] std::uint32_t share_of(std::uint32_t range) const { return (range >> bits) * zero_; }
  void learn(bool bit) {
    if (bit)
      zero_ = static_cast<std::uint16_t>(zero_ - (zero_ >> rate));
    else
      zero_ = static_cast<std::uint16_t>(zero_ + (((1U << bits) - zero_) >> rate));
  }

 private:
  static constexpr unsigned bits = 12, rate = 4;
  std::uint16_t zero_ = 1U << (bits - 1);
};

class RangeEncoder {
 public:
  explicit RangeEncoder(std::string& bytes) : bytes_(bytes) {}
  /// The bit is written; the decoder's function of this name sets it.
  void bit(BitModel& model, bool& bit) {
    const std::uint32_t zero = model.share_of(range_);
    model.learn(bit);
    take(bit, zero);
  }
  /// A bit that is 0 or 1 with equal probability.
  void even_bit(bool& bit) { take(bit, range_ >> 1U); }
  /// Zeros at the end are not written: the decoder reads zeros beyond the end.
  void finish(std::size_t begin) {
    // The number of the interval that ends with the most zeros.
    for (unsigned zeros = 32; zeros > 0; --zeros) {
      const std::uint64_t mask = (std::uint64_t{1} << zeros) - 1, up = (low_ + mask) & ~mask;
      if (up >= low_ + range_) continue;
      low_ = up;
      break;
    }
    for (int byte = 0; byte < 5; ++byte) shift();
    while (bytes_.size() > begin && bytes_.back() == '\0') bytes_.pop_back();
  }

 private:
  void take(bool bit, std::uint32_t zero) {
    if (bit) {
      low_ += zero;
      range_ -= zero;
    } else {
      range_ = zero;
    }
    for (; range_ < 1U << 24U; range_ <<= 8U) shift();
  }
  void shift() {
    if (low_ < 0xff000000U || low_ >> 32U != 0) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32U);
      // The first byte is always 0 and left out.
      if (begun_) bytes_ += static_cast<char>(held_ + carry);
      begun_ = true;
      for (; waiting_ > 0; --waiting_) bytes_ += static_cast<char>(0xffU + carry);
      held_ = static_cast<std::uint8_t>(low_ >> 24U);
    } else {
      ++waiting_;
    }
    low_ = (low_ & 0x00ffffffU) << 8U;
  }

  std::string& bytes_;
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffffU;
  std::uint8_t held_ = 0;
  std::size_t waiting_ = 0;
  bool begun_ = false;
};

/// Accepts any bytes.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::string_view bytes) : bytes_(bytes) {
    for (int byte = 0; byte < 4; ++byte) shift();
  }
  void bit(BitModel& model, bool& bit) {
    bit = take(model.share_of(range_));
    model.learn(bit);
  }
  void even_bit(bool& bit) { bit = take(range_ >> 1U); }
  /// false: there are bytes that no encoder would have written.
  [[nodiscard]] bool has_read_all() const { return bytes_.empty(); }

 private:
  [[nodiscard]] bool take(std::uint32_t zero) {
    const bool bit = code_ >= zero;
    if (bit) {
      code_ -= zero;
      range_ -= zero;
    } else {
      range_ = zero;
    }
    for (; range_ < 1U << 24U; range_ <<= 8U) shift();
    return bit;
  }
  void shift() {
    code_ = code_ << 8U | (bytes_.empty() ? 0U : static_cast<std::uint8_t>(bytes_.front()));
    bytes_.remove_prefix(std::min<std::size_t>(1, bytes_.size()));
  }

  std::string_view bytes_;
  std::uint32_t code_ = 0, range_ = 0xffffffffU;
};

}  // namespace tessera
