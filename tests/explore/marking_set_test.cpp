#include "explore/marking_set.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace tessera::explore {
namespace {

TEST(MarkingSet, KeepsOrderAndFindsWhatItHolds) {
  MarkingSet<2> set;
  std::map<Packed<2>, Index> expected;
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100'000; ++trial) {
    const Packed<2> words{random() % 97, random() % 499};
    set.reserve(1);
    const auto [index, fresh] = set.insert(words, MarkingSet<2>::hash(words));
    const auto [known, unknown_yet] = expected.try_emplace(words, static_cast<Index>(expected.size()));
    ASSERT_EQ(fresh, unknown_yet);
    ASSERT_EQ(index, known->second);
  }
  ASSERT_EQ(set.size(), expected.size());
  for (const auto& [words, index] : expected) {
    EXPECT_EQ(set[index], words);
    EXPECT_EQ(set.find(words, MarkingSet<2>::hash(words)), index);
  }
  const Packed<2> absent{1000, 1000};
  EXPECT_FALSE(set.find(absent, MarkingSet<2>::hash(absent)));
}

TEST(MarkingSet, TakesAtMostSevenBytesBesideTheMarkingOnceItIsLarge) {
  MarkingSet<1> set;
  for (Word word = 0; word < 200'000; ++word) {
    const Packed<1> words{word};
    set.reserve(1);
    set.insert(words, MarkingSet<1>::hash(words));
    if (word > 20'000) {
      ASSERT_LE(static_cast<double>(set.bytes()), 15.3 * static_cast<double>(word)) << word;
    }
  }
}

TEST(MarkingSet, ForeseesItsMemory) {
  MarkingSet<1> set;
  for (Word word = 0; word < 10'000; ++word) {
    const std::size_t foreseen = set.bytes_after(1);
    const Packed<1> words{word * 0x100000001U};
    set.reserve(1);
    set.insert(words, MarkingSet<1>::hash(words));
    ASSERT_EQ(set.bytes(), foreseen);
  }
}

}  // namespace
}  // namespace tessera::explore
