#include "cli/timing/chain_verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "cli/timing/conduct_texts.hpp"
#include "cli/timing/time_texts.hpp"
#include "spec/model/chain_ways.hpp"
#include "timing/words.hpp"

namespace tessera::cli {
namespace {

/// "at most 82 ms", "holds (exact: 82 ms; asked 100 ms)", "at most 142 ms, asked 120 ms: not proved"
std::string answer_text(timing::Answer answer, const std::optional<timing::Time>& asked, timing::Time bound,
                        bool exact) {
  const std::string is = exact ? "exact: " : "at most ";
  switch (answer) {
    case timing::Answer::holds:
      return fmt::format("holds ({}{}; asked {})", is, time_text(bound), time_text(*asked));
    case timing::Answer::violated:
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
                {"exact", verdict.exact}});
  else
    one["why"] = verdict.why;
  if (chain.age) one.update({{"asked_age_ns", *chain.age}, {"age", timing::word_of(verdict.age)}});
  if (chain.reaction)
    one.update({{"asked_reaction_ns", *chain.reaction}, {"reaction", timing::word_of(verdict.reaction)}});
  return one;
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
  std::string text = "age " + answer_text(verdict.age, chain.age, verdict.bound.age, verdict.exact) +
                     ", reaction " +
                     answer_text(verdict.reaction, chain.reaction, verdict.bound.reaction, verdict.exact);
  const bool asks = chain.age || chain.reaction;
  return text + (verdict.exact && !asks ? " (exact: some run takes so long)" : "");
}

ChainVerdicts chain_verdicts(const spec::Model& model, const timing::StopAsked& stop) try {
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
  VerdictLines lines;
  const timing::DeclaredChain* unbounded = nullptr;  // the last one that has no bound
  for (const timing::DeclaredChain& chain : declared.chains) {
    timing::check(stop);
    const timing::ChainVerdict verdict = timing::judge(declared, model, bounds, chain);
    result.json.push_back(chain_json(chain, verdict));
    result.overall = worse_of(result.overall, overall(verdict));
    lines.add(chain.name, verdict_text(chain, verdict));
    if (!verdict.why.empty()) unbounded = &chain;
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
  result.text = assumptions_of_times + lines.text() + missing + notable.text();
  result.explained = assumptions_of_times + lines.text() + missing + all.text();
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
