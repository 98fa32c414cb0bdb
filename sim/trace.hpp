#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tessera::sim {

/// The pose of a simulated robot at one time, and the readings of its light sensors.
struct TracePoint {
  double t_s = 0;
  double x_m = 0, y_m = 0,
         heading_rad = 0;  ///< of the body that carries the sensors; x right, y up in the floor picture
  double eye_x_m = 0, eye_y_m = 0;  ///< of the middle light sensor
  bool on_line = false;             ///< any light sensor over the line
};

/// The path of one robot. The file has comma-separated values, one line per point, after a line of column
/// names "t_s,x_m,y_m,heading_rad,eye_x_m,eye_y_m,on_line". The same run writes the same bytes. If several
/// bodies have devices, there is no single path: the file then has a line "# several robots: NAME, NAME"
/// first, and no points.
struct Trace {
  std::string robots;  ///< "rover, rover_2"; empty: there is only one robot
  std::vector<TracePoint> points;
};

inline constexpr std::string_view trace_columns = "t_s,x_m,y_m,heading_rad,eye_x_m,eye_y_m,on_line";
inline constexpr std::string_view several_robots = "# several robots: ";

}  // namespace tessera::sim
