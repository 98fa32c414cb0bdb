#include "cli/timing/chain_explanation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/timing/chain_verdicts.hpp"
#include "cli/timing/time_texts.hpp"
#include "cli/timing/worst_run_texts.hpp"
#include "timing/changes.hpp"
#include "timing/steps.hpp"
#include "timing/words.hpp"

namespace tessera::cli {
namespace {

using nlohmann::json;

class ChainExplainer {
 public:
  ChainExplainer(const spec::Model& model, const timing::Declared& declared,
                 const timing::DeclaredChain& chain, const timing::StopAsked& stop)
      : model_(model), declared_(declared), chain_(chain), stop_(stop), bounds_(declared.system, stop) {}

  ChainExplanation explain() {
    timing::ChainVerdict verdict = timing::judge(declared_, model_, bounds_, chain_);
    timing::WorstRunSearch search(declared_, bounds_, stop_);
    const timing::WorstRuns runs = search.find(chain_);
    timing::take_runs(verdict, chain_, runs);
    ChainExplanation result{assumptions_of_times + chain_.name +
                                (chain_.is_named ? ": " + chain_.leads : "") + "\n  " +
                                verdict_text(chain_, verdict) + "\n",
                            {{"chain", chain_.name}, {"leads", chain_.leads}},
                            overall(verdict)};
    if (verdict.why.empty()) {
      tell_steps(result);
      tell_runs(verdict, search, runs, result);
    } else {
      result.json["why"] = verdict.why;
      result.json["missing"] = timing::missing_for(declared_, chain_);
      for (const std::string& one : timing::missing_for(declared_, chain_))
        result.text += "  missing: " + one + "\n";
    }
    tell_changes(verdict, result);
    return result;
  }

 private:
  void tell_steps(ChainExplanation& result) const {
    const timing::ChainSteps steps = timing::steps_of(bounds_, chain_.ways, chain_.foreign);
    tell("age", steps.age, /*is_age=*/true, result);
    tell("reaction", steps.reaction, /*is_age=*/false, result);
  }

  void tell_runs(const timing::ChainVerdict& verdict, const timing::WorstRunSearch& search,
                 const timing::WorstRuns& runs, ChainExplanation& result) const {
    if (!runs.age && !runs.reaction) {
      for (const timing::Chain& way : chain_.ways)
        if (const std::string why = search.obstacle(way, model_); !why.empty()) {
          result.text += "  no run is searched that takes so long: " + why + "\n";
          return;
        }
    }
    const auto tell_one = [&](const std::optional<timing::WorstRun>& run, const char* name, bool is_age,
                              timing::Time bound) {
      if (!run) return;
      result.text += story_of(*run, is_age, bound, declared_, model_);
      result.json["runs"][name] = {{"from_ns", run->from}, {"to_ns", run->to}, {"reaches", run->reaches}};
    };
    tell_one(runs.age, "age", /*is_age=*/true, verdict.bound.age);
    tell_one(runs.reaction, "reaction", /*is_age=*/false, verdict.bound.reaction);
  }

  void tell(const char* name, const std::vector<timing::Step>& steps, bool is_age,
            ChainExplanation& result) const {
    timing::Time total = 0;
    for (const timing::Step& step : steps) total += step.time;
    result.text += fmt::format("  {} {}:\n", name, time_text(total));
    json all = json::array();
    timing::Time until = 0;
    for (const timing::Step& step : steps) {
      until += step.time;
      result.text += fmt::format("    {:>10}  {:>10}  {}\n", "+" + time_text(step.time), time_text(until),
                                 words_of(step, is_age));
      json one{{"kind", timing::word_of(step.kind)}, {"ns", step.time}};
      if (step.kind == timing::Step::Kind::foreign)
        one["node"] = chain_.foreign[step.channel].node;
      else
        one["subsystem"] = path(step.subsystem);
      if (step.kind == timing::Step::Kind::until_read || step.kind == timing::Step::Kind::network)
        one["channel"] = channel(step.channel);
      all.push_back(std::move(one));
    }
    result.json["steps"][name] = std::move(all);
  }

  [[nodiscard]] std::string words_of(const timing::Step& step, bool is_age) const {
    const std::string who = path(step.subsystem);
    switch (step.kind) {
      case timing::Step::Kind::next_reading:
        return who + " has just read its device: until it reads the next time";
      case timing::Step::Kind::network:
        return fmt::format("the value is on the way to {} (`network`)", who);
      case timing::Step::Kind::foreign:
        return chain_.foreign[step.channel].node + " answers (`takes`)";
      case timing::Step::Kind::until_read:
        return fmt::format("the value stands in {} until {} receives it{}", channel(step.channel), who,
                           is_age ? " for the last time" : "");
      case timing::Step::Kind::until_begin:
        return who + " uses it in its next iteration: until that begins";
      case timing::Step::Kind::latency:
        return who + " goes on later than it may (`latency`)";
      case timing::Step::Kind::processor:
        return who + " waits for its processor";
      case timing::Step::Kind::takes:
        return who + " calls its transition function (`takes`)";
      case timing::Step::Kind::until_sent:
        break;
    }
    return who + " waits in sends before this one";
  }

  void tell_changes(const timing::ChainVerdict& verdict, ChainExplanation& result) const {
    constexpr std::size_t most_told = 5;
    const std::vector<timing::Change> changes = timing::changes_for(declared_, chain_, stop_);
    result.json["changes"] = json::array();
    for (std::size_t at = 0; at < changes.size(); ++at) {
      const timing::Change& change = changes[at];
      result.json["changes"].push_back({{"kind", timing::word_of(change.kind)},
                                        {"change", words_of(change)},
                                        {"age_ns", time_json(change.age)},
                                        {"reaction_ns", time_json(change.reaction)}});
      if (at >= most_told) continue;
      result.text += fmt::format("  {}: {}: age {}, reaction {}\n", at == 0 ? "what helps most" : "also",
                                 words_of(change), from_to(verdict, verdict.bound.age, change.age),
                                 from_to(verdict, verdict.bound.reaction, change.reaction));
    }
    if (changes.empty()) result.text += "  no single change of a rate, a mode or a processor helps\n";
  }

  static json time_json(timing::Time time) { return time >= timing::unbounded ? json(nullptr) : json(time); }
  static std::string from_to(const timing::ChainVerdict& verdict, timing::Time from, timing::Time to) {
    return bound_text(verdict.why.empty() ? from : timing::unbounded) + " -> " + bound_text(to);
  }

  [[nodiscard]] std::string words_of(const timing::Change& change) const {
    const std::string who = path(change.subsystem);
    switch (change.kind) {
      case timing::Change::Kind::twice_the_rate:
        return "twice the rate of " + who;
      case timing::Change::Kind::event_driven: {
        const bool waits = declared_.system.channels[change.channel].receive_blocks;
        return "event-driven " + who + " (no rate" +
               (waits ? ")" : ", `receive: blocking` over " + channel(change.channel) + ")");
      }
      case timing::Change::Kind::receive_waits:
        return "`receive: blocking` over " + channel(change.channel);
      case timing::Change::Kind::receive_goes_on:
        return "`receive: non_blocking` over " + channel(change.channel);
      case timing::Change::Kind::send_waits:
        return "`send: blocking` over " + channel(change.channel);
      case timing::Change::Kind::send_goes_on:
        return "`send: non_blocking` over " + channel(change.channel);
      case timing::Change::Kind::own_processor:
        break;
    }
    return "a processor of its own for " + who;
  }

  [[nodiscard]] std::string path(std::uint32_t subsystem) const {
    return model_.instance_path(spec::InstanceId{subsystem});
  }
  [[nodiscard]] std::string channel(std::uint32_t channel) const {
    return model_.channel_name(model_.channels[spec::ChannelId{channel}]);
  }

  const spec::Model& model_;
  const timing::Declared& declared_;
  const timing::DeclaredChain& chain_;
  const timing::StopAsked& stop_;
  timing::Bounds bounds_;
};

}  // namespace

std::vector<std::string> chain_names(const spec::Model& model) {
  std::vector<std::string> names;
  for (const timing::DeclaredChain& chain : timing::declared(model).chains) names.push_back(chain.name);
  return names;
}

std::optional<ChainExplanation> explain_chain(const spec::Model& model, const std::string& name,
                                              const timing::StopAsked& stop) {
  const timing::Declared declared = timing::declared(model);
  const auto chain = std::ranges::find(declared.chains, name, &timing::DeclaredChain::name);
  if (chain == declared.chains.end()) return std::nullopt;
  return ChainExplainer(model, declared, *chain, stop).explain();
}

}  // namespace tessera::cli
