#include "statistics/clopper_pearson.hpp"

#include <cmath>
#include <limits>

namespace tessera::statistics {
namespace {

/// The continued fraction of the incomplete beta function, by Lentz's method. It converges fast left of the
/// mean, in about sqrt(max(a, b)) steps.
double beta_fraction(double x, double a, double b) {
  constexpr int most_steps = 1'000'000;
  constexpr double least = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
  const auto away_from_zero = [](double value) { return std::abs(value) < least ? least : value; };
  double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int step = 1; step <= most_steps; ++step) {
    const double m = step;
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away_from_zero(1 + even * d);
    c = away_from_zero(1 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away_from_zero(1 + odd * d);
    c = away_from_zero(1 + odd / c);
    fraction *= d * c;
    if (std::abs(d * c - 1) < std::numeric_limits<double>::epsilon()) break;
  }
  return fraction;
}

/// The x at which I_x(a, b) is `wanted`.
double inverse_incomplete_beta(double wanted, double a, double b) {
  double low = 0, high = 1;
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high || high - low < 1e-18) return middle;
    (incomplete_beta(middle, a, b) < wanted ? low : high) = middle;
  }
}

}  // namespace

double incomplete_beta(double x, double a, double b) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double factor =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return factor * beta_fraction(x, a, b) / a;
  return 1 - factor * beta_fraction(1 - x, b, a) / b;
}

Interval clopper_pearson(std::uint64_t events, std::uint64_t runs, double confidence) {
  if (runs == 0) return {};
  const double outside = (1 - confidence) / 2;  // on each side
  const auto happened = static_cast<double>(events), did_not = static_cast<double>(runs - events);
  return {.low = events == 0 ? 0 : inverse_incomplete_beta(outside, happened, did_not + 1),
          .high = events == runs ? 1 : inverse_incomplete_beta(1 - outside, happened + 1, did_not)};
}

}  // namespace tessera::statistics
