#include "subsystem/scenario.hpp"

#include <fmt/core.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <unordered_map>

#include "tessera/recording.hpp"
#include "tessera/result.hpp"

namespace tessera {
namespace {

[[nodiscard]] std::optional<std::uint32_t> instance_at(const System& system, std::string_view path) {
  for (std::uint32_t index = 0; index < system.instances.size(); ++index) {
    const Instance& instance = system.instances[index];
    if (path == fmt::format("{}.{}", instance.agent, instance.name)) return index;
  }
  return std::nullopt;
}

class Reading {
 public:
  Reading(const System& system, const FlatNet& net) : system_(system), net_(net) {
    for (std::uint32_t index = 0; index < net.transitions.size(); ++index)
      known_.emplace(net.transitions[index].name, index);
  }

  /// Returns the mistake.
  [[nodiscard]] std::optional<Problem> read(const nlohmann::json& json, Scenario& scenario) const {
    if (json.value("scenario", 0) != 1) return Problem{"is no scenario of this version of Tessera"};
    const std::string hash = json.at("net_hash").get<std::string>();
    if (hash != system_.net_hash)
      return Problem{fmt::format("is a scenario of another net ({}, this controller's is {}): verify again",
                                 hash, system_.net_hash)};
    if (json.contains("times")) return read_times(json.at("times"), scenario.times.emplace());
    for (const nlohmann::json& firing : json.at("firings")) {
      const auto name = (firing.is_object() ? firing.at("name") : firing).get<std::string>();
      const bool known = firing.is_object()
                             ? add_outcome(name, firing.at("none_holds").get<std::string>(), scenario)
                             : add(name, scenario);
      if (!known) return Problem{fmt::format("names '{}', which is no transition of this net", name)};
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::optional<Problem> read_times(const nlohmann::json& json, ForcedTimes& times) const {
    bool is_wrong = false;
    times.end = Time(Duration(json.at("to_ns").get<std::int64_t>()));
    times.calls.resize(system_.instances.size());
    times.place.assign(system_.instances.size(), static_cast<std::uint32_t>(system_.instances.size()));
    std::uint32_t place = 0;
    for (const nlohmann::json& one : json.at("subsystems")) {
      const auto path = one.at("subsystem").get<std::string>();
      const std::optional<std::uint32_t> instance = instance_at(system_, path);
      if (!instance) return Problem{fmt::format("names '{}', which is no subsystem of this system", path)};
      if (!times.calls[*instance].empty()) return Problem{fmt::format("names '{}' twice", path)};
      times.place[*instance] = place++;
      for (const nlohmann::json& call : one.at("calls")) {
        times.calls[*instance].push_back({Duration(call.at("takes_ns").get<std::int64_t>()),
                                          Duration(call.value("late_ns", std::int64_t{0})),
                                          call.value("order", 0)});
        is_wrong = is_wrong || times.calls[*instance].back().takes < Duration::zero() ||
                   times.calls[*instance].back().late < Duration::zero();
      }
    }
    if (is_wrong || times.end <= Time{}) return Problem{"has times below 0"};
    return std::nullopt;
  }

  /// No condition of `next` holds in the subsystem with that path.
  [[nodiscard]] bool add_outcome(const std::string& name, std::string_view path, Scenario& scenario) const {
    const std::optional<std::uint32_t> owner = instance_at(system_, path);
    if (owner) scenario.steps.push_back({*owner, std::nullopt, name});
    return owner.has_value();
  }

  [[nodiscard]] bool add(const std::string& name, Scenario& scenario) const {
    const auto found = known_.find(name);
    if (found == known_.end()) return false;
    const std::uint32_t instance = net_.transitions[found->second].instance;
    if (instance != system_instance)
      scenario.steps.push_back({instance, found->second - net_.first_of_instance[instance], name});
    return true;
  }

  const System& system_;
  const FlatNet& net_;
  std::unordered_map<std::string_view, std::uint32_t> known_;
};

}  // namespace

Scenario::Script Scenario::of_instance(std::uint32_t instance) const {
  Script own;
  for (const Step& step : steps)
    if (step.instance == instance) own.push_back(step.transition);
  return own;
}

std::optional<Scenario> read_scenario(const std::string& file, const System& system, const FlatNet& net,
                                      std::string& error) {
  std::ifstream stream(file);
  if (!stream) {
    error = fmt::format("cannot read '{}'", file);
    return std::nullopt;
  }
  Scenario scenario;
  std::optional<Problem> wrong;
  try {
    wrong = Reading(system, net).read(nlohmann::json::parse(stream), scenario);
  } catch (const nlohmann::json::exception&) {
    wrong = Problem{"is no scenario: write one with `tessera verify --scenario FILE`"};
  }
  if (!wrong) return scenario;
  error = fmt::format("'{}' {}", file, wrong->text);
  return std::nullopt;
}

}  // namespace tessera
