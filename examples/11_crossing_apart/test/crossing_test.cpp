#include <gtest/gtest.h>

#include "crossing/control.hpp"

namespace crossroads::crossing::control {
namespace {

TEST(Crossing, GrantsTheNumberThatWasAskedForAndRemembersWho) {
  const Parameters parameters;
  Context context(parameters);
  Inputs in;
  Memory memory;
  Outputs out;
  in.request_0 = 7;
  in.request_1 = 3;
  lend_0(context, in, memory, out);
  EXPECT_EQ(out.grant_0, 7U);
  EXPECT_EQ(memory.last, 0U);
  lend_1(context, in, memory, out);
  EXPECT_EQ(out.grant_1, 3U);
  EXPECT_EQ(memory.last, 1U);
}

}  // namespace
}  // namespace crossroads::crossing::control
