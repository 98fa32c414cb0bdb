#include "ros2/codec/request_header.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "ros2/codec/cdr.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::size_t header_size = 16;
using HeaderBytes = std::array<std::byte, header_size>;

}  // namespace

std::optional<RequestHeader> take_header(std::vector<std::byte>& message) {
  const auto reader = CdrReader::open(message);
  if (!reader || reader->left() < header_size) return std::nullopt;
  HeaderBytes bytes;
  const auto first = message.begin() + encapsulation_size;
  std::copy_n(first, header_size, bytes.begin());
  if (reader->swapped()) {
    std::reverse(bytes.begin(), bytes.begin() + header_size / 2);
    std::reverse(bytes.begin() + header_size / 2, bytes.end());
  }
  // Its size is a multiple of the largest alignment, so the data after it stays aligned.
  message.erase(first, first + header_size);
  return std::bit_cast<RequestHeader>(bytes);
}

void put_header(const RequestHeader& header, std::vector<std::byte>& message) {
  const auto bytes = std::bit_cast<HeaderBytes>(header);
  message.insert(message.begin() + encapsulation_size, bytes.begin(), bytes.end());
}

}  // namespace tessera::ros2
