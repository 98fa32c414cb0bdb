#include "checks/curve.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::checks {
namespace {

void include(Curve::Span& span, const Curve::Span& other) {
  if (!other.known) return;
  span.least = span.known ? std::min(span.least, other.least) : other.least;
  span.greatest = span.known ? std::max(span.greatest, other.greatest) : other.greatest;
  span.known = true;
}

}  // namespace

void Curve::add(double time_s, double value) {
  if (!std::isfinite(value) || !std::isfinite(time_s) || time_s < 0) return;
  // A time at the edge of two spans belongs to the later one, however it was rounded.
  const auto number = [&] { return std::floor(time_s / every_s_ + 1e-6); };
  while (number() >= static_cast<double>(most)) {
    for (std::size_t index = 0; 2 * index < spans_.size(); ++index) {
      Span both = spans_[2 * index];
      if (2 * index + 1 < spans_.size()) include(both, spans_[2 * index + 1]);
      spans_[index] = both;
    }
    spans_.resize((spans_.size() + 1) / 2);
    every_s_ *= 2;
  }
  const auto index = static_cast<std::size_t>(number());
  if (spans_.size() <= index) spans_.resize(index + 1);
  include(spans_[index], {value, value, true});
}

}  // namespace tessera::checks
