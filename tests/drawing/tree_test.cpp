#include <gtest/gtest.h>

#include "drawing/drawing.hpp"
#include "layers/models.hpp"

namespace tessera::drawing {
namespace {

TEST(Tree, ShowsPagesWithTheirSizes) {
  EXPECT_EQ(tree(test::build(test::line_follower()).pages),
            "system  2 places, 2 transitions\n"
            "└─ robot  2 places, 2 transitions\n"
            "   ├─ control  2 places, 3 transitions\n"
            "   │  ├─ init  3 places, 6 transitions\n"
            "   │  │  ├─ snd  3 places + 2 fused, 3 transitions\n"
            "   │  │  └─ rcv  3 places + 1 fused, 2 transitions\n"
            "   │  └─ follow  3 places, 6 transitions\n"
            "   │     ├─ snd  3 places + 2 fused, 3 transitions\n"
            "   │     └─ rcv  3 places + 1 fused, 2 transitions\n"
            "   ├─ sensor  2 places, 2 transitions\n"
            "   │  └─ watch  3 places, 6 transitions\n"
            "   │     ├─ snd  3 places + 1 fused, 2 transitions\n"
            "   │     └─ rcv  2 places, 1 transition\n"
            "   └─ motor  2 places, 2 transitions\n"
            "      └─ drive  3 places, 6 transitions\n"
            "         ├─ snd  2 places, 1 transition\n"
            "         └─ rcv  3 places + 2 fused, 3 transitions\n");
}

TEST(Tree, StopsAtTheLevelAskedFor) {
  EXPECT_EQ(tree(test::build(test::fleet(2)).pages, {.levels = 1}),
            "system  2 places, 2 transitions\n"
            "├─ robot[0]  2 places, 2 transitions\n"
            "└─ robot[1]  2 places, 2 transitions\n");
}

TEST(Tree, IsColouredOnRequest) {
  EXPECT_EQ(tree(test::build(test::line_follower()).pages, {.colour = true, .levels = 0}),
            "system  \033[2m2 places, 2 transitions\033[0m\n");
}

TEST(Tree, OfNoPagesIsEmpty) { EXPECT_EQ(tree({}), ""); }

}  // namespace
}  // namespace tessera::drawing
