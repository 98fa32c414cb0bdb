#pragma once

#include <cstddef>
#include <vector>

namespace tessera::checks {

/// The course of a number over any length of time, in at most `most` spans of equal length, each with the
/// least and the greatest value in it.
class Curve {
 public:
  static constexpr std::size_t most = 256;
  struct Span {
    double least = 0, greatest = 0;
    bool known = false;  ///< there was a value
  };
  /// Times rise. Values that are not finite are left out.
  void add(double time_s, double value);
  /// The length of a span; the first one begins at 0.
  [[nodiscard]] double every_s() const { return every_s_; }
  [[nodiscard]] const std::vector<Span>& spans() const { return spans_; }

 private:
  double every_s_ = 0.04;
  std::vector<Span> spans_;
};

}  // namespace tessera::checks
