#include "checks/parser.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tessera::checks_test {
namespace {

std::optional<checks::Unit> metres(std::string_view unit) {
  if (unit == "m" || unit == "m/s" || unit == "s") return checks::Unit{1, std::string(unit)};
  if (unit == "mm") return checks::Unit{1e-3, "m"};
  if (unit == "deg") return checks::Unit{0.0174533, "rad"};
  return std::nullopt;
}

std::string read(std::string_view text) {
  const auto parsed = checks::parse_formula(text, metres);
  return parsed.value ? checks::text_of(*parsed.value) : "";
}

TEST(ParserOfChecks, ReadsFormulas) {
  EXPECT_EQ(read("contact(robot[*], robot[*])"), "contact(robot[*], robot[*])");
  EXPECT_EQ(read("distance(robot[i],robot[i+1])>200 mm"), "distance(robot[i], robot[i+1]) > 0.2");
  EXPECT_EQ(read("distance(robot[i],robot[i+1]) > 350 mm"), "distance(robot[i], robot[i+1]) > 0.35");
  EXPECT_EQ(read("all(inside(box[*], bin))"), "all(inside(box[*], bin))");
  EXPECT_EQ(read("not contact(arm/hand) and height(box[3]/lid) >= 1.5m"),
            "(not (contact(arm/hand)) and height(box[3]/lid) >= 1.5)");
  EXPECT_EQ(read("a_is > 1"), "");
  EXPECT_EQ(read("speed(/cart) < 2 m/s or sensor(arm/force, 2) < -1e-3"),
            "(speed(/cart) < 2 or sensor(arm/force, 2) < -0.001)");
}

TEST(ParserOfChecks, BracketsMayHoldFormulasAndNumbers) {
  EXPECT_EQ(read("(speed(a) > 1)"), "speed(a) > 1");
  EXPECT_EQ(read("((speed(a) + 1) * 2 > 1)"), "((speed(a) + 1) * 2) > 1");
  EXPECT_EQ(read("((((speed(a))))) > 1 and (contact(a) or contact(b))"),
            "(speed(a) > 1 and (contact(a) or contact(b)))");
  EXPECT_EQ(read("speed(a) / 2 - speed(b) > 0"), "((speed(a) / 2) - speed(b)) > 0");
}

TEST(ParserOfChecks, WhatItWritesItReadsAlike) {
  for (const char* text : {"not (not contact(a))", "all(inside(box[*], bin) and not contact(box[*]))",
                           "-speed(a) < -(1 + 2) * 3",
                           "any(distance(robot[*], dock) < 1 mm) or contact(robot[i-1], robot[i])"}) {
    const std::string once = read(text);
    ASSERT_FALSE(once.empty()) << text;
    const auto again = checks::parse_formula(once, checks::no_units);
    ASSERT_TRUE(again.value) << once << ": " << again.mistake.text;
    EXPECT_EQ(checks::text_of(*again.value), once);
  }
}

struct Wrong {
  const char* text;
  std::size_t offset;
  const char* message;
};

TEST(ParserOfChecks, TellsWhereAMistakeIs) {
  for (const Wrong& wrong : {
           Wrong{"", 0, "the text ends too early"},
           {"contact(a, b", 11, "the text ends too early"},
           {"contact(a, b, c)", 12, "'contact' takes at most 2 elements"},
           {"contact a", 0, "'contact' needs brackets"},
           {"inside(a)", 0, "'inside' needs 2 elements"},
           {"distance(a, b)", 0, "a number alone is neither true nor false"},
           {"distance(a, b) > 3 furlong", 19, "unknown unit 'furlong'"},
           {"distanc(a, b) > 3", 0, "'distanc' is neither a number nor a function"},
           {"contact(a) && contact(b)", 11, "'&&' is not known here"},
           {"contact(robot[x])", 13, "this is no index"},
           {"contact(robot[99999999999999999999])", 13, "this is no index"},
           {"1 < speed(a) < 2", 13, "one comparison at a time"},
           {"speed(a) / speed(b) > 1", 11, "a number other than 0 must stand here"},
           {"speed(a) / 0 > 1", 11, "a number other than 0 must stand here"},
           {"all inside(a, b)", 0, "'all' needs brackets"},
           {"sensor(a, b) > 1", 10, "the number of a component must follow"},
           {"contact(\xc3\xa9)", 8, "a name should stand here"},
       }) {
    const auto parsed = checks::parse_formula(wrong.text, metres);
    ASSERT_FALSE(parsed.value) << wrong.text;
    EXPECT_EQ(parsed.mistake.text, wrong.message) << wrong.text;
    EXPECT_EQ(parsed.mistake.place.offset, wrong.offset) << wrong.text;
    EXPECT_GE(parsed.mistake.place.length, 1U);
  }
  EXPECT_EQ(checks::parse_formula("distanc(a, b) > 3", metres).mistake.hint.text, "did you mean 'distance'?");
}

TEST(ParserOfChecks, NumbersOfOneComparisonHaveOneUnit) {
  for (const char* text :
       {"distance(a, b) > 2", "distance(a, b) > 2 m", "speed(a) * 2 s < distance(a, b)",
        "speed(a) > -2 * 3 m/s", "distance(a, b) / 2 s < speed(b)", "sensor(a) > 2 deg and sensor(a) < 3 s",
        "height(a) + 2 > sensor(b)", "2 * sensor(a) * 3 m > 5 deg"})
    EXPECT_NE(read(text), "") << text;
  for (const Wrong& wrong : {
           Wrong{"distance(p, q) > 2 s", 17, "m cannot be compared with s"},
           {"height(p) > 300 deg", 12, "m cannot be compared with rad"},
           {"speed(robot) < 5 deg", 15, "m/s cannot be compared with rad"},
           {"5 deg > speed(robot)", 8, "rad cannot be compared with m/s"},
           {"speed(a) + 1 deg > 0", 11, "m/s cannot be added to rad"},
           {"1 - 2 s - 3 m > 0", 10, "s cannot be diminished by m"},
           {"-height(a) * 2 m < 3 m", 19, "m^2 cannot be compared with m"},
           {"height(a) / 2 m > 1 m", 18, "a plain number cannot be compared with m"},
       }) {
    const auto parsed = checks::parse_formula(wrong.text, metres);
    ASSERT_FALSE(parsed.value) << wrong.text;
    EXPECT_EQ(parsed.mistake.text, wrong.message) << wrong.text;
    EXPECT_EQ(parsed.mistake.place.offset, wrong.offset) << wrong.text;
  }
  EXPECT_EQ(checks::parse_formula("height(p) > 3 s", metres).mistake.hint.text,
            "write a number in m, or without a unit");
  EXPECT_FALSE(checks::parse_number("speed(robot) + 1 deg", metres).value);
}

TEST(ParserOfChecks, NumbersHaveAUnitIfItIsKnown) {
  const auto unit_of = [](std::string_view text) {
    return checks::unit_of(checks::parse_number(text, metres).value.value().dimension);
  };
  EXPECT_EQ(unit_of("distance(a, b) - 0.5"), "m");
  EXPECT_EQ(unit_of("-distance(a, b) / 2 s"), "m/s");
  EXPECT_EQ(unit_of("laps(a)"), "");
  EXPECT_EQ(unit_of("3 * sensor(a)"), "");
}

TEST(ParserOfChecks, DeepAndRandomTextsAreRefusedNotFollowed) {
  EXPECT_EQ(read(std::string(100'000, '(')), "");
  EXPECT_EQ(read("speed(a) > " + std::string(100'000, '-') + "1"), "");
  std::mt19937 random(1);
  const std::string letters = "robt[*i+1]/(),<>=-0.2 contact distance inside and or not any all m";
  std::size_t read_ones = 0;
  for (int n = 0; n < 5'000; ++n) {
    std::string text = n % 2 == 0 ? "all(inside(box[*], bin)) and distance(a, b) > 0.2 m" : "";
    for (int changes = 0; changes < n % 4; ++changes) {
      const std::size_t place = random() % (text.size() + 1), from = random() % letters.size();
      text.insert(place, letters.substr(from, 1 + random() % 9));
    }
    const auto parsed = checks::parse_formula(text, metres);
    read_ones += parsed.value ? 1 : 0;
    if (parsed.value) continue;
    ASSERT_LE(parsed.mistake.place.offset, text.size()) << text;
  }
  EXPECT_GT(read_ones, 0U);
}

}  // namespace
}  // namespace tessera::checks_test
