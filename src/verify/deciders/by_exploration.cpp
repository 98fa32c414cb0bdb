#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "explore/budget.hpp"
#include "net/token_game.hpp"
#include "verify/counterexample/causes.hpp"
#include "verify/counterexample/explanation.hpp"
#include "verify/counterexample/waits.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/deciders/exploration_findings.hpp"
#include "verify/invariants/forbidden.hpp"
#include "verify/search/claims.hpp"
#include "verify/search/exploration.hpp"
#include "verify/search/goals.hpp"
#include "verify/search/parts.hpp"
#include "verify/search/surroundings.hpp"
#include "verify/search/walks.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::PlaceId;
using net::TransitionId;

/// Reductions do not keep safety, so the net itself is explored, up to the first second token.
Finding safe(const NetUnderAssumption& given, const explore::Limits& limits) {
  std::vector<TransitionId> original;
  const net::Net possible = possible_part(given.abstract, &original);
  const explore::PtNet net(possible);
  std::vector<Formula> two;
  for (std::uint32_t place = 0; place < net.places(); ++place) two.push_back(Formula::at_least({place}, 2));
  const explore::Answer answer = explore::find(net, Formula::any(std::move(two)), limits);
  Finding finding;
  finding.method = "explicit search";
  finding.why = answer.why;
  finding.states = answer.effort.markings;
  finding.explanation = std::to_string(answer.effort.markings) + " markings";
  if (answer.kind == explore::Answer::Kind::no) finding.kind = Finding::Kind::holds;
  if (answer.kind != explore::Answer::Kind::yes) return finding;
  finding.kind = Finding::Kind::violated;
  finding.has_trace = true;
  for (const TransitionId id : answer.trace.firings) finding.trace.push_back(original[id.value]);
  for (std::uint32_t place = 0; place < net.places(); ++place)
    if (answer.trace.end[place] > 1)
      finding.why = "place '" + possible.places()[place].name + "' holds " +
                    std::to_string(answer.trace.end[place]) + " tokens";
  return finding;
}

Finding deadlock_free(const NetUnderAssumption& given, const Question& question, Facts& facts,
                      const explore::Limits& limits) {
  const explore::Budget budget(limits);
  const Found* found = &facts.dead_end(question.assume, with_few_markings(given.abstract, limits));
  Finding finding = judged(*found, Found::Kind::no);
  if (found->kind == Found::Kind::unknown) {
    if (const auto known = facts.known_dead_ends(question.assume); !known.empty()) {
      finding.kind = Finding::Kind::violated;
      finding.trace = known.front();
      finding.has_trace = true;
    } else {
      found = &facts.dead_end(question.assume, budget.left());
      finding = judged(*found, Found::Kind::no);
    }
  }
  if (finding.kind != Finding::Kind::violated) return finding;
  finding.why = facts.subject().pages != nullptr ? "a dead marking is reachable that is not final"
                                                 : "a dead marking is reachable";
  if (found->cut_short) finding.cut_off = "the time limit is reached: the run is not shortened";
  explain(finding, given, budget);
  return finding;
}

/// The first of the sets none of whose transitions is enabled after the run.
std::optional<std::size_t> stuck_after(const net::Net& net, const std::vector<TransitionId>& run,
                                       const std::vector<std::vector<TransitionId>>& sets) {
  const net::Marking end = net::marking_after(net, run);
  for (std::size_t set = 0; set < sets.size(); ++set)
    if (std::ranges::none_of(sets[set], [&](TransitionId id) { return net::enabled(net, id, end); }))
      return set;
  return std::nullopt;
}

/// A set of transitions that gets stuck, of several.
struct Standstill {
  Finding finding;
  std::size_t set = 0;
};

/// A run to a dead marking refutes that something is always possible again. The shortest run, which a search
/// through all markings gives, is preferred if that takes few of them.
Standstill standstill(const NetUnderAssumption& given, const std::vector<std::vector<TransitionId>>& sets,
                      Assume assume, Facts& facts, const explore::Limits& limits,
                      const explore::Budget& budget) {
  const explore::Limits few = with_few_markings(given.abstract, limits);
  const auto searched = [&](const explore::Limits& within) {
    const std::vector<Found> found = find_stuck(given.probed.net, sets, facts.reducing(), within);
    const std::size_t worst = worst_of(found);
    return Standstill{judged(found[worst], Found::Kind::yes), worst};
  };
  Standstill found = searched(few);
  if (found.finding.kind != Finding::Kind::unknown) return found;
  explore::Limits left = budget.left();
  left.markings = few.markings;
  if (!facts.dead_ends_are_excluded(assume)) static_cast<void>(facts.dead_end(assume, left));
  for (const std::vector<TransitionId>& run : facts.known_dead_ends(assume)) {
    const std::optional<std::size_t> set = stuck_after(given.probed.net, run, sets);
    if (!set) continue;
    found.set = *set;
    found.finding.kind = Finding::Kind::violated;
    found.finding.trace = run;
    found.finding.has_trace = true;
    if (budget.spent()) found.finding.cut_off = "the time limit is reached: there may be a shorter run";
    return found;
  }
  left = budget.left();
  left.markings = limits.markings;
  return left.markings > few.markings && !budget.spent() ? searched(left) : found;
}

/// Sets of transitions one of which has to be possible again and again.
template <class Id>
Finding always_possible(const NetUnderAssumption& given, const std::vector<ProbedNet::Set<Id>>& all,
                        const Question& question, Facts& facts, const explore::Limits& limits) {
  const explore::Budget budget(limits);
  std::vector<const ProbedNet::Set<Id>*> sets;
  std::vector<std::vector<TransitionId>> transitions;
  for (const ProbedNet::Set<Id>& set : all) {
    if (std::ranges::count(question.subjects, set.id.value) == 0) continue;
    sets.push_back(&set);
    transitions.push_back(set.any_of);
  }
  if (sets.empty()) return {.kind = Finding::Kind::holds};
  Standstill found = standstill(given, transitions, question.assume, facts, limits, budget);
  Finding finding = std::move(found.finding);
  finding.subjects = {sets[found.set]->id.value};
  if (finding.kind != Finding::Kind::violated) return finding;
  std::vector<TransitionId> stuck = sets[found.set]->any_of;
  try {
    finding.trace = causes_of_standstill(given.probed.net, finding.trace, stuck, budget);
  } catch (const explore::CutOff& cut) {
    finding.cut_off = std::string(cut.what()) + ": the run is not shortened";
  }
  // Probes change nothing, and the net that is shown has none.
  for (std::vector<TransitionId>* ids : {&finding.trace, &stuck})
    std::erase_if(*ids, [&](TransitionId id) { return id.value >= given.probed.transitions; });
  if (!finding.cut_off.empty() || stuck.empty()) return finding;
  try {
    Explanation explanation = explained(given.abstract, finding.trace, stuck, budget);
    finding.trace = std::move(explanation.run);
    finding.waits = std::move(explanation.waits);
    name_absences(finding.waits, given);
  } catch (const explore::CutOff& cut) {
    finding.cut_off = std::string(cut.what()) + ": the waits are not named";
  }
  return finding;
}

Finding goes_on(const NetUnderAssumption& given, const Question& question, Facts& facts,
                const explore::Limits& limits) {
  Finding finding = always_possible(given, given.probed.subsystems, question, facts, limits);
  if (finding.kind == Finding::Kind::violated)
    finding.why =
        given.abstract.parts()[net::SubsystemId{finding.subjects.front()}].path + " can get stuck for ever";
  return finding;
}

Finding channels_flow(const NetUnderAssumption& given, const Question& question, Facts& facts,
                      const explore::Limits& limits) {
  Finding finding = always_possible(given, given.probed.channels, question, facts, limits);
  if (finding.kind == Finding::Kind::violated)
    finding.why = given.abstract.parts()[net::ChannelId{finding.subjects.front()}] + " can run dry for ever";
  return finding;
}

/// Markings none of which is to be reached, one for each subject of the question.
Finding none_reached(const NetUnderAssumption& given, const Question& question,
                     const std::vector<Goal>& markings, const Reducing& how, const explore::Limits& limits) {
  Finding finding = judged_together(
      ask(given.abstract, Ask::reachable, markings, Found::Kind::yes, how, limits), Found::Kind::yes);
  finding.has_trace = finding.kind == Finding::Kind::violated;
  if (finding.has_trace) keep_causes(finding.trace, given.abstract, markings[finding.subjects.front()].what);
  name_subjects(finding, question);
  return finding;
}

Finding exclusive_channels(const NetUnderAssumption& given, const Question& question, const Reducing& how,
                           const explore::Limits& limits) {
  std::vector<Goal> markings;
  for (const SharedMemory& memory : shared_memories(given.abstract))
    if (std::ranges::count(question.subjects, memory.id()) > 0) markings.push_back({used_twice(memory)});
  Finding finding = none_reached(given, question, markings, how, limits);
  if (finding.kind != Finding::Kind::violated) return finding;
  const PlaceId place{finding.subjects.front()};
  finding.why = "the memory of " + given.abstract.parts()[given.abstract[place].operation.channel] +
                " is used twice at once";
  return finding;
}

Finding sound_pages(const NetUnderAssumption& given, const Question& question, Facts& facts,
                    const explore::Limits& limits) {
  const net::HierarchicalNet& pages = *facts.subject().pages;
  // Not those of the abstract net, which has places where a subsystem is lost and its page is not left.
  const std::vector<PagePlaces> places = places_of_pages(pages, facts.subject().net);
  std::vector<Goal> markings;
  for (const std::uint32_t page : question.subjects) markings.push_back({unsound(places[page])});
  Finding finding = none_reached(given, question, markings, facts.reducing(), limits);
  if (finding.kind == Finding::Kind::violated)
    finding.why =
        "page '" + pages.path({finding.subjects.front()}) + "' is entered or left while it is in use";
  return finding;
}

/// The places that walks do not find marked. The walks are the same on every machine.
std::vector<std::uint32_t> not_met(const NetUnderAssumption& given, const std::vector<std::uint32_t>& places,
                                   const explore::Budget& budget) {
  constexpr std::size_t firings = 100'000;
  const net::Net possible = possible_part(given.abstract);
  const std::vector<bool> met = marked_on_walks(explore::PtNet(possible), places, firings, budget);
  std::vector<std::uint32_t> others;
  for (std::size_t index = 0; index < places.size(); ++index)
    if (!met[index]) others.push_back(places[index]);
  return others;
}

/// The places that stay empty even if a subsystem and its peers get every token that they wait for from all
/// others.
std::vector<std::uint32_t> never_met(const NetUnderAssumption& given,
                                     const std::vector<std::uint32_t>& places, const Reducing& how,
                                     const explore::Budget& budget) {
  std::map<net::SubsystemId, std::vector<std::uint32_t>> by_owner;
  for (const std::uint32_t place : places)
    by_owner[given.abstract.places()[place].subsystem].push_back(place);
  std::vector<std::uint32_t> never;
  const Surroundings surroundings(given.abstract);
  for (const auto& [owner, own] : by_owner) {
    budget.check();
    const Surroundings::Part part = surroundings.around(owner);
    std::vector<Goal> goals;
    std::vector<std::uint32_t> asked;
    for (const std::uint32_t place : own)
      if (const auto there = part.place_of.find({place}); there != part.place_of.end()) {
        goals.push_back({Formula::marked(there->second)});
        asked.push_back(place);
      }
    const std::vector<Found> found =
        ask(part.net, Ask::reachable, goals, std::nullopt, how, with_few_markings(part.net, budget.left()));
    for (std::size_t goal = 0; goal < asked.size(); ++goal)
      if (found[goal].kind == Found::Kind::no) never.push_back(asked[goal]);
  }
  return never;
}

Finding live_behaviours(const NetUnderAssumption& given, Question question, const Reducing& how,
                        const explore::Limits& given_limits) {
  const explore::Budget budget(given_limits);
  question.subjects = not_met(given, question.subjects, budget);
  if (question.subjects.empty())
    return {.kind = Finding::Kind::holds, .explanation = "walks through the net meet every behaviour"};
  if (std::vector<std::uint32_t> never = never_met(given, question.subjects, how, budget); !never.empty()) {
    Finding finding;
    finding.kind = Finding::Kind::violated;
    finding.why = behaviour_of(given.abstract, {never.front()}) + " can never run";
    finding.explanation = "not even if all but its own subsystem and its peers gave them whatever they want";
    finding.subjects = std::move(never);
    return finding;
  }
  const explore::Limits limits = budget.left();
  std::vector<Goal> goals;
  for (const std::uint32_t place : question.subjects) goals.push_back({Formula::marked({place})});
  const std::vector<Found> found = ask(given.abstract, Ask::reachable, goals, std::nullopt, how, limits);
  Finding finding = judged_together(found, Found::Kind::no);
  if (finding.kind == Finding::Kind::violated) {  // all of them, not the first alone
    finding.subjects.clear();
    for (std::uint32_t goal = 0; goal < found.size(); ++goal)
      if (found[goal].kind == Found::Kind::no) finding.subjects.push_back(goal);
  }
  name_subjects(finding, question);
  if (finding.kind == Finding::Kind::holds) return finding;
  const std::string name = behaviour_of(given.abstract, {finding.subjects.front()});
  finding.why = finding.kind == Finding::Kind::violated ? name + " can never run" : name + ": " + finding.why;
  return finding;
}

/// Does the run, to a dead marking, refute the claim: where it ends, the wanted marking is out of reach?
bool refutes(const explore::PtNet& net, const std::vector<TransitionId>& run, Ask what, const Goal& goal) {
  explore::Marking marking = net.initial();
  bool waits = explore::holds(goal.what, net, marking) && !explore::holds(goal.then, net, marking);
  for (const TransitionId id : run) {
    net.fire(id.value, marking);
    if (what == Ask::leads_to)
      waits = (waits || explore::holds(goal.what, net, marking)) && !explore::holds(goal.then, net, marking);
  }
  return what == Ask::leads_to ? waits : !explore::holds(goal.what, net, marking);
}

/// The answers of a search of few markings, then of known dead ends, then of a longer search.
Finding always_or_led_to(const NetUnderAssumption& given, Ask what, const std::vector<Goal>& goals,
                         const Question& question, Facts& facts, const explore::Limits& limits,
                         const explore::Budget& budget) {
  const auto searched = [&](const explore::Limits& within) {
    return judged_together(ask(given.abstract, what, goals, Found::Kind::no, facts.reducing(), within),
                           Found::Kind::no);
  };
  const explore::Limits few = with_few_markings(given.abstract, limits);
  Finding finding = searched(few);
  if (finding.kind != Finding::Kind::unknown) return finding;
  explore::Limits left = budget.left();
  left.markings = few.markings;
  if (!facts.dead_ends_are_excluded(question.assume))
    static_cast<void>(facts.dead_end(question.assume, left));
  const explore::PtNet net(given.abstract);
  for (const std::vector<TransitionId>& run : facts.known_dead_ends(question.assume))
    for (std::uint32_t goal = 0; goal < goals.size(); ++goal) {
      if (!refutes(net, run, what, goals[goal])) continue;
      finding.kind = Finding::Kind::violated;
      finding.subjects = {goal};
      finding.trace = run;
      return finding;
    }
  return budget.spent() ? finding : searched(budget.left());
}

Finding claims(const NetUnderAssumption& given, const Question& question, Facts& facts,
               const explore::Limits& limits) {
  using Claims = net::Property::Kind;
  const explore::Budget budget(limits);
  const Claims kind = question.property->kind;
  Ask what = Ask::reachable;
  if (kind == Claims::always_reachable) what = Ask::always_reachable;
  if (kind == Claims::leads_to) what = Ask::leads_to;
  const bool forbidden = kind == Claims::never || kind == Claims::always;
  const Found::Kind bad = forbidden ? Found::Kind::yes : Found::Kind::no;
  std::vector<Goal> goals;
  for (const std::uint32_t number : question.subjects) {
    const net::Claim& claim = question.property->claims[number];
    goals.push_back({what_of(kind, claim), formula_of(claim.then)});
  }
  Finding finding =
      what == Ask::reachable
          ? judged_together(ask(given.abstract, what, goals, bad, facts.reducing(), limits), bad)
          : always_or_led_to(given, what, goals, question, facts, limits, budget);
  if (finding.kind == Finding::Kind::violated) {
    const Formula& goal = goals[finding.subjects.front()].what;
    try {
      if (forbidden) keep_causes(finding.trace, given.abstract, goal);
      if (what == Ask::always_reachable) keep_causes_of_loss(finding.trace, given.abstract, goal, budget);
    } catch (const explore::CutOff& cut) {
      finding.cut_off = std::string(cut.what()) + ": the run is not shortened";
    }
  }
  name_subjects(finding, question);
  if (finding.kind != Finding::Kind::violated) return finding;
  finding.why = complaint(kind, question.property->claims[finding.subjects.front()]);
  finding.has_trace = kind != Claims::reachable;
  if (what != Ask::reachable) explain(finding, given, budget);
  return finding;
}

/// Reductions, components, and the markings of one component of each kind.
class ByExploration final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "explicit"; }
  [[nodiscard]] const char* title() const override { return "reductions and explicit search"; }
  [[nodiscard]] bool finds_runs() const override { return true; }

  [[nodiscard]] std::optional<Finding> decide(const Question& question, Facts& facts,
                                              const explore::Limits& limits) const override {
    const NetUnderAssumption& given = facts.under(question.assume);
    switch (question.kind) {
      case Question::Kind::safe:
        return safe(given, limits);
      case Question::Kind::deadlock_free:
        return deadlock_free(given, question, facts, limits);
      case Question::Kind::goes_on:
        return goes_on(given, question, facts, limits);
      case Question::Kind::channels_flow:
        return channels_flow(given, question, facts, limits);
      case Question::Kind::live_behaviours:
        return live_behaviours(given, question, facts.reducing(), limits);
      case Question::Kind::claims:
        return claims(given, question, facts, limits);
      case Question::Kind::exclusive_channels:
        return exclusive_channels(given, question, facts.reducing(), limits);
      case Question::Kind::sound_pages:
        return sound_pages(given, question, facts, limits);
    }
    return std::nullopt;
  }
};

}  // namespace

std::unique_ptr<Decider> by_exploration() { return std::make_unique<ByExploration>(); }

}  // namespace tessera::verify
