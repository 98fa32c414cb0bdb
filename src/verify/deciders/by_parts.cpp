#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "explore/budget.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/search/claims.hpp"
#include "verify/search/partial_nets.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;

PartialNets::Answer claim_holds(const PartialNets& parts, net::Property::Kind kind, const net::Claim& claim,
                                const explore::Budget& budget) {
  using Kind = net::Property::Kind;
  const Formula what = what_of(kind, claim);
  switch (kind) {
    case Kind::never:
    case Kind::always:
      return parts.never(what, budget);
    case Kind::always_reachable:
      return parts.reaches(Formula::always(), {what, {}}, budget);
    case Kind::leads_to:
      return parts.reaches(what, {formula_of(claim.then), {}}, budget);
    case Kind::reachable:
      break;
  }
  return {};
}

/// The subsystems of transitions.
PartialNets::Subsystems owners(const net::Net& net, const std::vector<net::TransitionId>& transitions) {
  PartialNets::Subsystems all;
  for (const net::TransitionId id : transitions)
    if (net[id].subsystem.valid()) all.insert(net[id].subsystem);
  return all;
}

/// Is a subsystem able to act again, or a channel to be received from, or has the subsystem ended?
template <class Id>
PartialNets::Answer goes_on(const PartialNets& parts, const net::Net& net,
                            const std::vector<ProbedNet::Set<Id>>& all, std::uint32_t subject,
                            const explore::Budget& budget) {
  const auto set = std::ranges::find(all, Id{subject}, &ProbedNet::Set<Id>::id);
  if (set == all.end()) return {.holds = true};
  PartialNet::Goal goal;
  std::vector<Formula> ended;
  for (const net::TransitionId id : set->any_of) {
    if (net[id].subsystem.valid()) {
      goal.fired.insert(id);
      continue;
    }
    std::vector<Formula> probed;  // a probe changes nothing
    for (const net::Arc& arc : net.preset(id)) probed.push_back(Formula::marked(arc.place));
    ended.push_back(Formula::all(std::move(probed)));
  }
  goal.formula = Formula::any(std::move(ended));
  PartialNets::Subsystems ends;
  for (const net::TransitionId id : set->any_of)
    for (const net::Arc& arc : net.preset(id)) ends.merge(parts.users(arc.place));
  const PartialNets::Subsystems mine = owners(net, set->any_of);
  if constexpr (std::is_same_v<Id, net::SubsystemId>)
    if (mine == PartialNets::Subsystems{set->id}) return parts.goes_on(set->id, goal, budget, ends);
  return parts.reaches(Formula::always(), goal, budget, mine, ends);
}

/// The subsystems that a question is about, while all others do whatever they can. It only proves.
///
/// It is for nets whose subsystems know something, where circuits say little and all markings are many.
class ByParts final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "parts"; }
  [[nodiscard]] const char* title() const override { return "search of parts"; }

  [[nodiscard]] bool suits(const net::Net& net) const override {
    return std::ranges::any_of(net.places(), [](const net::Place& place) { return place.fact.valid(); });
  }

  [[nodiscard]] std::optional<Finding> decide(const Question& question, Facts& facts,
                                              const explore::Limits& limits) const override {
    using Kind = Question::Kind;
    if (question.kind != Kind::claims && question.kind != Kind::goes_on &&
        question.kind != Kind::channels_flow)
      return std::nullopt;
    const NetUnderAssumption& given = facts.under(question.assume);
    if (!facts.safe()) return std::nullopt;
    if (question.kind == Kind::claims && question.property->kind == net::Property::Kind::reachable)
      return std::nullopt;
    explore::Limits share = limits;
    share.time *= 0.5;  // the rest is for the search of all markings
    const explore::Budget budget(share);
    const PartialNets& parts = facts.partial_nets(question.assume);
    std::uint64_t markings = 0;
    Finding finding;
    finding.why = "the others have to do their part";
    try {
      for (const std::uint32_t subject : question.subjects) {
        budget.check();
        const auto answer_to = [&] {
          switch (question.kind) {
            case Kind::goes_on:
              return goes_on(parts, given.probed.net, given.probed.subsystems, subject, budget);
            case Kind::channels_flow:
              return goes_on(parts, given.probed.net, given.probed.channels, subject, budget);
            default:
              return claim_holds(parts, question.property->kind, question.property->claims[subject], budget);
          }
        };
        const PartialNets::Answer answer = answer_to();
        markings += answer.markings;
        if (!answer.holds) finding.subjects.push_back(subject);
      }
    } catch (const explore::CutOff& cut) {
      finding.why = cut.what();
      finding.subjects = question.subjects;
    }
    finding.states = markings;
    finding.explanation = std::to_string(markings) + " markings";
    if (finding.subjects.empty()) {
      finding.kind = Finding::Kind::holds;
      finding.why.clear();
    }
    return finding;
  }
};

}  // namespace

std::unique_ptr<Decider> by_parts() { return std::make_unique<ByParts>(); }

}  // namespace tessera::verify
