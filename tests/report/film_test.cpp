// The bytes of films.

#include "report/film.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tessera::report {
namespace {

[[nodiscard]] Frame grey(int width, int height, std::uint8_t value) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), value)};
}

struct Taken {
  std::string bytes;
  [[nodiscard]] FilmSink sink() {
    return [this](std::string_view more) {
      bytes += more;
      return true;
    };
  }
};

TEST(Y4mFilm, HasOneHeadAndAsManyBytesAFrameAsItsHeadPromises) {
  Taken film;
  const auto writer = y4m_writer(6, 4, 25, film.sink());
  ASSERT_TRUE(writer->add(grey(6, 4, 200)));
  Frame red = grey(6, 4, 0);
  for (std::size_t at = 0; at < red.rgb.size(); at += 3) red.rgb[at] = 255;
  ASSERT_TRUE(writer->add(red));
  ASSERT_TRUE(writer->finish());
  const std::string head = "YUV4MPEG2 W6 H4 F25:1 Ip A1:1 C420jpeg\n", mark = "FRAME\n";
  constexpr std::size_t luma = 24, chroma = 6;
  const std::string first = head + mark + std::string(luma, '\xc8') + std::string(2 * chroma, '\x80');
  ASSERT_EQ(film.bytes.size(), first.size() + mark.size() + luma + 2 * chroma);
  EXPECT_EQ(film.bytes.substr(0, first.size()), first);
  // Red, as ITU-R BT.601 has it.
  EXPECT_EQ(film.bytes.substr(first.size()),
            mark + std::string(luma, '\x4c') + std::string(chroma, '\x55') + std::string(chroma, '\xff'));
}

/// Names of chunks; their checksums are those of their bytes.
[[nodiscard]] std::vector<std::string> chunks_of(const std::string& png) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t byte = 0; byte < 4; ++byte)
      value = value << 8U | static_cast<std::uint8_t>(png[at + byte]);
    return value;
  };
  std::vector<std::string> names;
  std::size_t at = 8;
  while (at + 12 <= png.size()) {
    const std::uint32_t length = number(at);
    std::uint32_t sum = 0xffffffffU;
    for (std::size_t byte = at + 4; byte < at + 8 + length; ++byte) {
      sum ^= static_cast<std::uint8_t>(png[byte]);
      for (int bit = 0; bit < 8; ++bit) sum = (sum & 1U) != 0 ? sum >> 1U ^ 0xedb88320U : sum >> 1U;
    }
    EXPECT_EQ(~sum, number(at + 8 + length));
    names.push_back(png.substr(at + 4, 4));
    at += length + 12;
  }
  EXPECT_EQ(at, png.size());
  return names;
}

TEST(AnimatedPng, HasItsChunksInOrder) {
  Taken film;
  const auto writer = apng_writer(3, 25, film.sink());
  for (const int value : {0, 100, 255})
    ASSERT_TRUE(writer->add(grey(8, 6, static_cast<std::uint8_t>(value))));
  ASSERT_TRUE(writer->finish());
  EXPECT_EQ(film.bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(chunks_of(film.bytes), (std::vector<std::string>{"IHDR", "acTL", "fcTL", "IDAT", "fcTL", "fdAT",
                                                             "fcTL", "fdAT", "IEND"}));
}

TEST(AFilm, EndsWhenTheDiskIsFull) {
  const auto full = [](std::string_view) { return false; };
  EXPECT_FALSE(y4m_writer(6, 4, 25, full)->add(grey(6, 4, 1)));
  EXPECT_FALSE(apng_writer(1, 25, full)->add(grey(6, 4, 1)));
}

TEST(Caption, IsWrittenWhereItBelongsAndMayBeAnything) {
  const Frame before = grey(320, 180, 128);
  Frame frame = before;
  put_caption(frame, {});
  EXPECT_EQ(frame.rgb, before.rgb);
  put_caption(frame, {.title = "", .time = "1.00 s", .alarms = {}});
  const auto half = frame.rgb.size() / 2;
  EXPECT_TRUE(std::equal(frame.rgb.begin(), frame.rgb.begin() + static_cast<std::ptrdiff_t>(half),
                         before.rgb.begin()));
  EXPECT_NE(frame.rgb, before.rgb);
  put_caption(frame, {.title = std::string(5000, 'w'),
                      .time = "\xff\xfe\x01",
                      .alarms = std::vector<std::string>(
                          100, "failed: \n\xf0\x9f\x98\x80 <b>" + std::string(900, 'x'))});
  std::size_t red = 0;
  for (std::size_t at = 0; at < frame.rgb.size(); at += 3)
    if (frame.rgb[at] > 100 && frame.rgb[at] > 2 * frame.rgb[at + 1]) ++red;
  EXPECT_GT(red, 1000U) << "an alarm is red";
  EXPECT_LT(red, 320U * 90U) << "and leaves something of the picture";
}

}  // namespace
}  // namespace tessera::report
