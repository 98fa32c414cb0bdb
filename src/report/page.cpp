#include "report/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "replay/timeline.hpp"
#include "report/ages_html.hpp"
#include "report/charts.hpp"
#include "report/colours.hpp"
#include "report/messages.hpp"
#include "report/picture.hpp"
#include "report/style.hpp"
#include "report/text.hpp"

namespace tessera::report {
namespace {

constexpr std::size_t most_messages = 40, most_lanes = 24, most_rows = 40, most_plots = 16;

void put_figure(std::string& html, const std::string& value, std::string_view name) {
  put(html, R"(<div class="figure"><b>{}</b><span>{}</span></div>)", value, name);
}

/// "287 ×", "0.4 ×".
std::string factor(double times) {
  return times < 10 ? fmt::format("{:.1f} \u00d7", times) : fmt::format("{:.0f} \u00d7", times);
}

void put_figures(std::string& html, const ReportInput& input) {
  html += R"(<div class="figures">)";
  if (input.drive && input.drive->is_whole) {
    const sim::LineMetrics& metrics = input.drive->metrics;
    if (!input.drive->line.points.empty()) put_figure(html, fmt::format("{:.2f}", metrics.laps), "laps");
    put_figure(html, fmt::format("{:.2f} s", metrics.line_lost_s),
               fmt::format("line lost (longest {:.2f}\u00a0s)", metrics.longest_loss_s));
    if (!metrics.error_m.empty()) {
      put_figure(html, fmt::format("{:.1f} mm", metrics.mean_error_m * 1000), "mean error");
      put_figure(html, fmt::format("{:.1f} mm", metrics.max_error_m * 1000), "largest error");
    }
  }
  put_figure(html, fmt::format("{:.1f} s", input.simulated_s),
             input.recording.clock == "simulated" ? "simulated" : "run");
  if (input.wall_s > 0 && input.simulated_s > 0 && input.recording.clock == "simulated")
    put_figure(html, factor(input.simulated_s / input.wall_s),
               fmt::format("real time ({:.2f}\u00a0s)", input.wall_s));
  put_figure(html, grouped(input.firings), "transitions fired");
  html += "</div>";
}

/// Shows the rows that matter, then the first others, in their order; the rest is only counted.
template <class Row, class Matters>
std::size_t keep_most(std::vector<Row>& rows, std::size_t most, Matters matters) {
  if (rows.size() <= most) return 0;
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](std::size_t row) { return matters(rows[row]); });
  const std::size_t hidden = rows.size() - most;
  order.resize(most);
  std::ranges::sort(order);
  std::vector<Row> kept;
  for (const std::size_t row : order) kept.push_back(std::move(rows[row]));
  rows = std::move(kept);
  return hidden;
}

void put_poster(std::string& html, const ReportInput& input) {
  if (input.poster) {
    put(html,
        R"(<h2>The world at the end</h2><div class="panel poster"><img alt="The simulated world" src="{}" width="{}" height="{}"></div>)",
        data_uri("image/png", png_of(input.poster->picture)), input.poster->picture.width,
        input.poster->picture.height);
  } else if (!input.why_no_poster.empty()) {
    put(html, R"(<p class="note">There is no picture of the world: {}</p>)",
        escaped(shortened(input.why_no_poster, 300, 3)));
  }
}

void put_paths(std::string& html, const ReportInput& input) {
  if (!input.paths) return;
  if (!input.paths->has_poses) {
    html +=
        R"(<p class="note">The recording has no poses of the bodies of the world, so there are no paths of robots.</p>)";
    return;
  }
  const bool is_shown = input.drive && !input.drive->trace.points.empty();
  const bool any =
      std::ranges::any_of(input.paths->robots, [](const RobotPath& one) { return !one.points.empty(); });
  if (is_shown || !any) return;
  put(html,
      R"(<h2>Paths</h2><div class="panel">{}{}<p class="note">From above, x to the right. A circle is the start, an arrow the end.</p></div>)",
      paths_svg(input.paths->robots, input.floor ? &*input.floor : nullptr),
      paths_legend(input.paths->robots));
}

void put_judged_curve(std::string& html, const JudgedCurve& curve, double end_s) {
  const char* kind = curve.verdict == "failed" ? "bad" : curve.verdict == "held" ? "good" : "warn";
  put(html, R"(<div class="panel plot"><p><b>{}</b>)", escaped(shortened(curve.name, 80, 1)));
  if (!curve.unit.empty()) put(html, " in {}", escaped(curve.unit));
  if (curve.is_check) put(html, R"( <span class="{}">{}</span>)", kind, escaped(curve.verdict));
  html += "</p>";
  if (!curve.text.empty())
    put(html, R"(<p class="note mono">{}</p>)", escaped(shortened(curve.text, 160, 1)));
  if (!curve.spans.empty()) html += curve_svg(curve, end_s);
  if (!curve.detail.empty()) put(html, R"(<p class="note">{}</p>)", escaped(shortened(curve.detail, 200, 2)));
  html += "</div>";
}

void put_judged(std::string& html, const ReportInput& input) {
  if (input.judged.empty()) return;
  std::vector<JudgedCurve> shown = input.judged;
  const std::size_t hidden =
      keep_most(shown, most_plots, [](const JudgedCurve& curve) { return curve.verdict == "failed"; });
  html += R"(<h2>Checks and measures</h2><div class="plots">)";
  for (const JudgedCurve& curve : shown) put_judged_curve(html, curve, input.simulated_s);
  html += "</div>";
  if (hidden > 0) put(html, R"(<p class="note">and {} more</p>)", grouped(hidden));
}

void put_drive(std::string& html, const DrivenPath& drive) {
  const PathColours colours = path_colours(drive);
  std::string ramp;
  for (int i = 0; i <= 6; ++i) ramp += (i > 0 ? "," : "") + css_colour(heat_colour(i / 6.0));
  put(html,
      R"html(<h2>Path</h2><div class="panel floor">{}<p class="note">The middle sensor's path: 0<span class="ramp" style="background:linear-gradient(90deg,{})"></span>{} )html"
      R"(The ring is the start, the robot stands where it ended.</p></div>)",
      path_svg(drive), ramp,
      colours.by_error ? fmt::format("{:.0f} mm or more from the middle of the line.", colours.top * 1000)
                       : fmt::format("{:.0f} s.", colours.top));
  if (drive.metrics.error_m.size() < 2 || drive.metrics.error_m.size() != drive.trace.points.size()) return;
  put(html,
      R"(<h2>Lateral error</h2><div class="panel">{}<p class="note">Of the middle sensor; left of the driving direction is positive. Shaded: no sensor over the line.</p></div>)",
      error_svg(drive));
}

void put_behaviours(std::string& html, replay::Timeline timeline) {
  const std::size_t hidden =
      keep_most(timeline.lanes, most_lanes, [](const replay::Lane& lane) { return !lane.errors_s.empty(); });
  if (timeline.lanes.empty() || timeline.end_s <= 0) return;
  put(html, R"(<h2>Behaviours</h2><div class="panel">{})", timeline_svg(timeline));
  if (hidden > 0) put(html, R"(<p class="note">and {} more subsystems</p>)", grouped(hidden));
  html += "</div>";
}

void put_subsystems(std::string& html, const ReportInput& input, const replay::Timeline& timeline) {
  std::vector<SubsystemFigures> rows = input.subsystems;
  if (rows.empty()) {
    for (const replay::Lane& lane : timeline.lanes)
      rows.push_back({lane.path, lane.iterations, 0, lane.errors_s.size()});
  }
  if (rows.empty()) return;
  const std::size_t hidden = keep_most(
      rows, most_rows, [](const SubsystemFigures& row) { return row.errors > 0 || row.overruns > 0; });
  html +=
      R"(<h2>Subsystems</h2><div class="panel"><table><tr><th>Subsystem<th class="n">Iterations<th class="n">Overruns<th class="n">Errors</tr>)";
  for (const SubsystemFigures& row : rows) {
    put(html, R"(<tr><td class="mono">{}<td class="n">{}<td class="n">{}<td class="n{}">{}</tr>)",
        escaped(row.path), grouped(row.iterations), grouped(row.overruns), row.errors > 0 ? " bad" : "",
        grouped(row.errors));
  }
  html += "</table>";
  if (hidden > 0) put(html, R"(<p class="note">and {} more subsystems</p>)", grouped(hidden));
  html += "</div>";
}

void put_verification(std::string& html, const ReportInput& input) {
  const Recording& recording = input.recording;
  html += R"(<h2>Verification and recording</h2><div class="panel"><table>)";
  for (const Verdict& verdict : input.verdicts) {
    const char* kind = verdict.result == "holds" ? "good" : verdict.result == "violated" ? "bad" : "warn";
    put(html, R"(<tr><td>{}<td class="{}">{}<td>{}</tr>)", escaped(verdict.property), kind,
        escaped(verdict.result), escaped(verdict.note));
  }
  const auto put_fact = [&](std::string_view name, const std::string& value) {
    if (!value.empty()) put(html, R"(<tr><td>{}<td class="mono" colspan="2">{}</tr>)", name, escaped(value));
  };
  put_fact("hash of the net", recording.net_hash);
  put_fact("hash of the verification", recording.verification_hash);
  put_fact("clock", recording.clock);
  put_fact("seed", std::to_string(recording.seed));
  put_fact("ended", input.ended);
  html += "</table></div>";
}

void put_message(std::string& html, const Message& message) {
  constexpr const char* classes[] = {"bad", "warn", ""};
  const auto seconds = [](std::int64_t time_ns) { return static_cast<double>(time_ns) * 1e-9; };
  const std::string times = message.count == 1
                                ? std::string()
                                : fmt::format(R"( <span class="note">{} times, last at {:.3f} s</span>)",
                                              grouped(message.count), seconds(message.last_ns));
  put(html, R"(<tr><td class="n">{:.3f} s<td class="mono">{}<td class="message {}">{}{}</tr>)",
      seconds(message.first_ns), escaped(message.who), classes[static_cast<std::size_t>(message.weight)],
      escaped(message.what), times);
}

void put_messages(std::string& html, const Recording& recording) {
  const Messages messages = messages_of(recording, most_messages);
  if (messages.shown.empty()) return;
  html += R"(<h2>Messages</h2><div class="panel"><table class="messages">)";
  for (const Message& message : messages.shown) put_message(html, message);
  html += "</table>";
  if (messages.hidden > 0)
    put(html,
        R"(<p class="note">and {} more messages: <code>tessera replay --print</code> shows them all</p>)",
        grouped(messages.hidden));
  html += "</div>";
}

bool has_failed(const Recording& recording) {
  return std::ranges::any_of(recording.entries, [](const Recording::Entry& entry) {
    return entry.event.kind() == Event::Kind::stop && entry.event.version != 0;
  });
}

/// Notices that a reader needs before the figures.
void put_notices(std::string& html, const ReportInput& input) {
  const auto put_notice = [&](const std::string& text, std::string_view kind = "") {
    put(html, R"(<p class="panel notice{}">{}</p>)", kind, escaped(text));
  };
  if (has_failed(input.recording))
    put_notice("The run has failed: " + shortened(input.ended, 400, 4), " failed");
  if (const std::string note = note_on_beginning(input.recording); !note.empty())
    put_notice(
        "About the recording: " + note +
        ". Paths, behaviours, messages and the distance from the line are those of this part. Checks, "
        "measures, iterations and firings are those of the whole run. Laps and losses of the line need "
        "the whole recording, so they are not told.");
  if (input.recording.truncated)
    put_notice("The recording is cut off at its end: what happened after that is not shown.");
  if (input.recording.lost > 0)
    put_notice(fmt::format("{} events of the run are missing in the recording.", input.recording.lost));
}

}  // namespace

std::string headline(const ReportInput& input) {
  std::string text = fmt::format("{:.1f} s", input.simulated_s);
  if (!input.drive || !input.drive->is_whole) return text;
  const sim::LineMetrics& metrics = input.drive->metrics;
  if (!input.drive->line.points.empty()) put(text, " \u00b7 {:.2f} laps", metrics.laps);
  put(text, " \u00b7 line lost {:.2f} s", metrics.line_lost_s);
  if (!metrics.error_m.empty())
    put(text, " \u00b7 error {:.1f} mm mean, {:.1f} mm max", metrics.mean_error_m * 1000,
        metrics.max_error_m * 1000);
  return text;
}

std::string page(const ReportInput& input) {
  const replay::Timeline timeline = replay::timeline_of(input.recording);
  const std::string name = escaped(input.recording.system.empty() ? "run" : input.recording.system);
  std::string html;
  put(html,
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">{3}<meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\">"
      "<title>{0}</title><style>{1}</style></head>\n<body><main><h1>{0}</h1><p class=\"lead\">{2}</p>\n",
      name, style,
      headline(input) +
          (input.ended.empty() ? "" : " \u00b7 ended: " + escaped(shortened(input.ended, 200, 1))),
      generator_tag);
  put_notices(html, input);
  put_figures(html, input);
  put_poster(html, input);
  put_paths(html, input);
  if (input.drive && !input.drive->trace.points.empty()) put_drive(html, *input.drive);
  put_judged(html, input);
  put_behaviours(html, timeline);
  html += ages_html(input);
  put_subsystems(html, input, timeline);
  put_messages(html, input.recording);
  put_verification(html, input);
  return html + "</main></body></html>\n";
}

}  // namespace tessera::report
