#include <gmock/gmock.h>

#include <random>

#include "spec_reading.hpp"

/// Texts that are too large, too deep or no text at all to be kept as files.
namespace tessera::spec {
namespace {

using testing::HasSubstr;

const std::string head = "tessera: 1\nsystem: demo\n";

TEST(HostileText, AnEmptyFileIsNamedEmpty) {
  for (const std::string text : {"", "\n\n", "  \t\r\n", "\xEF\xBB\xBF", "---\n", "~\n"}) {
    EXPECT_EQ(Reading(text).codes(), "E002") << text;
  }
  EXPECT_THAT(Reading("").report(), HasSubstr("the file is empty"));
}

TEST(HostileText, ABinaryFileIsRefusedAtItsFirstControlCharacter) {
  const Reading reading(
      std::string("\x7f"
                  "ELF\x02\x01\x01\0\0\0",
                  10));
  EXPECT_EQ(reading.codes(), "E003");
  const Reading later(head + std::string("types: \0\n", 9));
  EXPECT_EQ(later.diagnostics.sorted().at(0).span, (Span{3, 8, 1}));
}

TEST(HostileText, TextThatIsNotUtf8IsRefusedWhereItIsNot) {
  const Reading reading(head + "types: caf\xe9\n");
  EXPECT_EQ(reading.codes(), "E004");
  EXPECT_EQ(reading.diagnostics.sorted()[0].span, (Span{3, 11, 1}));
  EXPECT_EQ(Reading("\xff\xfet\0").codes(), "E004");
}

TEST(HostileText, AByteOrderMarkIsSkipped) {
  const Reading reading("\xEF\xBB\xBF" + golden("valid/line_follower.yaml"));
  EXPECT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(Reading("\xEF\xBB\xBFtesera: 1\n").diagnostics.sorted().at(0).span.column, 4U);
}

TEST(HostileText, ALineOfTenMegabytesIsRefusedAtOnce) {
  const Reading reading(head + "agents: " + std::string(10'000'000, 'x') + "\n");
  EXPECT_EQ(reading.codes(), "E011");
  EXPECT_EQ(reading.diagnostics.sorted()[0].span.line, 3U);
  EXPECT_LT(reading.report().size(), 500U);
}

TEST(HostileText, LongWordsAreReportedBriefly) {
  const std::string word(200'000, 'x');
  for (const std::string& text :
       {head + "agents: " + word, head + word, head + "types: { " + word + ": bool }", word,
        "tessera: 1\nsystem: \"" + word, head + "parameters: { v: " + word + " }\n",
        head + "types:\n  ? " + word + "\n  : { a: " + word + "<=3 }\n"}) {
    const Reading reading(text);
    EXPECT_FALSE(reading.model);
    EXPECT_LT(reading.report().size(), 5000U);
  }
}

TEST(HostileText, AliasesThatExplodeAreStopped) {
  std::string text = head + "types:\n  a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 30; ++i) {
    const std::string above = "*a" + std::to_string(i - 1);
    text += "  a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + above;
    for (int j = 0; j < 9; ++j) text += ", " + above;
    text += "]\n";
  }
  const Reading reading(text);
  EXPECT_EQ(reading.codes(), "E008");
  EXPECT_THAT(reading.report(), HasSubstr("aliases expand to more than 2000000 nodes"));
}

TEST(HostileText, DeepNestingIsRefusedNotFollowed) {
  EXPECT_EQ(Reading(head + "types: " + std::string(100'000, '[')).codes(), "E007");
  EXPECT_EQ(Reading(head + "types: " + std::string(70, '[') + std::string(70, ']')).codes(), "E007");
  std::string steps;
  for (int i = 0; i < 3000; ++i) steps += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_EQ(Reading(steps).codes(), "E007");
}

TEST(HostileText, AliasesDoNotHideDepth) {
  std::string text = head + "types:\n  a0: &a0 [x]\n";
  for (int i = 1; i < 100; ++i) {
    text += "  a" + std::to_string(i) + ": &a" + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
  }
  EXPECT_EQ(Reading(text).codes(), "E007");
}

TEST(HostileText, ManyMistakesAreAllReported) {
  std::string text = head + "types:\n";
  for (int i = 0; i < 5'000; ++i) text += "  T" + std::to_string(i) + ": { x: flot64 }\n";
  const Reading reading(text);
  EXPECT_EQ(reading.diagnostics.error_count(), 5'001U);
  EXPECT_GT(reading.report().size(), 200'000U);
}

TEST(HostileText, ATruncatedSpecificationNeverCrashes) {
  const std::string text = golden("valid/convoy.yaml");
  for (std::size_t size = 0; size < text.size(); size += 7) {
    const Reading reading(text.substr(0, size));
    EXPECT_TRUE(reading.model || reading.diagnostics.has_errors()) << size;
  }
}

TEST(HostileText, ASpecificationWithBytesSwappedNeverCrashes) {
  const std::string text = golden("valid/convoy.yaml");
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    std::string changed = text;
    for (int i = 0; i < 3; ++i)
      std::swap(changed[random() % changed.size()], changed[random() % changed.size()]);
    const Reading reading(changed);
    EXPECT_TRUE(reading.model || reading.diagnostics.has_errors()) << changed;
  }
}

}  // namespace
}  // namespace tessera::spec
