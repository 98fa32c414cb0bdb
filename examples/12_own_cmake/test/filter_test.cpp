#include "filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

TEST(Filter, IsCloserThanWhatItIsGiven) {
  std::array<double, 2> state{3, 0};
  std::array<double, 4> covariance{4, 0, 0, 1};
  approach::Filter filter(state, covariance);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.05);
  double of_filter = 0, of_sensor = 0, distance = 3;
  for (int step = 0; step < 300; ++step) {
    distance -= 0.4 * 0.02;
    const double measured = distance + noise(random);
    filter.predict(0.02, 2);
    filter.correct(measured, 0.05);
    of_filter += std::abs(state[0] - distance);
    of_sensor += std::abs(measured - distance);
  }
  EXPECT_LT(of_filter, 0.6 * of_sensor);
  EXPECT_NEAR(state[1], -0.4, 0.2);
}
