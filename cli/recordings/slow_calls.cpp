#include "cli/recordings/slow_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "replay/robots.hpp"
#include "replay/times/call_durations.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {
namespace {

using BehaviourOfRun = std::pair<std::string, std::string>;  // path of the subsystem, name

/// The places in the result of the behaviours that declare what they take.
std::map<BehaviourOfRun, std::size_t> declared_behaviours(const spec::Model& model,
                                                          std::vector<report::SlowCalls>& all) {
  std::map<BehaviourOfRun, std::size_t> places;
  for (const spec::InstanceId instance : model.instances.ids())
    for (const spec::Behaviour& behaviour : model.subsystem(instance).behaviours) {
      if (behaviour.is_group() || !behaviour.takes.is_declared()) continue;
      const std::string path = model.instance_path(instance);
      places.emplace(BehaviourOfRun{path, behaviour.name}, all.size());
      all.push_back(
          {.behaviour = path + "." + behaviour.name, .declared_ns = behaviour.takes.longest.count()});
    }
  return places;
}

}  // namespace

std::vector<report::SlowCalls> slow_calls_in(const std::string& recording, const spec::Model& model) {
  std::vector<report::SlowCalls> all;
  const std::map<BehaviourOfRun, std::size_t> places = declared_behaviours(model, all);
  // A pipe can be read once, by whoever it is for.
  if (places.empty() || !std::filesystem::is_regular_file(recording)) return {};
  replay::PoseReader reader(recording);
  replay::CallReader calls;
  while (const Recording::Entry* const entry = reader.next()) {
    const Recording& header = *reader.header();
    if (header.clock == "simulated") return {};
    const std::optional<replay::FinishedCall> call = calls.follow(header, *entry);
    if (!call) continue;
    const auto found = places.find({header.instances[call->instance], std::string(call->behaviour)});
    if (found == places.end()) continue;
    report::SlowCalls& one = all[found->second];
    ++one.calls;
    one.slow += static_cast<std::uint64_t>(call->took_ns > one.declared_ns);
    if (call->took_ns <= one.longest_ns) continue;
    one.longest_ns = call->took_ns;
    one.longest_at_ns = call->since_ns;
  }
  std::erase_if(all, [](const report::SlowCalls& one) { return one.slow == 0; });
  return all;
}

std::string slow_calls_text(const std::vector<report::SlowCalls>& all) {
  constexpr std::size_t shown = 12;
  std::string text;
  for (std::size_t index = 0; index < std::min(all.size(), shown); ++index) {
    const report::SlowCalls& one = all[index];
    text += fmt::format(
        "overtime: {}: {} of {} calls took longer than its takes of {:g} ms; the longest took {:.3f} ms, at "
        "{:.3f} s\n",
        printable(one.behaviour), one.slow, one.calls, static_cast<double>(one.declared_ns) * 1e-6,
        static_cast<double>(one.longest_ns) * 1e-6, static_cast<double>(one.longest_at_ns) * 1e-9);
  }
  if (all.size() > shown) text += fmt::format("overtime: ... and {} more behaviours\n", all.size() - shown);
  return text;
}

nlohmann::json slow_calls_json(const std::vector<report::SlowCalls>& all) {
  nlohmann::json list = nlohmann::json::array();
  for (const report::SlowCalls& one : all)
    list.push_back({{"behaviour", one.behaviour},
                    {"calls", one.calls},
                    {"slow", one.slow},
                    {"declared_ns", one.declared_ns},
                    {"longest_ns", one.longest_ns},
                    {"longest_at_ns", one.longest_at_ns}});
  return list;
}

}  // namespace tessera::cli
