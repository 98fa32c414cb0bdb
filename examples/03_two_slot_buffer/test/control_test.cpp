#include "watcher/control.hpp"

#include <gtest/gtest.h>

namespace two_slot_buffer::watcher::control {
namespace {

Inputs picture(std::uint32_t number) {
  Inputs in;
  in.picture = Picture{number, 0.5};
  in.picture.fresh = true;
  return in;
}

TEST(Look, CountsAPictureThatWasSkipped) {
  const Parameters parameters;
  Context context(parameters);
  Memory memory;
  Outputs out;
  for (const std::uint32_t number : {1U, 2U, 4U, 5U}) look(context, picture(number), memory, out);
  EXPECT_EQ(memory.last, 5U);
  EXPECT_EQ(memory.missed, 1U);
}

TEST(Look, WaitsForTheFirstPicture) {
  const Parameters parameters;
  Context context(parameters);
  Memory memory;
  Outputs out;
  look(context, Inputs{}, memory, out);
  EXPECT_EQ(memory.missed, 0U);
}

}  // namespace
}  // namespace two_slot_buffer::watcher::control
