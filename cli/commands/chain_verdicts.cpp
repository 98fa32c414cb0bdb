#include "cli/commands/chain_verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "timing/declared.hpp"

namespace tessera::cli {
namespace {

/// "82 ms", "1.5 s": at most four digits, rounded up, since a bound must not be told too small.
std::string shown(timing::Time ns) {
  struct Unit {
    timing::Time ns;
    const char* name;
  };
  for (const Unit unit : {Unit{1'000'000'000, "s"}, Unit{1'000'000, "ms"}, Unit{1'000, "us"}})
    if (ns >= unit.ns) {
      timing::Time step = unit.ns / 1000;
      while (ns / step >= 10'000) step *= 10;
      return fmt::format(
          "{:g} {}", static_cast<double>(timing::ceil_div(ns, step) * step) / static_cast<double>(unit.ns),
          unit.name);
    }
  return fmt::format("{} ns", ns);
}

/// "robot[].control": the members of a fleet have one line, if their verdicts are equal.
std::string without_members(const std::string& name) {
  std::string result;
  bool inside = false;
  for (const char c : name) {
    if (c == '[') inside = true;
    if (c == ']') inside = false;
    if (!inside || c == '[') result += c;
  }
  return result;
}

std::string said(const timing::ChainVerdict& verdict) {
  if (!verdict.why.empty()) return "no bound: " + verdict.why;
  const char* const most = verdict.exact ? "" : "at most ";
  return fmt::format("age {0}{1}, reaction {0}{2}{3}", most, shown(verdict.bound.age),
                     shown(verdict.bound.reaction), verdict.exact ? " (exact: some run takes so long)" : "");
}

bool says_times(const spec::Model& model) {
  return std::ranges::any_of(model.definitions, [](const spec::Definition& definition) {
    return std::ranges::any_of(definition.subsystems, [](const spec::Subsystem& subsystem) {
      return std::ranges::any_of(subsystem.behaviours, [](const spec::Behaviour& behaviour) {
        return behaviour.takes.is_declared();
      });
    });
  });
}

}  // namespace

ChainVerdicts chain_verdicts(const spec::Model& model) {
  ChainVerdicts result{{}, nlohmann::json::array()};
  if (!says_times(model)) return result;
  const timing::Declared declared = timing::declared(model);
  const timing::Bounds bounds(declared.system);
  struct Line {
    std::string name, verdict;
    std::size_t chains = 0;
  };
  std::vector<Line> lines;
  std::map<std::pair<std::string, std::string>, std::size_t> line_of;
  for (const timing::DeclaredChain& chain : declared.chains) {
    const timing::ChainVerdict verdict = timing::judge(declared, model, bounds, chain);
    nlohmann::json one{{"chain", chain.name}};
    if (verdict.why.empty())
      one.update({{"age_ns", verdict.bound.age},
                  {"reaction_ns", verdict.bound.reaction},
                  {"start_ns", verdict.bound.start},
                  {"exact", verdict.exact}});
    else
      one["why"] = verdict.why;
    result.json.push_back(std::move(one));
    const std::string text = said(verdict);
    const auto [at, is_new] =
        line_of.try_emplace({without_members(chain.name), without_members(text)}, lines.size());
    if (is_new) lines.push_back({chain.name, text});
    ++lines[at->second].chains;
  }
  if (lines.empty()) return result;
  result.text =
      "times, if no call takes longer than `takes`, nothing fails or ends, and no thread waits for a "
      "processor\n"
      "but as `realtime` says:\n";
  for (const Line& line : lines)
    result.text += fmt::format("  {}: {}{}\n", line.name, line.verdict,
                               line.chains > 1 ? fmt::format(" (so in {} agents)", line.chains) : "");
  return result;
}

}  // namespace tessera::cli
