#include "cli/timing/reenactment.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/timing/time_texts.hpp"
#include "replay/times/measured_ages.hpp"

namespace tessera::cli {
namespace {

std::string times_text(const char* name, std::int64_t from_ns, std::int64_t to_ns) {
  return fmt::format("{} {}, from {:.9g} s to {:.9g} s", name, time_text(to_ns - from_ns),
                     static_cast<double>(from_ns) * 1e-9, static_cast<double>(to_ns) * 1e-9);
}

}  // namespace

std::optional<PromisedTimes> promised_times(const std::filesystem::path& scenario) try {
  std::ifstream stream(scenario);
  const nlohmann::json json = nlohmann::json::parse(stream);
  if (!json.contains("times")) return std::nullopt;
  const nlohmann::json& times = json.at("times");
  return PromisedTimes{times.at("chain").get<std::string>(), times.at("of").get<std::string>() == "age",
                       times.at("from_ns").get<std::int64_t>(), times.at("to_ns").get<std::int64_t>()};
} catch (const nlohmann::json::exception&) {
  return std::nullopt;
}

Reenactment compare(const PromisedTimes& promised, const Recording& recording, const spec::Model& model) {
  const char* const name = promised.is_age ? "age" : "reaction";
  std::vector<replay::MeasuredChain> chains = replay::measured_chains(model);
  std::erase_if(chains, [&](const replay::MeasuredChain& chain) { return chain.name != promised.chain; });
  const std::string promise = times_text(name, promised.from_ns, promised.to_ns);
  const std::string head = promised.chain + ": ";
  if (chains.empty()) return {head + "this system has no such chain, of which the scenario is", false};
  replay::Ages ages(std::move(chains));
  ages.add(recording);
  const std::vector<replay::ChainAges> all = ages.finish();
  const replay::MeasuredTimes& measured = promised.is_age ? all.front().age : all.front().reaction;
  if (measured.count == 0) return {head + "no command was given; in the scenario, " + promise, false};
  const std::string measure = times_text(name, measured.worst_from_ns, measured.worst_to_ns);
  if (measured.worst_to_ns == promised.to_ns && measured.most == promised.to_ns - promised.from_ns)
    return {head + measure + ", as in the scenario", true};
  return {head + measure + ", but " + promise + " in the scenario: the times of the specification differ",
          false};
}

}  // namespace tessera::cli
