#pragma once

#include <cstdint>

namespace tessera::statistics {

/// Bounds of a probability, both from 0 to 1.
struct Interval {
  double low = 0, high = 1;
};

inline constexpr double usual_confidence = 0.95;

/// The interval of the probability of an event that happened in `events` of `runs` independent runs. Whatever
/// the probability is, the interval holds it with at least this confidence, which is two-sided: without any
/// event the upper bound alone has (1 + confidence) / 2. Without runs it is 0 to 1.
///
/// Preconditions: events <= runs, 0 < confidence < 1.
/// Source: Clopper and Pearson, Biometrika 26 (1934). Good to nine digits up to a million runs, and to five
///         up to a thousand million.
[[nodiscard]] Interval clopper_pearson(std::uint64_t events, std::uint64_t runs,
                                       double confidence = usual_confidence);

/// The regularized incomplete beta function I_x(a, b). Preconditions: 0 <= x <= 1, a > 0, b > 0.
[[nodiscard]] double incomplete_beta(double x, double a, double b);

}  // namespace tessera::statistics
