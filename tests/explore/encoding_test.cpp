#include "explore/encoding.hpp"

#include <gtest/gtest.h>

#include <set>

#include "formula_oracle.hpp"
#include "small_nets.hpp"

namespace tessera::explore {
namespace {

TEST(Encoding, AUnitTakesTheBitsOfOneNumber) {
  const PtNet net(ring_of(8, 1));
  const Encoding encoding = Growth(net).encoding();
  ASSERT_EQ(encoding.fields().size(), 1U);
  EXPECT_EQ(encoding.fields()[0].width, 3U);
  EXPECT_TRUE(encoding.proves_safe());
}

TEST(Encoding, AnOutgrownPlaceIsNamed) {
  const PtNet net(spring());
  const Encoding encoding = Growth(net).encoding();
  std::vector<Word> words(encoding.words(), 0);
  EXPECT_FALSE(encoding.encode(Marking{1}, words));
  EXPECT_EQ(encoding.encode(Marking{2}, words), 0U);
}

TEST(Encoding, WidensUpToWhatTokensHold) {
  const PtNet net(spring());
  Growth growth(net);
  while (growth.widen(0)) continue;
  const Encoding encoding = growth.encoding();
  std::vector<Word> words(encoding.words(), 0);
  EXPECT_FALSE(encoding.encode(Marking{4294967295U}, words));
  EXPECT_EQ(encoding.tokens(0, words), 4294967295U);
}

TEST(Encoding, FieldsStayWithinTheirWordAndApart) {
  oracle::Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<net::Net> parts;
    const PtNet net(trial % 2 == 0 ? random_machines(random) : random_wild(random));
    const Encoding encoding = Growth(net).encoding();
    std::vector<Word> used(encoding.words(), 0);
    for (const Field& field : encoding.fields()) {
      ASSERT_LE(field.shift + field.width, 64U);
      EXPECT_EQ(used[field.word] & field.mask(), 0U);
      used[field.word] |= field.mask();
    }
  }
}

TEST(Encoding, DecodesWhatItEncodedAndTellsMarkingsApart) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    oracle::Random random(seed);
    const net::Net net = seed % 2 == 0 ? random_machines(random) : random_weighted(random);
    const auto graph = naive_graph(net, 200);
    if (!graph) continue;
    const PtNet compiled(net);
    const Encoding encoding = Growth(compiled).encoding();
    std::set<std::vector<Word>> codes;
    std::size_t fitting = 0;
    for (std::size_t index = 0; index < graph->size(); ++index) {
      std::vector<Word> words(encoding.words(), 0);
      if (encoding.encode(graph->marking(index), words)) continue;
      ++fitting;
      codes.insert(words);
      Marking decoded(compiled.places());
      encoding.decode(words, decoded);
      EXPECT_EQ(decoded, graph->marking(index));
    }
    EXPECT_EQ(codes.size(), fitting);
    EXPECT_GT(fitting, 0U);
  }
}

}  // namespace
}  // namespace tessera::explore
