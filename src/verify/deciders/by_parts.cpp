#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "explore/budget.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/search/claims.hpp"
#include "verify/search/partial_net.hpp"
#include "verify/search/parts.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::PlaceId;
using Subsystems = PartialNet::Subsystems;

constexpr std::size_t most_subsystems = 3;

/// Places of subsystems that the layers above empty: their tokens are not followed.
std::set<PlaceId> emptied_from_above(const net::Net& net) {
  std::set<PlaceId> emptied;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (!net[net::TransitionId{index}].subsystem.valid())
      for (const net::Arc& arc : net.preset({index}))
        if (!net[arc.place].fused() && std::ranges::count(net.postset({index}), arc) == 0)
          emptied.insert(arc.place);
  return emptied;
}

/// Settles questions by some subsystems at a time.
class Parts {
 public:
  Parts(const net::Net& net, const std::vector<net::Invariant>& invariants, const explore::Budget& budget)
      : net_(net),
        surroundings_(net),
        sets_(net, invariants),
        emptied_(emptied_from_above(net)),
        budget_(budget) {}

  /// Whether the markings are never reached.
  bool never(const Formula& bad) {
    return settled(owners(bad), [&](const PartialNet& part) -> std::optional<PartialNet::Result> {
      if (!knows(part, bad)) return std::nullopt;
      return part.never(bad, budget_);
    });
  }

  /// first: others that are asked before all that may help.
  bool reaches(const Formula& from, const PartialNet::Goal& goal, Subsystems begin,
               const Subsystems& first = {}) {
    for (const Formula* formula : {&from, &goal.formula}) begin.merge(owners(*formula));
    return settled(
        std::move(begin),
        [&](const PartialNet& part) -> std::optional<PartialNet::Result> {
          if (!knows(part, from) || !knows(part, goal.formula)) return std::nullopt;
          return part.reaches(from, goal, budget_);
        },
        first);
  }

  /// The subsystems that use a place of a channel.
  [[nodiscard]] Subsystems users(PlaceId place) const {
    Subsystems all = surroundings_.users(place);
    std::erase_if(all, [](net::SubsystemId one) { return !one.valid(); });
    return all;
  }

  [[nodiscard]] std::uint64_t markings() const { return markings_; }

 private:
  [[nodiscard]] bool knows(const PartialNet& part, const Formula& formula) const {
    std::vector<PlaceId> places;
    places_of(formula, places);
    return part.knows(formula) &&
           std::ranges::none_of(places, [&](PlaceId place) { return emptied_.contains(place); });
  }

  [[nodiscard]] Subsystems owners(const Formula& formula) const {
    std::vector<PlaceId> places;
    places_of(formula, places);
    Subsystems all;
    for (const PlaceId place : places) {
      if (net_[place].fused())
        all.insert(surroundings_.users(place).begin(), surroundings_.users(place).end());
      else
        all.insert(net_[place].subsystem);
    }
    return all;
  }

  template <class Judge>
  bool settled(Subsystems subsystems, Judge judge, const Subsystems& first = {}) {
    while (!subsystems.empty() && subsystems.size() <= most_subsystems) {
      const bool strange = std::ranges::any_of(
          subsystems, [&](net::SubsystemId one) { return one.value >= net_.parts().subsystems.size(); });
      if (strange) return false;
      const std::optional<PartialNet::Result> result =
          judge(PartialNet(net_, surroundings_, sets_, subsystems));
      if (!result) return false;
      markings_ += result->markings;
      if (result->holds) return true;
      Subsystems peers = result->peers;
      if (std::ranges::any_of(first, [&](net::SubsystemId one) { return peers.contains(one); }))
        std::erase_if(peers, [&](net::SubsystemId one) { return !first.contains(one); });
      if (peers.empty() || subsystems.size() + peers.size() > most_subsystems) return false;
      subsystems.insert(peers.begin(), peers.end());
    }
    return false;
  }

  const net::Net& net_;
  const Surroundings surroundings_;
  const TokenSets sets_;
  const std::set<PlaceId> emptied_;
  const explore::Budget& budget_;
  std::uint64_t markings_ = 0;
};

bool claim_holds(Parts& parts, net::Property::Kind kind, const net::Claim& claim) {
  using Kind = net::Property::Kind;
  const Formula what = what_of(kind, claim);
  switch (kind) {
    case Kind::never:
    case Kind::always:
      return parts.never(what);
    case Kind::always_reachable:
      return parts.reaches(Formula::always(), {what, {}}, {});
    case Kind::leads_to:
      return parts.reaches(what, {formula_of(claim.then), {}}, {});
    case Kind::reachable:
      break;
  }
  return false;
}

/// The subsystems of transitions.
Subsystems owners(const net::Net& net, const std::vector<net::TransitionId>& transitions) {
  Subsystems all;
  for (const net::TransitionId id : transitions)
    if (net[id].subsystem.valid()) all.insert(net[id].subsystem);
  return all;
}

template <class Id>
bool goes_on(Parts& parts, const net::Net& net, const std::vector<ProbedNet::Set<Id>>& all,
             std::uint32_t subject) {
  const auto set = std::ranges::find(all, Id{subject}, &ProbedNet::Set<Id>::id);
  if (set == all.end()) return true;
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
  Subsystems ends;
  for (const net::TransitionId id : set->any_of)
    for (const net::Arc& arc : net.preset(id)) ends.merge(parts.users(arc.place));
  return parts.reaches(Formula::always(), goal, owners(net, set->any_of), ends);
}

/// The subsystems that a question is about, while all others do whatever they can. It only proves.
///
/// It is for nets whose subsystems know something, where circuits say little and all markings are many.
class ByParts final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "parts"; }
  [[nodiscard]] const char* title() const override { return "some subsystems, whatever the others do"; }

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
    const explore::Budget budget(limits);
    Parts parts(given.probed.net, facts.subject().invariants, budget);
    Finding finding;
    finding.why = "the others have to do their part";
    try {
      for (const std::uint32_t subject : question.subjects) {
        budget.check();
        const auto holds = [&] {
          switch (question.kind) {
            case Kind::goes_on:
              return goes_on(parts, given.probed.net, given.probed.subsystems, subject);
            case Kind::channels_flow:
              return goes_on(parts, given.probed.net, given.probed.channels, subject);
            default:
              return claim_holds(parts, question.property->kind, question.property->claims[subject]);
          }
        };
        if (!holds()) finding.subjects.push_back(subject);
      }
    } catch (const explore::CutOff& cut) {
      finding.why = cut.what();
      finding.subjects = question.subjects;
    }
    finding.states = parts.markings();
    finding.explanation = std::to_string(parts.markings()) + " markings";
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
