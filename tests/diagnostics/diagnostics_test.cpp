#include "diagnostics/diagnostics.hpp"

#include <gtest/gtest.h>

namespace tessera::diagnostics {
namespace {

TEST(Diagnostics, CountsOnlyErrors) {
  Diagnostics out("a.yaml", "text\n");
  out.warning("W1", {1, 1, 1}, "careful");
  out.note("N1", {1, 1, 1}, "by the way");
  EXPECT_FALSE(out.has_errors());
  out.error("E1", {1, 1, 1}, "wrong");
  EXPECT_TRUE(out.has_errors());
  EXPECT_EQ(out.error_count(), 1U);
}

TEST(Diagnostics, SortsByLineAndKeepsTheOrderWithinOne) {
  Diagnostics out("a.yaml", "1\n2\n3\n");
  out.error("E3", {3, 1, 1}, "third");
  out.error("E1", {2, 5, 1}, "first of line two");
  out.error("E2", {2, 1, 1}, "second of line two");
  const auto all = out.sorted();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].code, "E1");
  EXPECT_EQ(all[1].code, "E2");
  EXPECT_EQ(all[2].code, "E3");
}

TEST(Diagnostics, KeepsAComplaintMadeTwiceOnceAndCountsItTwice) {
  Diagnostics out("a.yaml", "1\n");
  out.error("E1", {1, 1, 1}, "wrong");
  out.error("E1", {1, 1, 1}, "wrong");
  out.error("E1", {1, 2, 1}, "wrong");
  EXPECT_EQ(out.sorted().size(), 2U);
  EXPECT_EQ(out.error_count(), 3U) << "what is read twice, through an alias, is wrong both times";
}

TEST(Diagnostics, QuotesLinesWithoutTheirEnds) {
  const Diagnostics out("a.yaml", "one\r\ntwo\n\nfour");
  EXPECT_EQ(out.line(1), "one");
  EXPECT_EQ(out.line(2), "two");
  EXPECT_EQ(out.line(3), "");
  EXPECT_EQ(out.line(4), "four");
  EXPECT_EQ(out.line(0), "");
  EXPECT_EQ(out.line(5), "");
}

}  // namespace
}  // namespace tessera::diagnostics
