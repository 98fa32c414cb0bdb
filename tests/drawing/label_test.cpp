#include "drawing/label.hpp"

#include <gmock/gmock.h>

namespace tessera::drawing {
namespace {

using testing::ElementsAre;

TEST(Label, IsAsWideAsItsRuns) {
  EXPECT_GT(width_of("mm", 10), width_of("ii", 10));
  EXPECT_DOUBLE_EQ(width_of("ab", 20), 2 * width_of("ab", 10));
  EXPECT_LT(width_of(Label().add("ab", Label::Level::raised), 10), width_of(Label("ab"), 10));
  EXPECT_DOUBLE_EQ(width_of("\u00e9", 10), width_of("\u00e8", 10)) << "a character counts once";
}

TEST(Label, WrapsAtSpaces) {
  EXPECT_THAT(wrapped("terminal: a && b", 12, 3), ElementsAre("terminal: a", "&& b"));
  EXPECT_THAT(wrapped("short", 12, 3), ElementsAre("short"));
  EXPECT_THAT(wrapped("", 12, 3), ElementsAre());
}

TEST(Label, CutsWhatIsLongerThanItsLines) {
  EXPECT_THAT(wrapped("aa bb cc dd", 3, 2), ElementsAre("aa", "bb\u2026"));
  EXPECT_THAT(wrapped("abcdefghij", 4, 3), ElementsAre("abcd", "efgh", "ij"));
}

TEST(Label, NeverCutsACharacterInTwo) {
  EXPECT_THAT(wrapped("\u00e9\u00e9\u00e9", 3, 5), ElementsAre("\u00e9\u00e9", "\u00e9"));
}

}  // namespace
}  // namespace tessera::drawing
