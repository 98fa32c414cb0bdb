#include "read_trace.hpp"

#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>

namespace tessera::sim {
namespace {

/// Removes the number up to the next comma from `line`.
bool take(std::string_view& line, double& value) {
  const auto [end, status] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (status != std::errc{}) return false;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  if (line.empty()) return true;
  if (line.front() != ',') return false;
  line.remove_prefix(1);
  return true;
}

std::optional<TracePoint> parse_point(std::string_view line) {
  TracePoint p;
  double on_line = 0;
  for (double* value : {&p.t_s, &p.x_m, &p.y_m, &p.heading_rad, &p.eye_x_m, &p.eye_y_m, &on_line}) {
    if (!take(line, *value)) return std::nullopt;
  }
  if (!line.empty()) return std::nullopt;
  p.on_line = on_line != 0;
  return p;
}

}  // namespace

Result<Trace> read_trace(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file) return Problem{path + ": cannot be read"};
  Trace trace;
  std::size_t number = 1;
  std::getline(file, line);
  if (line.starts_with(several_robots)) {
    trace.robots = line.substr(several_robots.size());
    std::getline(file, line);
    ++number;
  }
  if (!file || line != trace_columns)
    return Problem{path + ": no trace (its first line is not \"" + std::string(trace_columns) + "\")"};
  while (std::getline(file, line)) {
    ++number;
    const auto point = parse_point(line);
    if (!point) return Problem{path + ":" + std::to_string(number) + ": not seven numbers"};
    trace.points.push_back(*point);
  }
  return trace;
}

}  // namespace tessera::sim
