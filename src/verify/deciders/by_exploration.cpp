#include <algorithm>

#include "verify/counterexample/causes.hpp"
#include "verify/counterexample/explanation.hpp"
#include "verify/counterexample/waits.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/invariants/forbidden.hpp"
#include "verify/search/claims.hpp"
#include "verify/search/exploration.hpp"
#include "verify/search/goals.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::PlaceId;
using net::TransitionId;

/// good: the answer to the question of the search for which the property holds.
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

/// Reductions do not keep safety, so the net itself is explored.
Finding safe(const NetUnderAssumption& given, const explore::Limits& limits) {
  std::vector<TransitionId> original;
  const net::Net possible = possible_part(given.abstract, &original);
  const explore::PtNet net(possible);
  explore::Limits most = limits;
  most.time *= 0.8;
  const explore::Count count = explore::count(net, most);
  Finding finding;
  finding.method = "explicit search";
  finding.why = count.why;
  finding.states = count.markings;
  finding.explanation =
      std::to_string(count.markings) + " markings, " + std::to_string(count.edges) + " edges";
  if (count.complete && count.most_tokens <= 1) finding.kind = Finding::Kind::holds;
  if (count.most_tokens <= 1) return finding;
  std::vector<Formula> two;
  for (std::uint32_t place = 0; place < net.places(); ++place) two.push_back(Formula::at_least({place}, 2));
  const explore::Answer answer = explore::find(net, Formula::any(std::move(two)), limits);
  finding.kind = Finding::Kind::violated;
  finding.why = "a place holds two tokens";
  if (answer.kind != explore::Answer::Kind::yes) return finding;
  finding.has_trace = true;
  for (const TransitionId id : answer.trace.firings) finding.trace.push_back(original[id.value]);
  for (std::uint32_t place = 0; place < net.places(); ++place)
    if (answer.trace.end[place] > 1)
      finding.why = "place '" + possible.places()[place].name + "' holds " +
                    std::to_string(answer.trace.end[place]) + " tokens";
  return finding;
}

/// Extends the run, whose violation is final, and adds the waits at its end.
void explain(Finding& finding, const net::Net& net) {
  Explanation explanation = explained(net, std::move(finding.trace));
  finding.trace = std::move(explanation.run);
  finding.waits = std::move(explanation.waits);
}

Finding deadlock_free(const NetUnderAssumption& given, Facts& facts, const explore::Limits& limits) {
  const PlaceId end = facts.subject().pages == nullptr ? PlaceId{} : final_place(given.abstract);
  Finding finding = judged(find_dead(given.abstract, end, facts.reducing(), limits), Found::Kind::no);
  if (finding.kind != Finding::Kind::violated) return finding;
  finding.why = end.valid() ? "a dead marking is reachable that is not final" : "a dead marking is reachable";
  explain(finding, given.abstract);
  return finding;
}

/// The most telling of several answers, all of which have to be `yes`: a `no`, else an `unknown`.
std::size_t worst_of(const std::vector<Found>& all) {
  const auto at = [&](Found::Kind kind) {
    return static_cast<std::size_t>(std::ranges::find(all, kind, &Found::kind) - all.begin());
  };
  if (at(Found::Kind::no) < all.size()) return at(Found::Kind::no);
  return at(Found::Kind::unknown) < all.size() ? at(Found::Kind::unknown) : 0;
}

/// Sets of transitions one of which has to be possible again and again.
template <class Id>
Finding always_possible(const NetUnderAssumption& given, const std::vector<ProbedNet::Set<Id>>& all,
                        const Question& question, const Reducing& how, const explore::Limits& limits) {
  std::vector<const ProbedNet::Set<Id>*> sets;
  std::vector<std::vector<TransitionId>> transitions;
  for (const ProbedNet::Set<Id>& set : all) {
    if (std::ranges::count(question.subjects, set.id.value) == 0) continue;
    sets.push_back(&set);
    transitions.push_back(set.any_of);
  }
  if (sets.empty()) return {.kind = Finding::Kind::holds};
  const std::vector<Found> found = find_stuck(given.probed.net, transitions, how, limits);
  const std::size_t worst = worst_of(found);
  Finding finding = judged(found[worst], Found::Kind::yes);
  finding.subjects = {sets[worst]->id.value};
  if (finding.kind != Finding::Kind::violated) return finding;
  std::vector<TransitionId> stuck = sets[worst]->any_of;
  finding.trace = causes_of_standstill(given.probed.net, std::move(finding.trace), stuck);
  // Probes change nothing, and the net that is shown has none.
  for (std::vector<TransitionId>* ids : {&finding.trace, &stuck})
    std::erase_if(*ids, [&](TransitionId id) { return id.value >= given.probed.transitions; });
  Explanation explanation = explained(given.abstract, std::move(finding.trace), stuck);
  finding.trace = std::move(explanation.run);
  finding.waits = std::move(explanation.waits);
  return finding;
}

Finding goes_on(const NetUnderAssumption& given, const Question& question, const Reducing& how,
                const explore::Limits& limits) {
  Finding finding = always_possible(given, given.probed.subsystems, question, how, limits);
  if (finding.kind == Finding::Kind::violated)
    finding.why =
        given.abstract.parts()[net::SubsystemId{finding.subjects.front()}].path + " can get stuck for ever";
  return finding;
}

Finding channels_flow(const NetUnderAssumption& given, const Question& question, const Reducing& how,
                      const explore::Limits& limits) {
  Finding finding = always_possible(given, given.probed.channels, question, how, limits);
  if (finding.kind == Finding::Kind::violated)
    finding.why = given.abstract.parts()[net::ChannelId{finding.subjects.front()}] + " can run dry for ever";
  return finding;
}

/// The finding about several goals. bad: the answer about one of them that is a violation.
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

/// The goals were those of the question's subjects, one by one.
void name_subjects(Finding& finding, const Question& question) {
  for (std::uint32_t& subject : finding.subjects) subject = question.subjects[subject];
}

/// Markings none of which is to be reached, one for each subject of the question.
Finding none_reached(const NetUnderAssumption& given, const Question& question,
                     const std::vector<Goal>& markings, const Reducing& how, const explore::Limits& limits) {
  Finding finding = judged_together(
      ask(given.abstract, Ask::reachable, markings, Found::Kind::yes, how, limits), Found::Kind::yes);
  name_subjects(finding, question);
  finding.has_trace = finding.kind == Finding::Kind::violated;
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

Finding live_behaviours(const NetUnderAssumption& given, const Question& question, const Reducing& how,
                        const explore::Limits& limits) {
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

Finding claims(const NetUnderAssumption& given, const Question& question, const Reducing& how,
               const explore::Limits& limits) {
  using Claims = net::Property::Kind;
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
  Finding finding = judged_together(ask(given.abstract, what, goals, bad, how, limits), bad);
  name_subjects(finding, question);
  if (finding.kind != Finding::Kind::violated) return finding;
  finding.why = complaint(kind, question.property->claims[finding.subjects.front()]);
  finding.has_trace = kind != Claims::reachable;
  if (what != Ask::reachable) explain(finding, given.abstract);
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
        return deadlock_free(given, facts, limits);
      case Question::Kind::goes_on:
        return goes_on(given, question, facts.reducing(), limits);
      case Question::Kind::channels_flow:
        return channels_flow(given, question, facts.reducing(), limits);
      case Question::Kind::live_behaviours:
        return live_behaviours(given, question, facts.reducing(), limits);
      case Question::Kind::claims:
        return claims(given, question, facts.reducing(), limits);
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
