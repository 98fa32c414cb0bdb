#include "report/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>

#include "replay/timeline.hpp"
#include "report/charts.hpp"
#include "report/colours.hpp"
#include "report/picture.hpp"
#include "report/style.hpp"

namespace tessera::report {
namespace {

constexpr std::size_t most_messages = 400;

template <class... Args>
void put(std::string& to, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(to), format, std::forward<Args>(args)...);
}

void put_figure(std::string& html, const std::string& value, std::string_view name) {
  put(html, R"(<div class="figure"><b>{}</b><span>{}</span></div>)", value, name);
}

/// 1234567 -> "1 234 567" with thin spaces.
std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, "\u2009");
  }
  return text;
}

void put_figures(std::string& html, const ReportInput& input) {
  html += R"(<div class="figures">)";
  if (input.drive) {
    const sim::LineMetrics& metrics = input.drive->metrics;
    if (!input.drive->line.points.empty()) put_figure(html, fmt::format("{:.2f}", metrics.laps), "laps");
    put_figure(html, fmt::format("{:.2f} s", metrics.line_lost_s),
               fmt::format("line lost (longest {:.2f} s)", metrics.longest_loss_s));
    if (!metrics.error_m.empty()) {
      put_figure(html, fmt::format("{:.1f} mm", metrics.mean_error_m * 1000), "mean error");
      put_figure(html, fmt::format("{:.1f} mm", metrics.max_error_m * 1000), "largest error");
    }
  }
  put_figure(html, fmt::format("{:.1f} s", input.simulated_s),
             input.recording.clock == "simulated" ? "simulated" : "run");
  if (input.wall_s > 0)
    put_figure(html, fmt::format("{:.0f} \u00d7", input.simulated_s / input.wall_s),
               fmt::format("real time ({:.2f} s)", input.wall_s));
  put_figure(html, grouped(input.firings), "transitions fired");
  html += "</div>";
}

void put_drive(std::string& html, const Drive& drive) {
  const PathColours colours = path_colours(drive);
  std::string ramp;
  for (int i = 0; i <= 6; ++i) ramp += (i > 0 ? "," : "") + css(heat(i / 6.0));
  put(html,
      R"html(<h2>Path</h2><div class="panel floor">{}<p class="note">The middle sensor's path: 0<span class="ramp" style="background:linear-gradient(90deg,{})"></span>{} )html"
      R"(The ring is the start, the robot stands where it ended.</p></div>)",
      path_svg(drive), ramp,
      colours.by_error ? fmt::format("{:.0f} mm or more from the middle of the line.", colours.top * 1000)
                       : fmt::format("{:.0f} s.", colours.top));
  if (drive.metrics.error_m.empty() || drive.metrics.error_m.size() != drive.trace.points.size()) return;
  put(html,
      R"(<h2>Lateral error</h2><div class="panel">{}<p class="note">Of the middle sensor; left of the driving direction is positive. Shaded: no sensor over the line.</p></div>)",
      error_svg(drive));
}

void put_subsystems(std::string& html, const ReportInput& input, const replay::Timeline& timeline) {
  std::vector<SubsystemFigures> rows = input.subsystems;
  if (rows.empty()) {
    for (const replay::Lane& lane : timeline.lanes)
      rows.push_back({lane.path, lane.iterations, 0, lane.errors_s.size()});
  }
  if (rows.empty()) return;
  html +=
      R"(<h2>Subsystems</h2><div class="panel"><table><tr><th>Subsystem<th class="n">Iterations<th class="n">Overruns<th class="n">Errors</tr>)";
  for (const SubsystemFigures& row : rows) {
    put(html, R"(<tr><td class="mono">{}<td class="n">{}<td class="n">{}<td class="n{}">{}</tr>)",
        escaped(row.path), grouped(row.iterations), grouped(row.overruns), row.errors > 0 ? " bad" : "",
        grouped(row.errors));
  }
  html += "</table></div>";
}

void put_verification(std::string& html, const ReportInput& input) {
  const Recording& recording = input.recording;
  html += R"(<h2>What ran</h2><div class="panel"><table>)";
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
  if (recording.truncated) put_fact("recording", "cut off at the end");
  html += "</table></div>";
}

void put_message(std::string& html, const Recording& recording, const Recording::Entry& entry) {
  const bool stop = entry.event.kind() == Event::Kind::stop;
  const bool fault = entry.event.kind() == Event::Kind::fault;
  const char* kind = fault                      ? "bad"
                     : stop                     ? ""
                     : entry.event.version == 1 ? "warn"
                     : entry.event.version == 2 ? "bad"
                                                : "";
  const std::uint32_t instance = entry.event.instance();
  put(html, R"(<tr><td class="n">{:.3f} s<td class="mono">{}<td class="message {}">{}{}</tr>)",
      static_cast<double>(entry.event.time_ns) * 1e-9,
      instance < recording.instances.size() ? escaped(recording.instances[instance]) : "system", kind,
      stop ? "stopped: " : "", escaped(entry.text));
}

void put_messages(std::string& html, const Recording& recording) {
  std::vector<const Recording::Entry*> messages;
  for (const auto& entry : recording.entries) {
    if (entry.event.has_text()) messages.push_back(&entry);
  }
  if (messages.empty()) return;
  html += R"(<h2>Messages</h2><div class="panel"><table>)";
  const std::size_t hidden = messages.size() > most_messages ? messages.size() - most_messages : 0;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (hidden > 0 && i == most_messages / 2) {
      put(html, R"(<tr><td colspan="3" class="note">{} more messages are in the recording</tr>)",
          grouped(hidden));
      i += hidden;
    }
    put_message(html, recording, *messages[i]);
  }
  html += "</table></div>";
}

}  // namespace

std::string headline(const ReportInput& input) {
  std::string text = fmt::format("{:.1f} s", input.simulated_s);
  if (!input.drive) return text;
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
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\">"
      "<title>{0}</title><style>{1}</style></head>\n<body><main><h1>{0}</h1><p class=\"lead\">{2}</p>\n",
      name, style, headline(input));
  put_figures(html, input);
  if (input.drive && !input.drive->trace.points.empty()) put_drive(html, *input.drive);
  if (!timeline.lanes.empty())
    put(html, R"(<h2>Behaviours</h2><div class="panel">{}</div>)", timeline_svg(timeline));
  put_subsystems(html, input, timeline);
  put_verification(html, input);
  put_messages(html, input.recording);
  return html + "</main></body></html>\n";
}

}  // namespace tessera::report
