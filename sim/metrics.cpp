#include <algorithm>
#include <cmath>

#include "sim/judging/way_along_line.hpp"

namespace tessera::sim {
namespace {

void measure_losses(const Trace& trace, LineMetrics& metrics) {
  double loss = 0;
  for (std::size_t i = 0; i + 1 < trace.points.size(); ++i) {
    loss = trace.points[i].on_line ? 0 : loss + trace.points[i + 1].t_s - trace.points[i].t_s;
    if (!trace.points[i].on_line) metrics.line_lost_s += trace.points[i + 1].t_s - trace.points[i].t_s;
    metrics.longest_loss_s = std::max(metrics.longest_loss_s, loss);
  }
}

}  // namespace

LineMetrics measure(const Skeleton& line, const Trace& trace) {
  LineMetrics metrics;
  measure_losses(trace, metrics);
  if (line.points.size() < 2 || trace.points.empty()) return metrics;
  WayAlongLine follow(line);
  double sum = 0;
  for (const TracePoint& point : trace.points) {
    const LineFoot foot = follow.next({point.eye_x_m, point.eye_y_m});
    metrics.error_m.push_back(foot.left_m);
    sum += std::abs(foot.left_m);
    metrics.max_error_m = std::max(metrics.max_error_m, std::abs(foot.left_m));
  }
  metrics.mean_error_m = sum / static_cast<double>(trace.points.size());
  metrics.laps = std::abs(follow.progress_m()) / follow.length_m();
  if (follow.progress_m() < 0) {
    for (double& error : metrics.error_m) error = -error;
  }
  return metrics;
}

}  // namespace tessera::sim
