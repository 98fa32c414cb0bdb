// The times that the calls of a behaviour take, and the amounts that it uses.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/time_points.hpp"

namespace tessera::spec {

using Duration = std::chrono::nanoseconds;
using diagnostics::Span;

/// How long a transition function takes, its devices included. Both 0: the specification does not say it.
struct Takes {
  Duration shortest{0}, longest{0};
  /// The distribution of the times that simulated runs draw; empty: all between the two are equally likely.
  TimePoints points{};
  /// The times come from the calls in a recording: read_measured_times (src/project) finds the points.
  struct Measured {
    std::string recording;  ///< as written: relative to the folder of the specification
    Span span;
    bool says_within = true;  ///< otherwise the two times mean nothing
    /// Wherever it is written.
    bool operator==(const Measured& other) const {
      return recording == other.recording && says_within == other.says_within;
    }
  };
  std::optional<Measured> measured{};

  [[nodiscard]] bool is_declared() const { return longest > Duration{0}; }
  bool operator==(const Takes&) const = default;
};

/// An amount per time that a behaviour uses while it is the present one: `uses: { energy: 12 W }`.
struct ResourceUse {
  std::string resource;   ///< "energy"
  std::string unit;       ///< of the amount: "J"
  double per_second = 0;  ///< in this unit
  Span span;
  /// Wherever it is written.
  bool operator==(const ResourceUse& other) const {
    return resource == other.resource && unit == other.unit && per_second == other.per_second;
  }
};

/// Something that behaviours use: "energy", in "J".
struct Resource {
  std::string name, unit;
};

struct Model;
/// In the order in which behaviours name them first.
[[nodiscard]] std::vector<Resource> resources_of(const Model& model);

}  // namespace tessera::spec
