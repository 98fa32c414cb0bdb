#include "verify/deciders/exploration_findings.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "explore/explore.hpp"
#include "verify/counterexample/causes.hpp"
#include "verify/counterexample/explanation.hpp"
#include "verify/search/parts.hpp"

namespace tessera::verify {

using explore::Formula;
using net::PlaceId;
using net::TransitionId;

Finding judged(const Found& found, Found::Kind good) {
  Finding finding;
  finding.states = found.states;
  finding.explanation = found.explanation;
  finding.why = found.why;
  if (found.kind == Found::Kind::unknown) return finding;
  finding.kind = found.kind == good ? Finding::Kind::holds : Finding::Kind::violated;
  finding.trace = found.trace;
  finding.has_trace = finding.kind == Finding::Kind::violated;
  return finding;
}

static std::uint64_t few_markings(const net::Net& net) {
  constexpr std::uint64_t most = 50'000, fewest = 1'000, work = 100'000'000;
  return std::clamp(work / std::max<std::size_t>(net.transitions().size(), 1), fewest, most);
}

explore::Limits with_few_markings(const net::Net& net, explore::Limits limits) {
  limits.markings = std::min(limits.markings, few_markings(net));
  return limits;
}

void name_absences(std::vector<SubsystemAtEnd>& waits, const NetUnderAssumption& given) {
  if (!given.communication.structure) return;
  std::map<std::string, const ChannelFlow*> absences;
  for (const ChannelFlow& channel : given.communication.structure->channels)
    if (!channel.absence.empty()) absences[channel.name] = &channel;
  std::erase_if(waits, [&](const SubsystemAtEnd& one) {
    const auto found = absences.find(one.channel);
    return one.state == SubsystemAtEnd::State::gives_no_more && found != absences.end() &&
           one.path == found->second->absent;
  });
  for (SubsystemAtEnd& one : waits) {
    const auto found = absences.find(one.channel);
    if (found == absences.end()) continue;
    const ChannelFlow& channel = *found->second;
    if (one.state == SubsystemAtEnd::State::waits && std::ranges::count(one.from, channel.absent) > 0)
      one.text = with_absence(std::move(one.text), channel);
    if (one.state == SubsystemAtEnd::State::takes_no_more && one.path == channel.absent)
      one.text += ": " + channel.absence;
  }
}

void explain(Finding& finding, const NetUnderAssumption& given, const explore::Budget& budget) {
  try {
    Explanation explanation = explained(given.abstract, finding.trace, budget);
    finding.trace = std::move(explanation.run);
    finding.waits = std::move(explanation.waits);
    name_absences(finding.waits, given);
  } catch (const explore::CutOff& cut) {
    finding.cut_off = std::string(cut.what()) + ": the waits are not named";
  }
}

Finding judged_together(const std::vector<Found>& all, Found::Kind bad) {
  Finding finding;
  finding.kind = Finding::Kind::holds;
  for (std::uint32_t goal = 0; goal < all.size(); ++goal) {
    finding.states += all[goal].states;
    if (!all[goal].explanation.empty()) finding.explanation = all[goal].explanation;
  }
  for (std::uint32_t goal = 0; goal < all.size(); ++goal) {
    if (all[goal].kind == bad) {
      finding.kind = Finding::Kind::violated;
      finding.subjects = {goal};
      finding.trace = all[goal].trace;
      return finding;
    }
    if (all[goal].kind != Found::Kind::unknown) continue;
    finding.kind = Finding::Kind::unknown;
    finding.subjects.push_back(goal);
    if (finding.why.empty()) finding.why = all[goal].why;
  }
  return finding;
}

static std::optional<bool> holds_after(const net::Net& net, const std::vector<TransitionId>& run,
                                       const Formula& formula) {
  const explore::PtNet compiled(net);
  const std::optional<explore::Marking> end = explore::replay(compiled, run);
  return end ? std::optional(explore::holds(formula, compiled, *end)) : std::nullopt;
}

void keep_causes(std::vector<TransitionId>& run, const net::Net& net, const Formula& goal) {
  std::vector<PlaceId> places;
  places_of(goal, places);
  std::vector<TransitionId> kept = causes_of_tokens(net, run, places);
  if (holds_after(net, kept, goal) == true) run = std::move(kept);
}

void keep_causes_of_loss(std::vector<TransitionId>& run, const net::Net& net, const Formula& goal,
                         const explore::Budget& budget) {
  const auto is_marked = [](const Formula& one) {
    return one.kind == Formula::Kind::at_least && one.tokens == 1;
  };
  const bool simple =
      is_marked(goal) || (goal.kind == Formula::Kind::any && std::ranges::all_of(goal.parts, is_marked));
  if (!simple) return;
  std::vector<PlaceId> places;
  places_of(goal, places);
  const std::set<PlaceId> wanted(places.begin(), places.end());
  std::vector<TransitionId> fills;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (possible(net, {index}) && std::ranges::any_of(net.postset({index}), [&](const net::Arc& arc) {
          return wanted.contains(arc.place);
        }))
      fills.push_back({index});
  std::vector<TransitionId> kept = causes_of_standstill(net, run, fills, budget);
  if (holds_after(net, kept, goal) == false && never_again(net, kept, fills)) run = std::move(kept);
}

void name_subjects(Finding& finding, const Question& question) {
  for (std::uint32_t& subject : finding.subjects) subject = question.subjects[subject];
}

std::size_t worst_of(const std::vector<Found>& all) {
  const auto at = [&](Found::Kind kind) {
    return static_cast<std::size_t>(std::ranges::find(all, kind, &Found::kind) - all.begin());
  };
  if (at(Found::Kind::no) < all.size()) return at(Found::Kind::no);
  return at(Found::Kind::unknown) < all.size() ? at(Found::Kind::unknown) : 0;
}

}  // namespace tessera::verify
