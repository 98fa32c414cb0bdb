#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "explore/budget.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/search/claims.hpp"
#include "verify/search/local_view.hpp"
#include "verify/search/parts.hpp"

namespace tessera::verify {
namespace {

using net::PlaceId;
using net::SubsystemId;
using Asked = LocalViews::Question;
using Members = LocalViews::Members;

constexpr std::size_t most_members = 5;

/// One question to the net, answered by views around subsystems.
class Views {
 public:
  Views(const net::Net& net, LocalViews& views, const explore::Budget& budget)
      : net_(net), views_(views), budget_(budget) {
    filled_.assign(net.places().size(), false);
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (possible(net, {index}))
        for (const net::Arc& arc : net.postset(net::TransitionId{index})) filled_[arc.place.value] = true;
    for (std::uint32_t index = 0; index < filled_.size(); ++index)
      if (net.places()[index].tokens > 0) filled_[index] = true;
  }

  /// about: the subsystems that the question is about.
  bool holds(const Members& about, const Asked& asked) {
    if (about.empty() || about.size() > most_members) return false;
    Members members = about, all_peers;
    for (const SubsystemId one : about)
      for (const SubsystemId peer : views_.peers(one)) {
        if (!about.contains(peer) && !all_peers.insert(peer).second) members.insert(peer);
      }
    for (const SubsystemId member : members) all_peers.erase(member);
    std::set<PlaceId> settled;
    if (members.size() > most_members) return false;
    if (tried(members, asked, settled)) return true;
    if (asked.kind == Asked::Kind::never && all_peers.size() > most_members) return false;
    for (const SubsystemId peer : all_peers) {
      Members more = members;
      more.insert(peer);
      if (tried(more, asked, settled)) return true;
    }
    if (asked.kind != Asked::Kind::never && covers(about, asked, settled)) return true;
    if (all_peers.size() < 2 || all_peers.size() + members.size() > most_members) return false;
    members.insert(all_peers.begin(), all_peers.end());
    return tried(members, asked, settled);
  }

 private:
  /// settled: places with which a marking is certainly none of those where the answer is no.
  bool tried(const Members& members, const Asked& asked, std::set<PlaceId>& settled) {
    const LocalViews::Answer answer = views_.judge(members, asked, budget_);
    if (!answer.known) return false;
    settled.insert(answer.settled.begin(), answer.settled.end());
    return answer.holds;
  }

  /// Whether every marking has a token in a settled place.
  bool covers(const Members& about, const Asked& asked, const std::set<PlaceId>& settled) const {
    std::vector<std::set<PlaceId>> groups;
    for (const SubsystemId one : about) {
      std::set<PlaceId> control;
      for (std::uint32_t index = 0; index < net_.places().size(); ++index) {
        const net::Place& place = net_.places()[index];
        if (place.fact.valid() || place.channel.valid() || !filled_[index]) continue;
        const bool above =
            !place.subsystem.valid() &&
            (place.tokens > 0 || (place.agent.valid() && place.agent == net_.parts()[one].agent &&
                                  place.role == PlaceRole::input));
        if (place.subsystem == one || above) control.insert({index});
      }
      groups.push_back(std::move(control));
    }
    for (const PlaceId place : asked.places) {
      if (!net_[place].fact.valid()) continue;
      std::set<PlaceId> values;
      for (std::uint32_t index = 0; index < net_.places().size(); ++index)
        if (net_.places()[index].fact == net_[place].fact) values.insert({index});
      groups.push_back(std::move(values));
    }
    return std::ranges::any_of(groups, [&](const std::set<PlaceId>& group) {
      return std::ranges::includes(settled, group) && always_marked(group);
    });
  }

  /// Whether some of the places always holds a token: one is marked at the start, and each transition that can fire
  /// and takes from them gives to them.
  [[nodiscard]] bool always_marked(const std::set<PlaceId>& places) const {
    const auto inside = [&](const net::Arc& arc) { return places.contains(arc.place); };
    const auto is_filled = [&](const net::Arc& arc) { return filled_[arc.place.value]; };
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index) {
      const net::TransitionId id{index};
      if (!possible(net_, id) || !std::ranges::all_of(net_.preset(id), is_filled)) continue;
      if (std::ranges::any_of(net_.preset(id), inside) && std::ranges::none_of(net_.postset(id), inside))
        return false;
    }
    return std::ranges::any_of(places, [&](PlaceId place) { return net_[place].tokens > 0; });
  }

  const net::Net& net_;
  LocalViews& views_;
  const explore::Budget& budget_;
  std::vector<bool> filled_;  // per place: it may hold a token
};

/// The subsystems of places; nullopt: some belong to none.
std::optional<Members> owners(const LocalViews& views, const std::vector<PlaceId>& places) {
  Members all;
  for (const PlaceId place : places) {
    if (!views.owner(place).valid()) return std::nullopt;
    all.insert(views.owner(place));
  }
  return all;
}

/// Pictures of the net around a few subsystems: docs/theory/verification.md. For nets whose subsystems know something
/// (net::Parts::Fact), where circuits say little.
class ByLocalViews final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "views"; }
  [[nodiscard]] const char* title() const override { return "local views"; }

  [[nodiscard]] std::optional<Finding> decide(const Question& question, Facts& facts,
                                              const explore::Limits& limits) const override {
    using Kind = Question::Kind;
    const bool asked =
        question.kind == Kind::goes_on || question.kind == Kind::channels_flow ||
        (question.kind == Kind::claims && question.property->kind != net::Property::Kind::reachable);
    if (!asked || question.assume == Assume::partition || facts.subject().pages == nullptr)
      return std::nullopt;
    const net::Net& net = facts.subject().net;
    if (std::ranges::none_of(net.places(), [](const net::Place& place) { return place.fact.valid(); }))
      return std::nullopt;
    explore::Limits share = limits;
    share.time *= 0.5;
    const explore::Budget budget(share);
    Views all(facts.under(question.assume).probed.net, facts.local_views(question.assume), budget);
    Finding finding{.why = "local views do not show it", .subjects = question.subjects};
    std::erase_if(finding.subjects,
                  [&](std::uint32_t subject) { return holds(question, subject, facts, all); });
    if (finding.subjects.empty()) return Finding{.kind = Finding::Kind::holds};
    return finding;
  }

 private:
  static bool holds(const Question& question, std::uint32_t subject, Facts& facts, Views& all) {
    const ProbedNet& probed = facts.under(question.assume).probed;
    if (question.kind == Question::Kind::claims)
      return claim(question, subject, all, facts.local_views(question.assume));
    Asked asked{.kind = Asked::Kind::always_possible};
    Members about;
    const auto ask = [&](const auto& sets) {
      for (const auto& set : sets)
        if (set.id.value == subject) asked.any_of = set.any_of;
    };
    question.kind == Question::Kind::goes_on ? ask(probed.subsystems) : ask(probed.channels);
    for (const net::TransitionId id : asked.any_of)
      if (probed.net[id].subsystem.valid()) about.insert(probed.net[id].subsystem);
    return !asked.any_of.empty() && all.holds(about, asked);
  }

  static bool claim(const Question& question, std::uint32_t number, Views& all, const LocalViews& views) {
    using Kind = net::Property::Kind;
    const Kind kind = question.property->kind;
    const net::Claim& claim = question.property->claims[number];
    Asked asked;
    asked.what = what_of(kind, claim);
    asked.then = formula_of(claim.then);
    if (kind == Kind::leads_to) asked.kind = Asked::Kind::leads_to;
    if (kind == Kind::always_reachable) {
      asked.kind = Asked::Kind::always_possible;
      asked.then = std::exchange(asked.what, explore::Formula::never());
    }
    places_of(asked.what, asked.places);
    places_of(asked.then, asked.places);
    const std::optional<Members> about = owners(views, asked.places);
    return about && all.holds(*about, asked);
  }
};

}  // namespace

std::unique_ptr<Decider> by_local_views() { return std::make_unique<ByLocalViews>(); }

}  // namespace tessera::verify
