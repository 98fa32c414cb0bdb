#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace tessera {

/// A number of each of many runs: how often it was how large. Two of them can be added, so that machines can share the
/// runs; the order of the runs changes nothing but the last digits of the sums.
class SampleCounts {
 public:
  struct Extreme {
    double value = 0;
    std::uint64_t seed = 0;  ///< the lowest one that has it
  };

  /// Precondition: the value is finite and not negative.
  void add(double value, std::uint64_t seed) {
    add({.count = 1,
         .sum = value,
         .sum_of_squares = value * value,
         .least = {value, seed},
         .greatest = {value, seed},
         .classes = {{class_of(value), 1}}});
  }

  /// The numbers of which it consists, as files hold them.
  struct Parts {
    std::uint64_t count = 0;
    double sum = 0, sum_of_squares = 0;
    Extreme least{}, greatest{};
    std::map<std::int64_t, std::uint64_t> classes{};  ///< samples by class_of
  };
  void add(const Parts& more) {
    if (more.count == 0) return;
    const bool first = parts_.count == 0;
    const auto replaces = [&](const Extreme& by, const Extreme& known, bool beyond) {
      return first || beyond || (by.value == known.value && by.seed < known.seed);
    };
    if (replaces(more.least, parts_.least, more.least.value < parts_.least.value)) parts_.least = more.least;
    if (replaces(more.greatest, parts_.greatest, more.greatest.value > parts_.greatest.value))
      parts_.greatest = more.greatest;
    parts_.count += more.count;
    parts_.sum += more.sum;
    parts_.sum_of_squares += more.sum_of_squares;
    for (const auto& [one, count] : more.classes) parts_.classes[one] += count;
  }
  [[nodiscard]] const Parts& parts() const { return parts_; }

  /// Values that differ by less than 0.2 % may be in one class. Greater values are in greater classes.
  [[nodiscard]] static std::int64_t class_of(double value) {
    if (!(value > 0)) return zero_class;
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);  // 0.5 to 1
    return std::int64_t{exponent} * classes_per_octave +
           static_cast<std::int64_t>((fraction - 0.5) * 2 * classes_per_octave);
  }
  /// The middle of a class.
  [[nodiscard]] static double value_of(std::int64_t one) {
    if (one == zero_class) return 0;
    const std::int64_t part = ((one % classes_per_octave) + classes_per_octave) % classes_per_octave;
    const double fraction = 0.5 + (static_cast<double>(part) + 0.5) / (2 * classes_per_octave);
    return std::ldexp(fraction, static_cast<int>((one - part) / classes_per_octave));
  }

  /// The value of the sample with that number in ascending order, from 1 to count; good to 0.1 %.
  [[nodiscard]] double at_rank(std::uint64_t rank) const {
    for (const auto& [one, count] : parts_.classes) {
      if (rank <= count) return std::clamp(value_of(one), parts_.least.value, parts_.greatest.value);
      rank -= count;
    }
    return parts_.greatest.value;
  }
  [[nodiscard]] double mean() const { return parts_.sum / static_cast<double>(parts_.count); }
  /// The standard deviation of one run. Precondition: count > 1.
  [[nodiscard]] double deviation() const {
    const auto count = static_cast<double>(parts_.count);
    return std::sqrt(std::max(0.0, (parts_.sum_of_squares - parts_.sum * parts_.sum / count) / (count - 1)));
  }

 private:
  static constexpr std::int64_t classes_per_octave = 512;
  static constexpr std::int64_t zero_class = INT64_MIN;

  Parts parts_;
};

}  // namespace tessera
