#include "diagnostics/utf8.hpp"

#include <gtest/gtest.h>

namespace tessera::diagnostics {
namespace {

TEST(Utf8, DecodesEveryLength) {
  EXPECT_EQ(decode("a", 0).code, U'a');
  EXPECT_EQ(decode("\u00e9", 0).code, U'\u00e9');
  EXPECT_EQ(decode("\u20ac", 0).length, 3);
  EXPECT_EQ(decode("\U0001F600", 0).code, U'\U0001F600');
}

class NotUtf8 : public testing::TestWithParam<std::string> {};

TEST_P(NotUtf8, IsOneInvalidByte) {
  const CodePoint point = decode(GetParam(), 0);
  EXPECT_FALSE(point.valid);
  EXPECT_EQ(point.length, 1);
  EXPECT_EQ(first_invalid_byte("ok " + GetParam()), 3U);
}

INSTANTIATE_TEST_SUITE_P(Bytes, NotUtf8,
                         testing::Values("\xff", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80",
                                         "\xf5\x80\x80\x80", "\xf4\x90\x80\x80", "\x80", "\xc3", "\xe2\x82",
                                         "\xc3("));

TEST(Utf8, ControlCharactersAreSpelledOut) {
  EXPECT_EQ(visible(std::string("a\x1b[31m\0b", 8)), "a\\x1B[31m\\x00b");
  EXPECT_EQ(visible("safe\u202eevil"), "safe<U+202E>evil");
  EXPECT_EQ(visible("\xff"), "\\xFF");
}

TEST(Utf8, LongWordsAreShortened) {
  const std::string word = in_quotes(std::string(1000, 'x'));
  EXPECT_LT(word.size(), 80U);
  EXPECT_TRUE(word.ends_with("...'"));
  EXPECT_FALSE(
      first_invalid_byte(in_quotes("x" + std::string(59, 'y') + std::string(200, '\xc3'))).has_value());
}

}  // namespace
}  // namespace tessera::diagnostics
