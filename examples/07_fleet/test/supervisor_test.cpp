#include <gtest/gtest.h>

#include "supervisor/control.hpp"

namespace fleet::supervisor::control {
namespace {

TEST(Supervisor, CallsWithANewNumberAndBeginsToCountAtNothing) {
  const Parameters parameters;
  Context context(parameters);
  Inputs in;
  Memory memory;
  Outputs out;
  rest(context, in, memory, out);
  rest(context, in, memory, out);
  EXPECT_EQ(memory.seconds, 2U);
  out.count = {7, 7};
  call(context, in, memory, out);
  EXPECT_EQ(out.call, 1U);
  EXPECT_EQ(static_cast<const Count&>(out.count), (Count{0, 0}));
  EXPECT_EQ(memory.seconds, 0U);
  call(context, in, memory, out);
  EXPECT_EQ(out.call, 2U);
}

}  // namespace
}  // namespace fleet::supervisor::control
