#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/paths.hpp"
#include "sim/track.hpp"

namespace tessera::report {

/// A check or measure of the run over time.
struct JudgedCurve {
  std::string name;
  bool is_check = false;
  bool is_truth = false;           ///< 1 or 0: whether the formula held
  std::optional<double> limit;     ///< of a check that compares
  std::string unit;                ///< of a measure: "m/s"; empty: none, or not known
  std::string verdict, detail;     ///< of a check: "held", "failed", "open"; what was seen then
  std::string text;                ///< of a check: what it demands
  std::optional<double> failed_s;  ///< when
  double every_s = 0.04;           ///< length of a span
  std::vector<std::optional<std::pair<double, double>>> spans;  ///< the least and the greatest value in each
};

/// An <svg> element: the curve, the limit, and the moment at which the check failed.
[[nodiscard]] std::string curve_svg(const JudgedCurve& curve, double end_s);

/// An <svg> element: the paths from above with the names of the robots, over the floor if there is one.
[[nodiscard]] std::string paths_svg(const std::vector<RobotPath>& robots, const sim::Track* floor);
/// Which colour is which robot, as HTML. Robots that stay in place are only named.
[[nodiscard]] std::string paths_legend(const std::vector<RobotPath>& robots);

}  // namespace tessera::report
