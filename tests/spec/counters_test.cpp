#include <gtest/gtest.h>

#include <string>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

/// A counter 0..2, and the entries of `next` of its only behaviour.
std::string counting(const std::string& entries) {
  return "tessera: 1\nsystem: demo\nagents:\n  dock:\n    control:\n      rate: 10 Hz\n"
         "      memory: { n: { counts: 0..2 } }\n      behaviours:\n        count:\n          terminal: "
         "true\n"
         "          next: [" +
         entries + "]\n";
}

TEST(Counters, WarnOfCountsWithoutAnEntry) {
  const std::string more = "{ to: count, sets: { n: +1 } }";
  for (const char* covered :
       {"{ to: count, when: memory.n == 2, sets: { n: 0 } }, ", "{ to: count, when: 1 < memory.n }, ",
        "{ to: count, when: memory.n > 1 || elapsed > 1 s, sets: { n: -1 } }, "})
    EXPECT_EQ(Reading(counting(covered + more)).codes(), "") << covered;
  EXPECT_EQ(Reading(counting(more + ", count")).codes(), "");
  for (const char* open : {"", "{ to: count, when: memory.n == 1, sets: { n: 0 } }, ",
                           "{ to: count, when: memory.n == 2 && elapsed > 1 s }, "})
    EXPECT_NE(Reading(counting(open + more)).report().find("no entry of 'next' to take: memory.n is 2"),
              std::string::npos)
        << open;
}

}  // namespace
}  // namespace tessera::spec
