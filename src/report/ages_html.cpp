#include "report/ages_html.hpp"

#include <algorithm>
#include <string_view>

#include "report/text.hpp"

namespace tessera::report {
namespace {

constexpr double ages_width = 480, ages_height = 132, ages_left = 10, ages_right = 10, ages_top = 22,
                 ages_bottom = 108;
constexpr std::size_t most_chains = 8, most_slow = 40;

double in_ms(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

/// A bar per step of the histogram, from 0 to a little more than the greatest time or the bound.
std::string distribution_svg(std::string_view label, const replay::MeasuredTimes& times,
                             std::optional<std::int64_t> bound) {
  const double end = in_ms(std::max(times.most, bound.value_or(0))) * 1.05 + 1e-6;
  const auto x = [&](double ms) { return ages_left + ms / end * (ages_width - ages_left - ages_right); };
  std::string svg;
  put(svg, R"(<svg viewBox="0 0 {} {}" role="img" aria-label="{}">)", ages_width, ages_height, label);
  std::vector<std::uint64_t> bars = times.histogram;
  if (bars.empty()) bars = {times.count};
  const double step = in_ms(times.most - times.least) / static_cast<double>(bars.size());
  const double highest = static_cast<double>(std::ranges::max(bars));
  for (std::size_t index = 0; index < bars.size(); ++index) {
    if (bars[index] == 0) continue;
    const double left = x(in_ms(times.least) + step * static_cast<double>(index));
    // One time among thousands is the one that matters: it is visible.
    const double height =
        std::max(2.0, static_cast<double>(bars[index]) / highest * (ages_bottom - ages_top));
    put(svg, R"(<rect class="truth" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)", left,
        ages_bottom - height, std::max(2.0, x(step) - x(0)), height);
  }
  put(svg, R"(<line class="zero" x1="{0}" y1="{1}" x2="{2}" y2="{1}"/>)", ages_left, ages_bottom,
      ages_width - ages_right);
  put(svg, R"(<text class="tick" x="{}" y="{}">0 ms</text>)", ages_left, ages_bottom + 16);
  put(svg, R"(<text class="tick" x="{}" y="{}" text-anchor="end">{:.4g} ms</text>)", ages_width - ages_right,
      ages_bottom + 16, end);
  if (bound) {
    const double at = x(in_ms(*bound));
    put(svg, R"(<line class="limit" x1="{0:.1f}" y1="{1}" x2="{0:.1f}" y2="{2}"/>)", at, ages_top - 6,
        ages_bottom);
    put(svg, R"(<text class="limit-text" x="{:.1f}" y="{}" text-anchor="end">at most {:.4g} ms</text>)",
        std::max(at, 120.0), ages_top - 10, in_ms(*bound));
  }
  return svg + "</svg>";
}

void put_times(std::string& html, std::string_view what, std::string_view label,
               const ChainTimes::Measured& measured) {
  const replay::MeasuredTimes& times = measured.times;
  if (times.count == 0) return;
  const bool exceeds = measured.bound_ns && times.most > *measured.bound_ns;
  put(html, R"(<div class="panel plot"><p><b>{}</b>{}</p>)", what,
      exceeds ? R"( <span class="bad">above its bound</span>)" : "");
  html += distribution_svg(label, times, measured.bound_ns);
  put(html,
      R"(<p class="note">{} times: median {:.3f} ms, 95 % up to {:.3f} ms, 99 % up to {:.3f} ms, longest {:.3f} ms, )"
      R"(from {:.3f} s to {:.3f} s</p></div>)",
      grouped(times.count), in_ms(times.median), in_ms(times.p95), in_ms(times.p99), in_ms(times.most),
      static_cast<double>(times.worst_from_ns) * 1e-9, static_cast<double>(times.worst_to_ns) * 1e-9);
}

bool exceeds(const ChainTimes& chain) {
  return std::ranges::any_of(
      std::initializer_list<const ChainTimes::Measured*>{&chain.age, &chain.reaction},
      [](const ChainTimes::Measured* one) { return one->bound_ns && one->times.most > *one->bound_ns; });
}

void put_slow(std::string& html, const std::vector<SlowCalls>& slow) {
  if (slow.empty()) return;
  html +=
      R"(<h2>Overtime</h2><div class="panel"><table><tr><th>Behaviour<th class="n">Calls<th class="n">Longer than its takes)"
      R"(<th class="n">Takes at most<th class="n">Longest call<th class="n">It began at</tr>)";
  for (std::size_t index = 0; index < std::min(slow.size(), most_slow); ++index) {
    const SlowCalls& one = slow[index];
    put(html,
        R"(<tr><td class="mono">{}<td class="n">{}<td class="n bad">{}<td class="n">{:.3f} ms<td class="n">{:.3f} ms)"
        R"(<td class="n">{:.3f} s</tr>)",
        escaped(one.behaviour), grouped(one.calls), grouped(one.slow), in_ms(one.declared_ns),
        in_ms(one.longest_ns), static_cast<double>(one.longest_at_ns) * 1e-9);
  }
  html += "</table>";
  if (slow.size() > most_slow)
    put(html, R"(<p class="note">and {} more</p>)", grouped(slow.size() - most_slow));
  html += "</div>";
}

}  // namespace

std::string ages_html(const ReportInput& input) {
  std::string html;
  std::vector<ChainTimes> shown;
  for (const ChainTimes& chain : input.chains)
    if (chain.age.times.count > 0) shown.push_back(chain);
  std::ranges::stable_sort(shown,
                           [](const ChainTimes& a, const ChainTimes& b) { return exceeds(a) > exceeds(b); });
  if (!shown.empty()) html += "<h2>Age of commands</h2>";
  for (std::size_t index = 0; index < std::min(shown.size(), most_chains); ++index) {
    const ChainTimes& chain = shown[index];
    put(html, R"(<p class="mono">{}{}</p><div class="plots">)", escaped(shortened(chain.name, 200, 1)),
        chain.chains > 1 ? " (" + grouped(chain.chains) + " agents)" : "");
    put_times(html, "age: from the reading to the end of each command", "Distribution of ages", chain.age);
    put_times(html, "reaction: from an event just after a reading to its first command",
              "Distribution of reactions", chain.reaction);
    html += "</div>";
    if (!chain.no_bound.empty())
      put(html, R"(<p class="note">no bound: {}</p>)", escaped(shortened(chain.no_bound, 300, 2)));
    if (!chain.left_out.empty())
      put(html, R"(<p class="note">{}</p>)", escaped(shortened(chain.left_out, 600, 3)));
  }
  if (shown.size() > most_chains)
    put(html, R"(<p class="note">and {} more chains: <code>tessera replay --ages</code> shows them all</p>)",
        grouped(shown.size() - most_chains));
  put_slow(html, input.slow_calls);
  return html;
}

}  // namespace tessera::report
