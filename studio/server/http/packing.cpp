#include "server/http/packing.hpp"

#include <zlib.h>

#include <string_view>

namespace tessera::server {

std::string gzip(const std::vector<std::shared_ptr<const std::string>>& pieces, Effort effort) {
  constexpr int gzip_format = 15 + 16, memory = 8;
  constexpr std::size_t step = std::size_t{1} << 16U;
  z_stream stream{};
  if (deflateInit2(&stream, static_cast<int>(effort), Z_DEFLATED, gzip_format, memory, Z_DEFAULT_STRATEGY) !=
      Z_OK)
    return {};
  std::string packed;
  std::string room(step, '\0');
  bool good = true;
  const auto pass = [&](std::string_view bytes, int flush) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(room.data());
      stream.avail_out = static_cast<uInt>(room.size());
      const int told = deflate(&stream, flush);
      good = good && (told == Z_OK || told == Z_STREAM_END || told == Z_BUF_ERROR);
      packed.append(room.data(), room.size() - stream.avail_out);
    } while (good && stream.avail_out == 0);
  };
  for (const auto& piece : pieces)
    for (std::size_t at = 0; good && at < piece->size(); at += step)
      pass(std::string_view(*piece).substr(at, step), Z_NO_FLUSH);
  pass({}, Z_FINISH);
  deflateEnd(&stream);
  if (!good) packed.clear();
  return packed;
}

}  // namespace tessera::server
