#include <gtest/gtest.h>

#include <vector>

#include "eye/control.hpp"
#include "eye/picture.hpp"

namespace sorting_cell {
namespace {

class Picture : public ::testing::Test {
 protected:
  /// A square of 7 pixels around a pixel.
  void draw(std::size_t row, std::size_t column, std::uint8_t red, std::uint8_t green) {
    for (std::size_t r = row - 3; r <= row + 3; ++r)
      for (std::size_t c = column - 3; c <= column + 3; ++c) {
        rgb[3 * (r * picture_width + c)] = red;
        rgb[3 * (r * picture_width + c) + 1] = green;
      }
  }
  std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(3 * picture_width * picture_height, 40);
};

TEST_F(Picture, OfAnEmptyBeltHasNothing) { EXPECT_FALSE(middle_of_picture(rgb).occupied); }

TEST_F(Picture, OfABoxTellsColourAndPlace) {
  draw(20, 32, 200, 30);
  const Sight sight = middle_of_picture(rgb);
  EXPECT_TRUE(sight.occupied);
  EXPECT_TRUE(sight.red);
  EXPECT_NEAR(sight.across_m, 3.5 * 0.00703, 0.0005);
  draw(20, 32, 30, 200);
  EXPECT_FALSE(middle_of_picture(rgb).red);
}

TEST_F(Picture, OfABoxThatIsNotYetThereOrBesideTheBeltHasNothing) {
  draw(20, 20, 200, 30);
  EXPECT_FALSE(middle_of_picture(rgb).occupied);
  draw(8, 32, 200, 30);  // in the air, on the arm
  EXPECT_FALSE(middle_of_picture(rgb).occupied);
}

TEST(Eye, TellsEachBoxOnce) {
  const eye::control::Parameters parameters;
  eye::control::Context context(parameters);
  eye::control::Inputs in;
  eye::control::Memory memory;
  eye::control::Outputs out;
  const auto see = [&](bool occupied) {
    in.reading = Reading{occupied, true, 0.01};
    watch(context, in, memory, out);
    return memory.is_new;
  };
  EXPECT_FALSE(see(false));
  EXPECT_TRUE(see(true));
  EXPECT_FALSE(see(true));
  EXPECT_FALSE(see(false));
  EXPECT_TRUE(see(true));
  EXPECT_EQ(static_cast<const Order&>(out.order).number, 2U);
}

}  // namespace
}  // namespace sorting_cell
