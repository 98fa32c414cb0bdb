#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

/// Numbers, texts and maps as MCAP writes them.
namespace tessera::mcap {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");

template <class Number>
void put_number(std::string& to, Number number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}
void put_text(std::string& to, std::string_view text);
void put_map(std::string& to, const std::map<std::string, std::string>& map);

/// Reads the content of a record. After the first read that fails, `ok` stays false, and reads give zeros and
/// empty texts.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

  template <class Number>
  Number number() {
    Number value{};
    const std::string_view bytes = take(sizeof value);
    if (ok_) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  /// `count` bytes.
  std::string_view take(std::uint64_t count);
  std::string text() { return std::string(take(number<std::uint32_t>())); }
  std::map<std::string, std::string> map();

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace tessera::mcap
