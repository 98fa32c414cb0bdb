// The verdicts on chains.
#include <algorithm>
#include <set>
#include <utility>

#include "timing/declared.hpp"

namespace tessera::timing {
namespace {

/// The subsystems of a chain, then those that they wait for, and so on.
std::vector<std::uint32_t> depends_on(const System& system, const Chain& chain) {
  std::vector<std::uint32_t> level;
  std::set<std::uint32_t> seen;
  const auto reach = [&](std::uint32_t i) {
    if (seen.insert(i).second) level.push_back(i);
  };
  for (const std::uint32_t c : chain) {
    reach(system.channels[c].from);
    reach(system.channels[c].to);
  }
  for (std::size_t at = 0; at < level.size(); ++at) {
    const std::uint32_t i = level[at];
    for (const std::uint32_t c : system.subsystems[i].receives)
      if (system.channels[c].receive_blocks) reach(system.channels[c].from);
    for (const std::uint32_t c : system.subsystems[i].sends)
      if (system.channels[c].send_blocks) reach(system.channels[c].to);
  }
  return level;
}

/// The nearest reason why something that the chain depends on is not bounded.
std::string reason(const Declared& declared, const spec::Model& model, const Bounds& bounds,
                   const Chain& chain) {
  const System& system = declared.system;
  for (const std::uint32_t i : depends_on(system, chain)) {
    if (!declared.missing[i].empty()) return declared.missing[i];
    if (bounds.occurrences().response(i) >= unbounded)
      return model.instance_path({i}) + " shares its processor with others that may never leave it";
  }
  for (const std::uint32_t c : chain)
    if (!bounds.occurrences().keeps_values(c))
      return model.channel_name(model.channels[spec::ChannelId{c}]) +
             " may take a value back before it is read, since its send may time out";
  return "its subsystems wait for each other without a bound";
}

/// Each iteration begins at its instant, nobody waits, and each subsystem has a processor of its own, the same times in
/// all its behaviours, and comes once: then calls can be chosen that reach the bounds.
bool is_exact(const Declared& declared, const Bounds& bounds, const Chain& chain) {
  const System& system = declared.system;
  if (system.latency > 0) return false;
  std::set<std::uint32_t> path{system.channels[chain.front()].from};
  for (const std::uint32_t c : chain) {
    const Channel& channel = system.channels[c];
    if (system.crosses(c) || channel.send_blocks || channel.receive_blocks || !path.insert(channel.to).second)
      return false;
  }
  return std::ranges::all_of(path, [&](std::uint32_t i) {
    return bounds.occurrences().periodic(i) && !bounds.occurrences().waits(i) && !declared.differ[i] &&
           system.subsystems[i].processor < 0 && system.subsystems[i].longest <= system.subsystems[i].period;
  });
}

/// exact: some run reaches the bound.
Answer answer(const std::optional<Time>& asked, Time bound, bool exact) {
  if (!asked) return Answer::not_asked;
  if (bound >= unbounded) return Answer::none;
  if (bound <= *asked) return Answer::holds;
  return exact ? Answer::violated : Answer::unknown;
}

}  // namespace

ChainVerdict judge(const Declared& declared, const spec::Model& model, const Bounds& bounds,
                   const DeclaredChain& chain) {
  ChainVerdict verdict{{0, 0, 0, true}, true, chain.unused};
  if (!chain.unused.empty()) verdict.bound = {};
  for (const Chain& way : chain.ways) {
    const ChainBound bound = bound_of(bounds, way, chain.foreign);
    verdict.exact =
        verdict.exact && chain.foreign.empty() && bound.enumerated && is_exact(declared, bounds, way);
    verdict.bound.age = std::max(verdict.bound.age, bound.age);
    verdict.bound.reaction = std::max(verdict.bound.reaction, bound.reaction);
    verdict.bound.start = std::max(verdict.bound.start, bound.start);
    verdict.bound.enumerated = verdict.bound.enumerated && bound.enumerated;
    if (bound.reaction >= unbounded && verdict.why.empty())
      verdict.why = reason(declared, model, bounds, way);
  }
  if (!verdict.why.empty()) verdict.exact = false;
  verdict.exact_age = verdict.exact_reaction = verdict.exact;
  // Without a bound for one of the two, the verdict names none.
  const bool has_bound = verdict.why.empty();
  verdict.age = answer(chain.age, has_bound ? verdict.bound.age : unbounded, verdict.exact);
  verdict.reaction = answer(chain.reaction, has_bound ? verdict.bound.reaction : unbounded, verdict.exact);
  return verdict;
}

std::vector<std::string> missing_for(const Declared& declared, const DeclaredChain& chain) {
  std::vector<std::string> all;
  if (!chain.unused.empty()) all.push_back(chain.unused);
  for (const Chain& way : chain.ways)
    for (const std::uint32_t i : depends_on(declared.system, way))
      for (const std::string& one : declared.all_missing[i])
        if (std::ranges::find(all, one) == all.end()) all.push_back(one);
  return all;
}

void note_missing(const spec::Model& model, diagnostics::Diagnostics& out) {
  if (!model.timing.chains || std::ranges::none_of(*model.timing.chains, &spec::TimedChain::asks)) return;
  constexpr std::size_t most_told = 3;
  const Declared all = declared(model);
  std::set<std::pair<std::uint32_t, std::uint32_t>> noted;  // the chains of a fleet have one place
  for (std::size_t at = 0; at < all.chains.size(); ++at) {
    const spec::TimedChain& asked = (*model.timing.chains)[at];
    if (!asked.asks()) continue;
    const std::vector<std::string> missing = missing_for(all, all.chains[at]);
    if (missing.empty() || !noted.emplace(asked.span.line, asked.span.column).second) continue;
    std::string more;
    for (std::size_t other = 1; other < std::min(missing.size(), most_told); ++other)
      more += (more.empty() ? "also: " : ", ") + missing[other];
    if (missing.size() > most_told) more += " and " + std::to_string(missing.size() - most_told) + " more";
    out.note("N341", asked.span,
             "nothing bounds the times of chain '" + asked.name + "' yet: " + missing.front(),
             more.empty() ? "as long as it is so, `tessera verify` cannot prove what is asked" : more);
  }
}

}  // namespace tessera::timing
