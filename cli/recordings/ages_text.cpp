#include "cli/recordings/ages_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "tessera/printable.hpp"

namespace tessera::cli {
namespace {

using replay::AgesOfChain;

std::string in_ms(std::int64_t ns) { return fmt::format("{:.3f} ms", static_cast<double>(ns) * 1e-6); }
std::string in_ms(std::optional<std::int64_t> ns) { return ns ? in_ms(*ns) : "no bound"; }
double in_seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

void put_row(std::string& text, const char* name, const replay::MeasuredTimes& times,
             std::optional<std::int64_t> bound) {
  text +=
      fmt::format("  {:<9}{:>9}{:>13}{:>13}{:>13}{:>13}{:>13}{:>13}{}\n", name, times.count,
                  in_ms(times.least), in_ms(times.median), in_ms(times.p95), in_ms(times.p99),
                  in_ms(times.most), in_ms(bound), bound && times.most > *bound ? "  above the bound" : "");
}

void put_worst(std::string& text, const char* what, const AgesOfChain& one,
               const replay::MeasuredTimes& times, std::span<const std::string> names) {
  const std::string in =
      names.size() > 1 && times.worst_recording < names.size() ? " in " + names[times.worst_recording] : "";
  const std::string of = one.measured.chains > 1 ? " (" + times.worst_chain + ")" : "";
  text += fmt::format("  {}: {}, from {:.6f} s to {:.6f} s{}{}\n", what, in_ms(times.most),
                      in_seconds(times.worst_from_ns), in_seconds(times.worst_to_ns), in, of);
}

}  // namespace

std::string ages_text(const std::vector<AgesOfChain>& all, std::span<const std::string> names) {
  std::string text;
  for (const AgesOfChain& one : all) {
    const replay::ChainAges& measured = one.measured;
    if (!text.empty()) text += "\n";
    text += printable(measured.group);
    if (measured.chains > 1) text += fmt::format(" ({} agents)", measured.chains);
    text += "\n";
    if (measured.age.count == 0) {
      text += "  nothing is measured: " + measured.why + "\n";
      continue;
    }
    constexpr std::array columns{"min", "median", "p95", "p99", "max", "at most"};
    text += fmt::format("  {:<9}{:>9}", "", "count");
    for (const char* column : columns) text += fmt::format("{:>13}", column);
    text += "\n";
    put_row(text, "age", measured.age, one.age_ns);
    if (measured.reaction.count > 0) put_row(text, "reaction", measured.reaction, one.reaction_ns);
    put_worst(text, "oldest command", one, measured.age, names);
    if (measured.reaction.count > 0) put_worst(text, "slowest reaction", one, measured.reaction, names);
    if (measured.withheld > 0)
      text += fmt::format("  {} {} of the last subsystem gave no command: failed, or the safe command held\n",
                          measured.withheld, measured.withheld == 1 ? "call" : "calls");
    if (!one.why.empty()) text += "  no bound: " + one.why + "\n";
    if (const std::string note = replay::timeless_note(one); !note.empty()) text += "  " + note + "\n";
  }
  if (std::ranges::any_of(all, &AgesOfChain::exceeds))
    text +=
        "\nA time above its bound: a call took longer than its `takes` (tessera replay --takes tells), a "
        "thread went\n"
        "on later than `timing: { latency }` says, or something failed.\n";
  return text;
}

}  // namespace tessera::cli
