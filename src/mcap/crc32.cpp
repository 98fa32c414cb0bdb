#include "mcap/crc32.hpp"

#include <array>
#include <cstddef>
#include <cstring>

namespace tessera::mcap {
namespace {

constexpr std::size_t slices = 4;
using Tables = std::array<std::array<std::uint32_t, 256>, slices>;

/// Table n advances the check sum of a byte by n more bytes.
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest & 1U) != 0 ? 0xedb88320U ^ (rest >> 1U) : rest >> 1U;
    tables[0][byte] = rest;
  }
  for (std::size_t slice = 1; slice < slices; ++slice)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[slice - 1][byte];
      tables[slice][byte] = tables[0][before & 0xffU] ^ (before >> 8U);
    }
  return tables;
}
constexpr Tables tables = make_tables();

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  std::uint32_t sum = ~before;
  while (bytes.size() >= slices) {
    std::uint32_t four = 0;
    std::memcpy(&four, bytes.data(), sizeof four);
    sum ^= four;
    sum = tables[3][sum & 0xffU] ^ tables[2][(sum >> 8U) & 0xffU] ^ tables[1][(sum >> 16U) & 0xffU] ^
          tables[0][sum >> 24U];
    bytes.remove_prefix(slices);
  }
  for (const char byte : bytes)
    sum = tables[0][(sum ^ static_cast<std::uint8_t>(byte)) & 0xffU] ^ (sum >> 8U);
  return ~sum;
}

}  // namespace tessera::mcap
