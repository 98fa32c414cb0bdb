#include "report/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace tessera::report {
namespace {

class Y4mWriter final : public FilmWriter {
 public:
  Y4mWriter(int width, int height, int frames_per_s, FilmSink sink)
      : sink_(std::move(sink)),
        head_(fmt::format("YUV4MPEG2 W{} H{} F{}:1 Ip A1:1 C420jpeg\n", width, height, frames_per_s)) {}

  [[nodiscard]] bool add(const Frame& frame) override {
    std::string bytes = std::exchange(head_, std::string()) + "FRAME\n";
    const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
    const std::size_t luma = bytes.size(), blue = luma + width * height, red = blue + width * height / 4;
    bytes.resize(red + width * height / 4);
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < width; ++x)
        bytes[luma + y * width + x] = byte(dot({0.299, 0.587, 0.114}, sum_of(frame, x, y, 1)));
    for (std::size_t y = 0; y < height / 2; ++y)
      for (std::size_t x = 0; x < width / 2; ++x) {
        const std::array<double, 3> mean = sum_of(frame, 2 * x, 2 * y, 2);
        bytes[blue + y * (width / 2) + x] = byte(128 + dot({-0.168736, -0.331264, 0.5}, mean));
        bytes[red + y * (width / 2) + x] = byte(128 + dot({0.5, -0.418688, -0.081312}, mean));
      }
    return sink_(bytes);
  }
  [[nodiscard]] bool finish() override { return head_.empty() || sink_(std::exchange(head_, std::string())); }

 private:
  /// The mean of a square of pixels.
  [[nodiscard]] static std::array<double, 3> sum_of(const Frame& frame, std::size_t left, std::size_t top,
                                                    std::size_t side) {
    std::array<double, 3> mean{};
    const auto pixels = static_cast<double>(side * side);
    for (std::size_t y = top; y < top + side; ++y)
      for (std::size_t x = left; x < left + side; ++x)
        for (std::size_t colour = 0; colour < 3; ++colour)
          mean[colour] += frame.rgb[3 * (y * static_cast<std::size_t>(frame.width) + x) + colour] / pixels;
    return mean;
  }
  [[nodiscard]] static double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  [[nodiscard]] static char byte(double value) {
    return static_cast<char>(static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0)));
  }

  FilmSink sink_;
  std::string head_;  // empty: written
};

void put_number(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>(static_cast<std::uint8_t>(number >> static_cast<unsigned>(shift)));
}
[[nodiscard]] std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t byte = 0; byte < 4; ++byte)
    number = number << 8U | static_cast<std::uint8_t>(bytes[at + byte]);
  return number;
}

/// As the PNG specification defines it.
[[nodiscard]] std::uint32_t checksum(std::string_view bytes) {
  std::uint32_t sum = 0xffffffffU;
  for (const char c : bytes) {
    sum ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1U ^ (0xedb88320U & (0U - (sum & 1U)));
  }
  return ~sum;
}

void put_chunk(std::string& file, std::string_view name, std::string_view data) {
  put_number(file, static_cast<std::uint32_t>(data.size()));
  const std::string checked = std::string(name) + std::string(data);
  file += checked;
  put_number(file, checksum(checked));
}

constexpr std::size_t signature_bytes = 8, around_chunk = 12;

/// Calls `use(name, data)` for every chunk of a PNG.
template <class Use>
void for_chunks(std::string_view png, Use&& use) {
  for (std::size_t at = signature_bytes; at + around_chunk <= png.size();) {
    const std::size_t length = number_at(png, at);
    if (length > png.size() - at - around_chunk) break;
    use(png.substr(at + 4, 4), png.substr(at + 8, length));
    at += length + around_chunk;
  }
}

class ApngWriter final : public FilmWriter {
 public:
  ApngWriter(std::size_t frames, int frames_per_s, FilmSink sink)
      : frames_(frames), frames_per_s_(frames_per_s), sink_(std::move(sink)) {}

  [[nodiscard]] bool add(const Frame& frame) override {
    const std::string png = png_of(frame);
    const bool first = number_ == 0;
    std::string bytes = first ? png.substr(0, signature_bytes) : std::string();
    std::string data;
    for_chunks(png, [&](std::string_view name, std::string_view its) {
      if (name == "IHDR" && first) put_chunk(bytes, name, its);
      if (name == "IDAT") data += its;
    });
    if (first) put_chunk(bytes, "acTL", numbers({static_cast<std::uint32_t>(frames_), 0}));
    put_chunk(bytes, "fcTL", control(frame));
    if (first)
      put_chunk(bytes, "IDAT", data);
    else
      put_chunk(bytes, "fdAT", numbers({number_++}) + data);
    return sink_(bytes);
  }
  [[nodiscard]] bool finish() override {
    std::string bytes;
    put_chunk(bytes, "IEND", {});
    return sink_(bytes);
  }

 private:
  [[nodiscard]] static std::string numbers(std::initializer_list<std::uint32_t> all) {
    std::string bytes;
    for (const std::uint32_t number : all) put_number(bytes, number);
    return bytes;
  }
  /// Number, size, place, how long it is shown, and that it replaces what was there.
  [[nodiscard]] std::string control(const Frame& frame) {
    std::string bytes = numbers(
        {number_++, static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height), 0, 0});
    for (const int part : {1, frames_per_s_}) {
      bytes += static_cast<char>(part >> 8);
      bytes += static_cast<char>(part & 0xff);
    }
    return bytes + std::string(2, '\0');
  }

  std::size_t frames_;
  int frames_per_s_;
  std::uint32_t number_ = 0;  // of the next chunk that has one
  FilmSink sink_;
};

}  // namespace

std::unique_ptr<FilmWriter> y4m_writer(int width, int height, int frames_per_s, FilmSink sink) {
  return std::make_unique<Y4mWriter>(width, height, frames_per_s, std::move(sink));
}

std::unique_ptr<FilmWriter> apng_writer(std::size_t frames, int frames_per_s, FilmSink sink) {
  return std::make_unique<ApngWriter>(frames, frames_per_s, std::move(sink));
}

}  // namespace tessera::report
