#include "cli/timing/chain_verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "cli/timing/conduct_texts.hpp"
#include "cli/timing/time_texts.hpp"
#include "spec/model/chain_ways.hpp"
#include "timing/conduct/drift.hpp"
#include "timing/words.hpp"
#include "timing/worst/worst_run.hpp"

namespace tessera::cli {
namespace {

/// "at most 82 ms", "holds (exact: 82 ms; asked 100 ms)", "at most 142 ms, asked 120 ms: not proved"
std::string answer_text(timing::Answer answer, const std::optional<timing::Time>& asked, timing::Time bound,
                        bool exact, const std::optional<timing::Time>& shown) {
  const std::string is = exact ? "exact: " : "at most ";
  switch (answer) {
    case timing::Answer::holds:
      return fmt::format("holds ({}{}; asked {})", is, time_text(bound), time_text(*asked));
    case timing::Answer::violated:
      if (!exact && shown)
        return fmt::format("violated (a run takes {}, none more than {}; asked {})", time_text(*shown),
                           time_text(bound), time_text(*asked));
      return fmt::format("violated ({}{}; asked {})", is, time_text(bound), time_text(*asked));
    case timing::Answer::unknown:
      return fmt::format("at most {}, asked {}: not proved", time_text(bound), time_text(*asked));
    case timing::Answer::none:
    case timing::Answer::not_asked:
      break;
  }
  return (exact ? "" : "at most ") + time_text(bound);
}

verify::Verdict worse_of(verify::Verdict a, verify::Verdict b) {
  if (a == verify::Verdict::violated || b == verify::Verdict::violated) return verify::Verdict::violated;
  return a == verify::Verdict::unknown ? a : b;
}

verify::Verdict verdict_on(timing::Answer answer) {
  if (answer == timing::Answer::violated) return verify::Verdict::violated;
  return answer == timing::Answer::unknown || answer == timing::Answer::none ? verify::Verdict::unknown
                                                                             : verify::Verdict::holds;
}

/// Lines of which those of the members of a fleet are one.
class VerdictLines {
 public:
  void add(const std::string& name, const std::string& text) {
    const auto [at, is_new] =
        line_of_.try_emplace({spec::fleet_name_of(name), spec::fleet_name_of(text)}, lines_.size());
    if (is_new) lines_.push_back({name, text});
    ++lines_[at->second].count;
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const Line& line : lines_)
      all += fmt::format("  {}: {}{}\n", line.name, line.text,
                         line.count > 1 ? fmt::format(" (so in {} agents)", line.count) : "");
    return all;
  }

 private:
  struct Line {
    std::string name, text;
    std::size_t count = 0;
  };
  std::vector<Line> lines_;
  std::map<std::pair<std::string, std::string>, std::size_t> line_of_;
};

nlohmann::json chain_json(const timing::DeclaredChain& chain, const timing::ChainVerdict& verdict) {
  nlohmann::json one{{"chain", chain.name}, {"leads", chain.leads}};
  if (verdict.why.empty())
    one.update({{"age_ns", verdict.bound.age},
                {"reaction_ns", verdict.bound.reaction},
                {"start_ns", verdict.bound.start},
                {"exact", verdict.exact},
                {"exact_age", verdict.exact_age},
                {"exact_reaction", verdict.exact_reaction}});
  else
    one["why"] = verdict.why;
  if (chain.age) one.update({{"asked_age_ns", *chain.age}, {"age", timing::word_of(verdict.age)}});
  if (chain.reaction)
    one.update({{"asked_reaction_ns", *chain.reaction}, {"reaction", timing::word_of(verdict.reaction)}});
  return one;
}

std::string rate_text(timing::Time period) {
  return fmt::format("{:.6g} Hz", 1e9 / static_cast<double>(period));
}

/// The rate because of which the bounds of a chain are sums.
std::string drift_text(const timing::Drift& drift, const spec::Model& model) {
  std::string better;
  for (const timing::Time period : drift.better)
    better += (better.empty() ? "; it would with " : " or ") + rate_text(period);
  return fmt::format("its bounds are sums: the period of {} ({}, {}) does not go into those of the others{}",
                     model.instance_path(spec::InstanceId{drift.subsystem}), least_time_text(drift.period),
                     rate_text(drift.period), better);
}
std::optional<timing::Drift> drift_of(const timing::Bounds& bounds, const timing::DeclaredChain& chain) {
  for (const timing::Chain& way : chain.ways)
    if (const std::optional<timing::Drift> drift = timing::drift_of(bounds, way)) return drift;
  return std::nullopt;
}

}  // namespace

verify::Verdict overall(const timing::ChainVerdict& verdict) {
  return worse_of(verdict_on(verdict.age), verdict_on(verdict.reaction));
}

std::string verdict_text(const timing::DeclaredChain& chain, const timing::ChainVerdict& verdict) {
  if (!verdict.why.empty()) {
    std::string asked;
    if (chain.age) asked += "; asked: age " + time_text(*chain.age);
    if (chain.reaction)
      asked += (asked.empty() ? "; asked: reaction " : ", reaction ") + time_text(*chain.reaction);
    return "none: " + verdict.why + asked;
  }
  std::string text =
      "age " + answer_text(verdict.age, chain.age, verdict.bound.age, verdict.exact_age, verdict.shown_age) +
      ", reaction " +
      answer_text(verdict.reaction, chain.reaction, verdict.bound.reaction, verdict.exact_reaction,
                  verdict.shown_reaction);
  const bool asks = chain.age || chain.reaction;
  return text + (verdict.exact && !asks ? " (exact: some run takes so long)" : "");
}

ChainVerdicts chain_verdicts(const spec::Model& model, const timing::StopAsked& stop, bool explained) try {
  ChainVerdicts result{{}, {}, nlohmann::json::array(), nlohmann::json::object()};
  const timing::Declared declared = timing::declared(model);
  if (!timing::says_times(model)) {
    if (!declared.chains.empty())
      result.explained =
          "times: not known: no behaviour says what its calls take, for example follow: { takes: 1..3 ms }\n";
    return result;
  }
  if (declared.chains.empty()) return result;
  const timing::Bounds bounds(declared.system, stop);
  timing::WorstRunSearch search(declared, bounds, stop);
  VerdictLines lines;
  const timing::DeclaredChain* unbounded = nullptr;  // the last one that has no bound
  for (const timing::DeclaredChain& chain : declared.chains) {
    timing::check(stop);
    timing::ChainVerdict verdict = timing::judge(declared, model, bounds, chain);
    if (verdict.why.empty() && (explained || timing::is_open(verdict)))
      timing::take_runs(verdict, chain, search.find(chain));
    if (result.violated.empty() && overall(verdict) == verify::Verdict::violated)
      result.violated = chain.name;
    result.json.push_back(chain_json(chain, verdict));
    result.overall = worse_of(result.overall, overall(verdict));
    lines.add(chain.name, verdict_text(chain, verdict));
    if (!verdict.why.empty()) {
      unbounded = &chain;
      continue;
    }
    if (const std::optional<timing::Drift> drift = drift_of(bounds, chain)) {
      lines.add(chain.name, drift_text(*drift, model));
      result.json.back()["drifts"] = model.instance_path(spec::InstanceId{drift->subsystem});
    }
  }
  const std::string missing =
      unbounded == nullptr
          ? ""
          : fmt::format("  (tessera verify --explain \"{}\" names all that is missing)\n", unbounded->name);
  const timing::Conduct conduct = timing::conduct_of(declared, bounds);
  VerdictLines notable, all;
  for (const ConductLine& line : lines_of(conduct, declared, model)) {
    all.add(line.name, line.text);
    if (line.is_notable) notable.add(line.name, line.text);
  }
  result.conduct = conduct_json(conduct, declared, model);
  const std::string see =
      result.violated.empty()
          ? std::string()
          : fmt::format(
                "  `tessera verify --explain \"{}\"` tells a run that shows it, --scenario FILE writes it\n",
                result.violated);
  result.text = assumptions_of_times + lines.text() + see + missing + notable.text();
  result.explained = assumptions_of_times + lines.text() + see + missing + all.text();
  return result;
} catch (const timing::Interrupted&) {
  ChainVerdicts result{"times: not computed: the time limit is reached, or the search was stopped\n",
                       {},
                       nlohmann::json::array(),
                       nlohmann::json::object()};
  result.explained = result.text;
  result.conduct["why"] = "the time limit is reached, or the search was stopped";
  if (model.timing.chains && std::ranges::any_of(*model.timing.chains, &spec::TimedChain::asks))
    result.overall = verify::Verdict::unknown;
  return result;
}

}  // namespace tessera::cli
