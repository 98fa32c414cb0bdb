#pragma once

#include <string>
#include <vector>

#include "report/report.hpp"

namespace tessera::report {

/// The meaning of the colours of a path: seconds, or metres of error.
struct PathColours {
  bool by_error = false;
  double top = 1;             ///< the value of the last colour
  std::vector<double> share;  ///< 0 .. 1 per trace point
};
[[nodiscard]] PathColours path_colours(const DrivenPath& drive);

/// The indices of at most about `count` points, first and last included.
[[nodiscard]] std::vector<std::size_t> evenly_spaced_indices(std::size_t size, std::size_t count);

/// The floor alone, at most 1200 pixels wide, softened so that a path stands out. PNG bytes.
[[nodiscard]] std::string floor_png(const sim::Track& floor);

/// Floor, line, path, start and robot with a legend, about 1600 pixels wide. PNG bytes.
[[nodiscard]] std::string path_png(const DrivenPath& drive, const std::string& title,
                                   const std::string& figures);

}  // namespace tessera::report
