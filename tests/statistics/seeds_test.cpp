#include "statistics/seeds.hpp"

#include <gtest/gtest.h>

namespace tessera::statistics {
namespace {

TEST(Part, IsReadOrRefused) {
  EXPECT_EQ(parse_part("3/20"), (Part{3, 20}));
  EXPECT_EQ(parse_part("1/1"), (Part{1, 1}));
  for (const char* wrong : {"", "3", "/", "0/20", "21/20", "-1/20", "3/0", "3/20/4", "a/b", "3 /20", "3/20 ",
                            "1/99999999999999999999999"})
    EXPECT_FALSE(parse_part(wrong)) << wrong;
}

TEST(Part, AllPartsAreTheWholeAndOfEqualSize) {
  for (const Seeds whole : {Seeds{1, 1001}, Seeds{7, 8}, Seeds{5, 5}, Seeds{UINT64_MAX - 100, UINT64_MAX}})
    for (const std::uint64_t parts : {1ULL, 3ULL, 7ULL, 20ULL, 5000ULL}) {
      std::uint64_t next = whole.begin, least = UINT64_MAX, most = 0;
      for (std::uint64_t number = 1; number <= parts; ++number) {
        const Seeds part = seeds_of({number, parts}, whole);
        ASSERT_EQ(part.begin, next);
        next = part.end;
        least = std::min(least, part.count());
        most = std::max(most, part.count());
      }
      EXPECT_EQ(next, whole.end);
      EXPECT_LE(most - least, 1u);
    }
}

TEST(Part, OfMoreSeedsThanSixtyFourBitProductsHold) {
  const Seeds whole{0, UINT64_MAX};
  EXPECT_EQ(seeds_of({1'000'000, 1'000'000}, whole).end, UINT64_MAX);
  EXPECT_EQ(seeds_of({500'001, 1'000'000}, whole).begin, UINT64_MAX / 2);
}

TEST(Seeds, JoinOverlapAndLack) {
  EXPECT_EQ(joined({{5, 7}, {1, 3}, {3, 5}, {9, 9}, {8, 10}}), (std::vector<Seeds>{{1, 7}, {8, 10}}));
  EXPECT_FALSE(overlap_of({{1, 3}, {3, 5}, {2, 2}}));
  EXPECT_EQ(overlap_of({{4, 9}, {1, 5}}), (Seeds{4, 5}));
  EXPECT_EQ(missing_in({{3, 5}, {7, 9}}, {1, 10}), (std::vector<Seeds>{{1, 3}, {5, 7}, {9, 10}}));
  EXPECT_TRUE(missing_in({{1, 10}}, {1, 10}).empty());
  EXPECT_EQ(missing_in({}, {1, 10}), (std::vector<Seeds>{{1, 10}}));
  EXPECT_EQ(text_of({7, 8}), "seed 7");
  EXPECT_EQ(text_of({7, 10}), "seeds 7 to 9");
}

}  // namespace
}  // namespace tessera::statistics
