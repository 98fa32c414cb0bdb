#include "report/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "report/picture.hpp"
#include "report/text.hpp"

namespace tessera::report {
namespace {

constexpr double plot_width = 480, plot_height = 116, plot_left = 54, plot_right = 10, plot_top = 8,
                 plot_bottom = 94;

/// Sixteen colours that differ clearly on light and on dark backgrounds; then they repeat, dashed.
constexpr std::array<const char*, 16> robot_colours{
    "#1f6fb4", "#d1495b", "#2a9d5c", "#e08b1a", "#7b4fb5", "#0f9aa7", "#b5651d", "#c2418f",
    "#5c7a29", "#4a5fd0", "#9c2f2f", "#2f7f6f", "#8a8f1c", "#a0509f", "#3f8fd0", "#776655"};

[[nodiscard]] const char* colour_of_robot(std::size_t index) {
  return robot_colours[index % robot_colours.size()];
}
[[nodiscard]] const char* dashes_of_robot(std::size_t index) {
  constexpr std::array<const char*, 3> dashes{"", "6 3", "2 3"};
  return dashes[index / robot_colours.size() % dashes.size()];
}

/// The values that a plot has to show.
struct ValueRange {
  double least = 0, greatest = 1;
};
[[nodiscard]] ValueRange range_of(const JudgedCurve& curve) {
  if (curve.is_truth) return {0, 1};
  std::optional<ValueRange> range;
  const auto include = [&](double least, double greatest) {
    if (!range) range = ValueRange{least, greatest};
    range->least = std::min(range->least, least);
    range->greatest = std::max(range->greatest, greatest);
  };
  for (const auto& span : curve.spans)
    if (span) include(span->first, span->second);
  if (curve.limit) include(*curve.limit, *curve.limit);
  ValueRange shown = range.value_or(ValueRange{});
  return shown;
}
[[nodiscard]] ValueRange with_room(const ValueRange& values) {
  const double room =
      std::max((values.greatest - values.least) * 0.08, std::abs(values.greatest) * 1e-3 + 1e-9);
  return {values.least - room, values.greatest + room};
}

/// A number at an axis, as exactly as the axis can be read: 0 and not 9.99e-07 where the values go up to 0.036.
[[nodiscard]] std::string axis_number(double value, const ValueRange& values) {
  const double span = values.greatest - values.least;
  if (span > 0) {
    const double step = std::pow(10, std::floor(std::log10(span)) - 1);
    value = std::round(value / step) * step;
  }
  return fmt::format("{:.3g}", value == 0 ? 0.0 : value);
}

/// From seconds and values to the places of one plot.
class PlotScale {
 public:
  PlotScale(const JudgedCurve& curve, double end_s)
      : values_(range_of(curve)), range_(with_room(values_)), end_s_(std::max(end_s, 1e-3)) {}
  [[nodiscard]] double x(double time_s) const {
    return plot_left + std::clamp(time_s / end_s_, 0.0, 1.0) * (plot_width - plot_left - plot_right);
  }
  [[nodiscard]] double y(double value) const {
    return plot_bottom - (value - range_.least) / (range_.greatest - range_.least) * (plot_bottom - plot_top);
  }
  /// The drawn content, without the margin around it.
  [[nodiscard]] const ValueRange& values() const { return values_; }
  [[nodiscard]] double end_s() const { return end_s_; }

 private:
  ValueRange values_, range_;
  double end_s_;
};

/// The area between the least and the greatest values, one for each stretch without gaps.
void draw_curve(std::string& svg, const JudgedCurve& curve, const PlotScale& scale) {
  for (std::size_t from = 0; from < curve.spans.size();) {
    if (!curve.spans[from]) {
      ++from;
      continue;
    }
    std::size_t to = from;
    while (to < curve.spans.size() && curve.spans[to]) ++to;
    std::string upper, lower;
    for (std::size_t index = from; index < to; ++index) {
      const double left = static_cast<double>(index) * curve.every_s, right = left + curve.every_s;
      for (const double time_s : {left, curve.is_truth || index + 1 == to ? right : left}) {
        put(upper, "{:.1f},{:.1f} ", scale.x(time_s), scale.y(curve.spans[index]->second));
        lower = fmt::format("{:.1f},{:.1f} ", scale.x(time_s), scale.y(curve.spans[index]->first)) + lower;
      }
    }
    put(svg, R"(<polygon class="{}" points="{}{}"/>)", curve.is_truth ? "truth" : "band", upper, lower);
    from = to;
  }
}

void draw_axes(std::string& svg, const JudgedCurve& curve, const PlotScale& scale) {
  put(svg, R"(<line class="zero" x1="{0}" y1="{1}" x2="{2}" y2="{1}"/>)", plot_left, plot_bottom,
      plot_width - plot_right);
  put(svg, R"(<text class="tick" x="{}" y="{}">0 s</text>)", plot_left, plot_bottom + 16);
  put(svg, R"(<text class="tick" x="{}" y="{}" text-anchor="end">{:.4g} s</text>)", plot_width - plot_right,
      plot_bottom + 16, scale.end_s());
  const auto label = [&](double value, const std::string& text) {
    put(svg, R"(<text class="tick" x="{}" y="{:.1f}" text-anchor="end">{}</text>)", plot_left - 6,
        std::clamp(scale.y(value) + 4, plot_top + 8, plot_bottom + 2), text);
  };
  if (curve.is_truth) {
    label(0, "no");
    label(1, "yes");
    return;
  }
  for (const double value : {scale.values().least, scale.values().greatest})
    label(value, axis_number(value, scale.values()));
}

/// The area drawn from above: the floor, or the box around all paths.
struct GroundBox {
  double left = 0, bottom = 0, width = 1, height = 1;
};
[[nodiscard]] GroundBox box_of(const std::vector<RobotPath>& robots, const sim::Track* floor) {
  if (floor != nullptr) return {0, 0, floor->width_m(), floor->height_m()};
  std::optional<GroundBox> box;
  double right = 0, top = 0;
  for (const RobotPath& robot : robots)
    for (const replay::RobotPoint& point : robot.points) {
      if (!box) {
        box = GroundBox{point.x_m, point.y_m, 0, 0};
        right = point.x_m;
        top = point.y_m;
      }
      box->left = std::min(box->left, point.x_m);
      box->bottom = std::min(box->bottom, point.y_m);
      right = std::max(right, point.x_m);
      top = std::max(top, point.y_m);
    }
  if (!box) return {};
  const double room = std::max({(right - box->left) * 0.06, (top - box->bottom) * 0.06, 0.15});
  return {box->left - room, box->bottom - room, right - box->left + 2 * room, top - box->bottom + 2 * room};
}

[[nodiscard]] bool moves(const RobotPath& robot) {
  return std::ranges::any_of(robot.points, [&](const replay::RobotPoint& point) {
    return std::hypot(point.x_m - robot.points.front().x_m, point.y_m - robot.points.front().y_m) > 0.01;
  });
}

/// The unit of the drawing is a pixel of a page 1000 wide.
class GroundPlan {
 public:
  GroundPlan(const GroundBox& box) : box_(box), scale_(std::min(1000 / box.width, 620 / box.height)) {}
  [[nodiscard]] double x(double metres) const { return (metres - box_.left) * scale_; }
  [[nodiscard]] double y(double metres) const { return (box_.bottom + box_.height - metres) * scale_; }
  [[nodiscard]] double width() const { return box_.width * scale_; }
  [[nodiscard]] double height() const { return box_.height * scale_; }
  /// One, two or five times a power of ten metres.
  void draw_scale(std::string& svg) const {
    const double about = box_.width / 6, power = std::pow(10, std::floor(std::log10(about)));
    const double length = power * (about / power >= 5 ? 5 : about / power >= 2 ? 2 : 1);
    put(svg,
        R"(<path class="scale" d="M12 {0:.1f}h{1:.1f}"/><text class="key" x="12" y="{2:.1f}">{3:g} m</text>)",
        height() - 10, length * scale_, height() - 16, length);
  }

 private:
  GroundBox box_;
  double scale_;
};

void draw_robot_path(std::string& svg, const RobotPath& robot, std::size_t index, const GroundPlan& plan,
                     bool with_name) {
  const char* const colour = colour_of_robot(index);
  put(svg,
      R"(<g stroke="{0}" fill="{0}"><title>{1}</title><polyline fill="none" stroke-dasharray="{2}" points=")",
      colour, escaped(shortened(robot.name, 60, 1)), dashes_of_robot(index));
  for (const std::size_t at : evenly_spaced_indices(robot.points.size(), 600))
    put(svg, "{:.1f},{:.1f} ", plan.x(robot.points[at].x_m), plan.y(robot.points[at].y_m));
  const replay::RobotPoint &first = robot.points.front(), &last = robot.points.back();
  put(svg, R"svg("/><circle class="from" cx="{:.1f}" cy="{:.1f}" r="4"/>)svg", plan.x(first.x_m),
      plan.y(first.y_m));
  put(svg,
      R"svg(<path class="now" transform="translate({:.1f} {:.1f}) rotate({:.1f})" d="M9 0L-6 6L-3 0L-6 -6Z"/>)svg",
      plan.x(last.x_m), plan.y(last.y_m), -last.heading_rad * 180 / std::numbers::pi);
  if (with_name)
    put(svg, R"(<text class="name" stroke="none" fill="{}" x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)",
        colour, plan.x(last.x_m) + (plan.x(last.x_m) > plan.width() - 120 ? -11 : 11), plan.y(last.y_m) - 7,
        plan.x(last.x_m) > plan.width() - 120 ? "end" : "start", escaped(shortened(robot.name, 24, 1)));
  svg += "</g>";
}

}  // namespace

std::string curve_svg(const JudgedCurve& curve, double end_s) {
  const PlotScale scale(curve, end_s);
  std::string svg = fmt::format(R"(<svg viewBox="0 0 {} {}" role="img" aria-label="{} over time">)",
                                plot_width, plot_height, escaped(shortened(curve.name, 80, 1)));
  draw_axes(svg, curve, scale);
  draw_curve(svg, curve, scale);
  if (curve.limit) {
    const double y = scale.y(*curve.limit);
    put(svg, R"(<line class="limit" x1="{0}" y1="{1:.1f}" x2="{2}" y2="{1:.1f}"/>)", plot_left, y,
        plot_width - plot_right);
    put(svg, R"(<text class="limit-text" x="{}" y="{:.1f}" text-anchor="end">limit {:.4g}</text>)",
        plot_width - plot_right, y < plot_top + 16 ? y + 13 : y - 4, *curve.limit);
  }
  if (curve.failed_s) {
    const double x = scale.x(*curve.failed_s);
    put(svg, R"(<line class="error" x1="{0:.1f}" y1="{1}" x2="{0:.1f}" y2="{2}"/>)", x, plot_top - 4,
        plot_bottom);
    put(svg, R"(<text class="failed-text" x="{:.1f}" y="{}" text-anchor="{}">failed at {:.3f} s</text>)",
        x > plot_width / 2 ? x - 5 : x + 5, plot_bottom - 5, x > plot_width / 2 ? "end" : "start",
        *curve.failed_s);
  }
  return svg + "</svg>";
}

std::string paths_svg(const std::vector<RobotPath>& robots, const sim::Track* floor) {
  constexpr std::size_t most_names = 24;
  const GroundBox box = box_of(robots, floor);
  const GroundPlan plan(box);
  std::string svg = fmt::format(
      R"(<svg class="ground" viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="The paths of all robots from above">)",
      plan.width(), plan.height());
  if (floor != nullptr)
    put(svg, R"(<image href="{}" width="{:.1f}" height="{:.1f}" preserveAspectRatio="none"/>)",
        data_uri("image/png", floor_png(*floor)), plan.width(), plan.height());
  const auto moving = static_cast<std::size_t>(std::ranges::count_if(robots, moves));
  for (std::size_t index = 0; index < robots.size(); ++index)
    if (!robots[index].points.empty()) draw_robot_path(svg, robots[index], index, plan, moving <= most_names);
  plan.draw_scale(svg);
  return svg + "</svg>";
}

std::string paths_legend(const std::vector<RobotPath>& robots) {
  constexpr std::size_t most_shown = 64;
  std::string html = R"(<p class="legend">)", resting;
  for (std::size_t index = 0; index < std::min(robots.size(), most_shown); ++index) {
    const std::string name = escaped(shortened(robots[index].name, 40, 1));
    if (moves(robots[index]))
      put(html,
          R"(<span><svg viewBox="0 0 26 6"><path d="M0 3H26" stroke="{}" stroke-dasharray="{}"/></svg>{}</span>)",
          colour_of_robot(index), dashes_of_robot(index), name);
    else
      resting += (resting.empty() ? "" : ", ") + name;
  }
  if (robots.size() > most_shown) put(html, "<span>and {} more</span>", robots.size() - most_shown);
  html += "</p>";
  if (!resting.empty()) put(html, R"(<p class="note">In place all the time: {}</p>)", resting);
  return html;
}

}  // namespace tessera::report
