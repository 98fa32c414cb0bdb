#include "report/charts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "report/colours.hpp"
#include "report/picture.hpp"
#include "report/text.hpp"

namespace tessera::report {
namespace {

constexpr double width = 1000, left = 64, right = 12;
constexpr std::size_t columns = 900;

/// 1, 2 or 5 times a power of ten, so that `range` has at most `most` steps.
double tick_step(double range, double most) {
  const double raw = std::max(range, 1e-9) / most;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

/// Time along x.
class TimeAxis {
 public:
  explicit TimeAxis(double end_s) : end_s_(std::max(end_s, 1e-3)) {}
  [[nodiscard]] double x(double t_s) const { return left + t_s / end_s_ * (width - left - right); }
  void draw(std::string& svg, double top, double bottom) const {
    const double step = tick_step(end_s_, 12);
    for (int i = 0; i * step <= end_s_ * (1 + 1e-9); ++i) {
      put(svg, R"(<line class="grid" x1="{0:.1f}" y1="{1:.1f}" x2="{0:.1f}" y2="{2:.1f}"/>)", x(i * step),
          top, bottom);
      const bool at_the_edge = x(i * step) > width - right - 18;
      put(svg, R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="{}">{:g}{}</text>)",
          at_the_edge ? width : x(i * step), bottom + 17, at_the_edge ? "end" : "middle", i * step,
          i == 0 ? " s" : "");
    }
  }

 private:
  double end_s_;
};

std::string svg_head(double w, double h, std::string_view label) {
  return fmt::format(R"(<svg viewBox="0 0 {:.4g} {:.4g}" role="img" aria-label="{}">)", w, h, label);
}

/// Stretches of time without any sensor over the line.
void draw_losses(std::string& svg, const sim::Trace& trace, const TimeAxis& axis, double top, double bottom) {
  const auto& p = trace.points;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i].on_line) continue;
    const std::size_t from = i;
    while (i + 1 < p.size() && !p[i + 1].on_line) ++i;
    const double x = axis.x(p[from].t_s);
    put(svg,
        R"(<rect class="lost" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"><title>line lost for {:.2f} s</title></rect>)",
        x, top, std::max(0.8, axis.x(p[i].t_s) - x), bottom - top, p[i].t_s - p[from].t_s);
  }
}

/// The curve, thinned so that every column keeps its lowest and highest value.
std::string error_curve(const DrivenPath& drive, const TimeAxis& axis, double middle, double per_metre) {
  const auto& errors = drive.metrics.error_m;
  const std::size_t per_column = std::max<std::size_t>(1, errors.size() / columns);
  std::string points;
  const auto add = [&](std::size_t i) {
    put(points, "{:.1f},{:.1f} ", axis.x(drive.trace.points[i].t_s), middle - errors[i] * per_metre);
  };
  for (std::size_t i = 0; i < errors.size(); i += per_column) {
    const auto first = errors.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last = errors.begin() + static_cast<std::ptrdiff_t>(std::min(i + per_column, errors.size()));
    const auto [low, high] = std::minmax_element(first, last);
    const auto a = static_cast<std::size_t>(low - errors.begin());
    const auto b = static_cast<std::size_t>(high - errors.begin());
    add(std::min(a, b));
    if (a != b) add(std::max(a, b));
  }
  return points;
}

/// Consecutive pieces of one colour become one polyline.
void draw_path(std::string& svg, const DrivenPath& drive, double height) {
  constexpr double levels = 15;
  const PathColours colours = path_colours(drive);
  const auto& points = drive.trace.points;
  const auto chosen = evenly_spaced_indices(points.size(), 4000);
  const auto level = [&](std::size_t i) { return std::round(colours.share[chosen[i]] * levels); };
  for (std::size_t i = 1; i < chosen.size();) {
    const double now = level(i);
    put(svg, R"(<polyline stroke="{}" points=")", css_colour(heat_colour(now / levels)));
    const auto add = [&](std::size_t k) {
      put(svg, "{:.3f},{:.3f} ", points[chosen[k]].eye_x_m, height - points[chosen[k]].eye_y_m);
    };
    for (add(i - 1); i < chosen.size() && level(i) == now; ++i) add(i);
    svg += R"("/>)";
  }
}

void draw_robot(std::string& svg, const sim::TracePoint& at, double height) {
  put(svg,
      R"svg(<g class="robot" transform="translate({:.3f} {:.3f}) rotate({:.2f})"><rect x="-.03" y="-.088" width=".06" height=".016"/>)svg"
      R"(<rect x="-.03" y=".072" width=".06" height=".016"/><circle r=".065"/><path d="M0 0H{:.3f}"/><title>the robot at the end</title></g>)",
      at.x_m, height - at.y_m, -at.heading_rad * 180 / M_PI,
      std::hypot(at.eye_x_m - at.x_m, at.eye_y_m - at.y_m));
}

}  // namespace

std::string path_svg(const DrivenPath& drive) {
  const double w = drive.floor.width_m();
  const double h = drive.floor.height_m();
  std::string svg = svg_head(w, h, "The path of the robot over the floor");
  put(svg, R"(<image href="{}" width="{:.4f}" height="{:.4f}" preserveAspectRatio="none"/>)",
      data_uri("image/png", floor_png(drive.floor)), w, h);
  if (!drive.line.points.empty()) {
    svg += drive.line.closed ? R"(<polygon class="middle" points=")" : R"(<polyline class="middle" points=")";
    for (const std::size_t i : evenly_spaced_indices(drive.line.points.size(), 1000))
      put(svg, "{:.3f},{:.3f} ", drive.line.points[i].x_m, h - drive.line.points[i].y_m);
    svg += R"("/>)";
  }
  if (!drive.trace.points.empty()) {
    svg += R"(<g class="path">)";
    draw_path(svg, drive, h);
    const auto& first = drive.trace.points.front();
    put(svg, R"(</g><circle class="start" cx="{:.3f}" cy="{:.3f}" r=".016"><title>start</title></circle>)",
        first.eye_x_m, h - first.eye_y_m);
    draw_robot(svg, drive.trace.points.back(), h);
  }
  return svg + "</svg>";
}

std::string error_svg(const DrivenPath& drive) {
  constexpr double top = 10, bottom = 190;
  const TimeAxis axis(drive.trace.points.back().t_s);
  const double reach_mm = std::max(10.0, std::ceil(drive.metrics.max_error_m * 1000 / 10) * 10);
  const double middle = (top + bottom) / 2;
  const double per_metre = (bottom - top) / 2 / reach_mm * 1000;
  std::string svg = svg_head(width, bottom + 26, "Lateral error over time");
  axis.draw(svg, top, bottom);
  const double step = tick_step(2 * reach_mm, 6);
  for (double mm = -std::floor(reach_mm / step) * step; mm <= reach_mm; mm += step) {
    const double y = middle - mm * per_metre / 1000;
    put(svg, R"(<line class="{}" x1="{}" y1="{:.1f}" x2="{}" y2="{:.1f}"/>)",
        std::abs(mm) < 1e-9 ? "zero" : "grid", left, y, width - right, y);
    put(svg, R"(<text class="tick" x="{}" y="{:.1f}" text-anchor="end">{:g} mm</text>)", left - 8, y + 4,
        std::abs(mm) < 1e-9 ? 0 : mm);
  }
  draw_losses(svg, drive.trace, axis, top, bottom);
  put(svg, R"(<polyline class="curve" points="{}"/></svg>)", error_curve(drive, axis, middle, per_metre));
  return svg;
}

namespace {

constexpr double letter = 7.6, key_row = 18, bar = 22;

/// The names of a lane's behaviours with their colours, in rows that fit beside and below its path.
class LaneKey {
 public:
  explicit LaneKey(const replay::Lane& lane) {
    double x = left + letter * static_cast<double>(lane.path.size()) + 30;
    for (std::size_t index = 0; index < lane.behaviours.size(); ++index) {
      const std::string name = shortened(lane.behaviours[index], 40, 1);
      const double needed = letter * static_cast<double>(name.size()) + 27;
      if (x + needed > width - right) {
        if (rows_ == most_rows) break;
        ++rows_;
        x = left;
      }
      names_.push_back({x, rows_, index, name});
      x += needed;
    }
    if (names_.size() < lane.behaviours.size() && !names_.empty()) names_.back().name += " \u2026";
  }
  [[nodiscard]] double height() const { return key_row * static_cast<double>(rows_); }
  void draw(std::string& svg, double top) const {
    for (const Name& name : names_) {
      const double y = top + key_row * static_cast<double>(name.row);
      put(svg, R"(<rect class="b{}" x="{:.1f}" y="{:.1f}" width="10" height="10" rx="2"/>)",
          name.behaviour % 8, name.x, y - 9);
      put(svg, R"(<text class="key" x="{:.1f}" y="{:.1f}">{}</text>)", name.x + 15, y, escaped(name.name));
    }
  }

 private:
  static constexpr std::size_t most_rows = 4;  // beside the first
  struct Name {
    double x;
    std::size_t row, behaviour;
    std::string name;
  };
  std::size_t rows_ = 0;
  std::vector<Name> names_;
};

void draw_lane(std::string& svg, const replay::Lane& lane, const TimeAxis& axis, double end_s, double top) {
  for (const auto& [behaviour, from_s, to_s] : replay::thinned(lane, end_s, columns)) {
    put(svg,
        R"(<rect class="b{}" x="{:.2f}" y="{:.1f}" width="{:.2f}" height="{}"><title>{} {:.2f} .. {:.2f} s</title></rect>)",
        behaviour % 8, axis.x(from_s), top, std::max(0.6, axis.x(to_s) - axis.x(from_s)), bar,
        escaped(lane.behaviours[behaviour]), from_s, to_s);
  }
  for (const std::size_t i : evenly_spaced_indices(lane.errors_s.size(), columns)) {
    put(svg, R"(<line class="error" x1="{0:.1f}" y1="{1:.1f}" x2="{0:.1f}" y2="{2:.1f}"/>)",
        axis.x(lane.errors_s[i]), top - 4, top + 4 + bar);
  }
}

}  // namespace

std::string timeline_svg(const replay::Timeline& timeline) {
  constexpr double above = 18, to_bar = 8, below = 10;
  std::vector<LaneKey> keys;
  double bottom = 0;
  for (const replay::Lane& lane : timeline.lanes) {
    keys.emplace_back(lane);
    bottom += above + keys.back().height() + to_bar + bar + below;
  }
  const TimeAxis axis(timeline.end_s);
  std::string svg = svg_head(width, bottom + 30, "Behaviours of each subsystem over time");
  axis.draw(svg, 4, bottom + 4);
  double top = 0;
  for (std::size_t index = 0; index < keys.size(); ++index) {
    const replay::Lane& lane = timeline.lanes[index];
    put(svg, R"(<text class="lane" x="{}" y="{:.1f}">{}</text>)", left, top + above, escaped(lane.path));
    keys[index].draw(svg, top + above);
    top += above + keys[index].height() + to_bar;
    draw_lane(svg, lane, axis, timeline.end_s, top);
    top += bar + below;
  }
  return svg + "</svg>";
}

}  // namespace tessera::report
