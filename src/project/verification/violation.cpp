#include "project/verification/violation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "explore/explore.hpp"
#include "project/verification/pipeline.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/counterexample/narrative.hpp"

namespace tessera::project {

namespace {

constexpr std::size_t shown_steps = 60, shown_channels = 20;

/// The message about the part of a long list that is left out: its beginning, because
/// the violation is at its end.
std::string left_out(std::size_t count, const char* what) {
  return count == 0 ? std::string()
                    : fmt::format("    ... {} {}, all of them with --trace FILE\n", count, what);
}

std::string told(const std::vector<verify::Act>& acts) {
  const std::size_t first = acts.size() - std::min(acts.size(), shown_steps);
  std::size_t widest = 0;
  for (const verify::Act& act : acts) widest = std::max(widest, act.who.size());
  std::string text = left_out(first, "steps");
  for (std::size_t index = first; index < acts.size(); ++index) {
    const verify::Act& act = acts[index];
    const std::string numbers =
        act.first == act.last ? fmt::format("{}", act.first) : fmt::format("{}-{}", act.first, act.last);
    text += fmt::format("  {:>7}  {:<{}}  {}{}\n", numbers, act.who, widest, act.text,
                        act.line > 0            ? fmt::format("  [line {}]", act.line)
                        : !act.included.empty() ? fmt::format("  [{}]", act.included)
                                                : "");
  }
  return text;
}

std::string listed(const net::Net& net, const std::vector<net::TransitionId>& run) {
  const std::size_t first = run.size() - std::min(run.size(), shown_steps);
  std::string text = left_out(first, "firings");
  for (std::size_t index = first; index < run.size(); ++index)
    text += fmt::format("    {:3} {}\n", index + 1, net[run[index]].name);
  return text;
}

bool of_layers(const net::Net& net) {
  return std::ranges::any_of(net.places(), [](const net::Place& place) { return place.subsystem.valid(); });
}

}  // namespace

net::Net net_of_run(const net::Net& judged, const verify::PropertyResult& property) {
  return verify::abstract_net(judged, verify::assumed_by(property));
}

std::vector<std::string> marked_after(const net::Net& net, const std::vector<net::TransitionId>& run,
                                      bool only_channels) {
  std::vector<std::string> names;
  const std::optional<explore::Marking> end = explore::replay(explore::PtNet(net), run);
  if (!end) return names;
  for (std::uint32_t place = 0; place < net.places().size(); ++place)
    if ((*end)[place] > 0 && (net.places()[place].fused() || !only_channels))
      names.push_back(net.places()[place].name);
  return names;
}

namespace {

/// The marked places of channels at the end of a run, for the channels that a subsystem in it uses.
std::vector<std::string> channels_after(const net::Net& net, const std::vector<net::TransitionId>& run) {
  std::set<net::SubsystemId> acting;
  std::set<net::PlaceId> used;
  for (const net::TransitionId id : run) acting.insert(net[id].subsystem);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    if (!net[id].subsystem.valid() || !acting.contains(net[id].subsystem)) continue;
    for (const auto arcs : {net.preset(id), net.postset(id)})
      for (const net::Arc& arc : arcs)
        if (net[arc.place].fused()) used.insert(arc.place);
  }
  std::vector<std::string> names;
  const std::optional<explore::Marking> end = explore::replay(explore::PtNet(net), run);
  if (!end) return names;
  for (const net::PlaceId place : used)
    if ((*end)[place.value] > 0) names.push_back(net[place].name);
  return names;
}

}  // namespace

std::string headline(const verify::PropertyResult& property) {
  const bool holds = property.verdict == verify::Verdict::holds;
  // Leaves out what the waits say already.
  const bool said = std::ranges::any_of(
      property.waits, [&](const auto& wait) { return property.why.find(wait.text) != std::string::npos; });
  return fmt::format("{}{}: {} ({}{}{})\n", property.warning && !holds ? "warning: " : "", property.name,
                     name_of(property.verdict), property.method, property.why.empty() || said ? "" : ": ",
                     said ? "" : property.why);
}

std::string run_text(const net::Net& judged, const verify::PropertyResult& property) {
  const net::Net net = net_of_run(judged, property);
  if (property.trace.empty()) return "  it is so from the start\n";
  std::string text = fmt::format("  a run of {} firing{} shows it:\n", property.trace.size(),
                                 property.trace.size() == 1 ? "" : "s");
  text += of_layers(net) ? told(verify::narrate(net, property.trace)) : listed(net, property.trace);
  const std::vector<std::string> channels = channels_after(net, property.trace);
  if (!channels.empty()) text += "  channels at the end:\n";
  for (std::size_t index = 0; index < std::min(channels.size(), shown_channels); ++index)
    text += "    " + channels[index] + "\n";
  return text + (channels.size() > shown_channels ? left_out(channels.size() - shown_channels, "more") : "");
}

std::string text_of(const net::Net& judged, const verify::PropertyResult& property) {
  std::string text = headline(property);
  for (const verify::SubsystemAtEnd& wait : property.waits) text += "  " + wait.text + "\n";
  if (property.has_trace && !property.warning) text += run_text(judged, property);
  if (!property.cut_off.empty()) text += "  cut off: " + property.cut_off + "\n";
  if (!property.hint.empty()) text += "  hint: " + property.hint + "\n";
  return text;
}

}  // namespace tessera::project
