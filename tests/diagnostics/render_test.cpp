#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "diagnostics/diagnostics.hpp"

namespace tessera::diagnostics {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string line_number(int line, const std::string& text) { return std::string(line, '\n') + text; }

TEST(Render, ShowsPlaceLineCaretAndHint) {
  Diagnostics out("arm.yaml", line_number(13, "    to: gripr\n"));
  out.error("E101", {14, 9, 5}, "unknown subsystem 'gripr'", "did you mean 'gripper'?");
  EXPECT_EQ(render(out),
            "arm.yaml:14:9: error E101: unknown subsystem 'gripr'\n"
            "   14 |     to: gripr\n"
            "      |         ^~~~~\n"
            "hint: did you mean 'gripper'?\n"
            "1 error\n");
}

TEST(Render, AComplaintAboutTheWholeFileHasNoLine) {
  Diagnostics out("arm.yaml", "");
  out.error("E002", {}, "the file is empty");
  EXPECT_EQ(render(out), "arm.yaml: error E002: the file is empty\n1 error\n");
}

TEST(Render, CountsBySeverity) {
  Diagnostics out("a", "x\n");
  EXPECT_EQ(render(out), "");
  out.error("E1", {1, 1, 1}, "one");
  out.error("E2", {1, 1, 1}, "two");
  out.warning("W1", {1, 1, 1}, "three");
  out.note("N1", {1, 1, 1}, "four");
  EXPECT_TRUE(render(out).ends_with("2 errors, 1 warning, 1 note\n"));
}

TEST(Render, TheCaretStaysBelowTextBehindTabs) {
  Diagnostics out("a", "\tab\tword\n");
  out.error("E1", {1, 5, 4}, "wrong");
  EXPECT_THAT(render(out), HasSubstr("    1 |     ab  word\n      |         ^~~~\n"));
}

TEST(Render, TheCaretStaysBelowTextBehindWideAndCombiningCharacters) {
  Diagnostics out("a", "\u00e9\u6f22e\u0301 word\n");
  out.error("E1", {1, 10, 4}, "wrong");
  EXPECT_THAT(render(out), HasSubstr("      |      ^~~~\n"));
}

TEST(Render, ControlCharactersAreNotPrinted) {
  Diagnostics out("a", std::string("a\x1b[31m\0 word\n", 13));
  out.error("E1", {1, 9, 4}, "wrong \x1b[1m", "hint \x07");
  const std::string text = render(out);
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  EXPECT_THAT(text, HasSubstr("    1 | a\\x1B[31m\\x00 word\n      |               ^~~~\n"));
  EXPECT_THAT(text, HasSubstr("hint \\x07"));
}

TEST(Render, ALongLineIsCutAroundTheSpan) {
  const std::string filler(5'000'000, 'x');
  Diagnostics out("a", filler + " word " + filler + "\n");
  out.error("E1", {1, 5'000'002, 4}, "wrong");
  const std::string text = render(out);
  EXPECT_LT(text.size(), 500U);
  EXPECT_THAT(text, HasSubstr("word"));
  EXPECT_THAT(text, HasSubstr("    1 | ...x"));
  EXPECT_THAT(text, HasSubstr("x...\n"));
  const std::size_t quote = text.find("    1 | ");
  const std::size_t caret = text.find('^') - (text.find('\n', quote) + 1);
  EXPECT_EQ(text.substr(quote + caret, 4), "word");
}

TEST(Render, ALongLineIsNotCutInsideACharacter) {
  std::string line;
  for (int i = 0; i < 200; ++i) line += "\u20ac";
  for (std::uint32_t column = 1; column < 600; ++column) {
    Diagnostics out("a", line);
    out.error("E1", {1, column, 1}, "wrong");
    EXPECT_THAT(render(out), Not(HasSubstr("\\x"))) << column;
  }
}

TEST(Render, ASpanBehindTheEndOfTheLineHasItsCaretThere) {
  Diagnostics out("a", "abc\n");
  out.error("E1", {1, 10, 5}, "wrong");
  EXPECT_THAT(render(out), HasSubstr("    1 | abc\n      |    ^\n"));
}

TEST(Render, ColourMarksSeverityAndCaret) {
  Diagnostics out("a", "abc\n");
  out.error("E1", {1, 1, 3}, "wrong", "write right");
  const std::string text = render(out, true);
  EXPECT_THAT(text, HasSubstr("\x1b[1ma:1:1:\x1b[0m \x1b[1;31merror E1:\x1b[0m wrong\n"));
  EXPECT_THAT(text, HasSubstr("\x1b[1;32m^~~\x1b[0m"));
  EXPECT_THAT(text, HasSubstr("\x1b[36mhint:\x1b[0m write right\n"));
}

TEST(RenderJson, HoldsEverything) {
  Diagnostics out("arm.yaml", "to: gripr\n");
  out.error("E101", {1, 5, 5}, "unknown", "did you mean 'gripper'?");
  const auto json = nlohmann::json::parse(render_json(out));
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0], (nlohmann::json{{"severity", "error"},
                                     {"code", "E101"},
                                     {"file", "arm.yaml"},
                                     {"line", 1},
                                     {"column", 5},
                                     {"length", 5},
                                     {"message", "unknown"},
                                     {"hint", "did you mean 'gripper'?"}}));
}

TEST(RenderJson, SurvivesTextThatIsNotUtf8) {
  Diagnostics out("a", "x");
  out.warning("W1", {1, 1, 1}, "byte \xff");
  EXPECT_EQ(nlohmann::json::parse(render_json(out))[0]["severity"], "warning");
}

}  // namespace
}  // namespace tessera::diagnostics
