#include "verify/deciders/facts.hpp"

#include <algorithm>

#include "explore/units.hpp"
#include "net/token_game.hpp"
#include "verify/invariants/forbidden.hpp"
#include "verify/invariants/place_invariants.hpp"

namespace tessera::verify {

NetUnderAssumption::NetUnderAssumption(const Subject& subject, Assume assume)
    : abstract(abstract_net(subject.net, assume)), probed(probed_net(abstract)) {
  if (subject.pages == nullptr) {
    communication.why_not = "the net is not made of the five layers";
    return;
  }
  communication = communication_structure(subject.net, assume);
  if (communication.structure) circuits = judge_circuits(*communication.structure);
}

std::string NetUnderAssumption::why_no_circuits() const {
  if (!communication.structure) return communication.why_not;
  for (const CircuitGroup& group : circuits->groups)
    if (!group.applies()) return group.why_not;
  return "the criterion does not tell";
}

Facts::Facts(const Subject& subject, const reduce::Rules& rules)
    : subject_(subject), rules_(rules), wrong_(verify::wrong_invariants(subject.net, subject.invariants)) {}

bool Facts::safe() {
  if (safe_) return *safe_;
  if (subject_.invariants.empty())
    safe_ = explore::units_cover(explore::PtNet(subject_.net));
  else
    safe_ = wrong_.empty() && unbounded_places(subject_.net, subject_.invariants).empty();
  return *safe_;
}

const UnitInvariants& Facts::units() {
  if (!units_) units_.emplace(subject_.net, subject_.invariants);
  return *units_;
}

const NetUnderAssumption& Facts::under(Assume assume) {
  return under_.try_emplace(assume, subject_, assume).first->second;
}

const PartialNets& Facts::partial_nets(Assume assume) {
  return partial_nets_.try_emplace(assume, under(assume).probed.net, subject_.invariants).first->second;
}

const WaitingReport& Facts::waiting(Assume assume, const explore::Limits& limits) {
  Searched<WaitingReport>& searched = waiting_[assume];
  WaitingReport& report = searched.result;
  if (searched.suffices(limits)) return report;
  const NetUnderAssumption& given = under(assume);
  std::vector<const CircuitGroup*> refused;
  for (const CircuitGroup& group : given.circuits->groups)
    if (!group.applies()) refused.push_back(&group);
  report = judge_waiting(*given.communication.structure, refused, limits);
  for (const CircuitGroup& group : given.circuits->groups)
    if (group.applies())
      for (const SubsystemFlowId subsystem : group.subsystems)
        report.goes_on[subsystem.value] = std::ranges::count(group.stuck, subsystem) == 0;
  searched.note(limits, report.complete);
  return report;
}

const Found& Facts::dead_end(Assume assume, const explore::Limits& limits) {
  Searched<Found>& searched = dead_ends_[assume];
  if (searched.suffices(limits)) return searched.result;
  const NetUnderAssumption& given = under(assume);
  const net::PlaceId end = subject_.pages == nullptr ? net::PlaceId{} : final_place(given.abstract);
  searched.result = find_dead(given.abstract, end, reducing(), limits);
  searched.note(limits, searched.result.kind != Found::Kind::unknown);
  return searched.result;
}

namespace {

using Run = std::vector<net::TransitionId>;

/// A run of the abstract net `from` as a run of the abstract net `to`, which is under another assumption. The
/// first `common` transitions are those of the subject. The others, which the abstract nets add, are the same
/// if they have the same name.
std::optional<Run> translated(const Run& run, const net::Net& from, const net::Net& to, std::size_t common) {
  std::map<std::string, net::TransitionId> added;
  for (auto index = static_cast<std::uint32_t>(common); index < to.transitions().size(); ++index)
    added.emplace(to.transitions()[index].name, net::TransitionId{index});
  Run there;
  for (const net::TransitionId id : run) {
    if (id.value < common) {
      there.push_back(id);
      continue;
    }
    const auto found = added.find(from[id].name);
    if (found == added.end()) return std::nullopt;
    there.push_back(found->second);
  }
  return there;
}

/// Does the run lead to a marking, not the final one, in which nothing possible is enabled?
bool is_dead_end(const net::Net& net, const Run& run, net::PlaceId final_place) {
  net::Marking marking = net::initial_marking(net);
  for (const net::TransitionId id : run) {
    if (!possible(net, id) || !net::enabled(net, id, marking)) return false;
    net::fire(net, id, marking);
  }
  if (final_place.valid() && marking[final_place.value] > 0) return false;
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (possible(net, {index}) && net::enabled(net, {index}, marking)) return false;
  return true;
}

}  // namespace

std::vector<std::vector<net::TransitionId>> Facts::known_dead_ends(Assume assume) {
  std::vector<Run> all;
  const net::Net& net = under(assume).abstract;
  const net::PlaceId end = subject_.pages == nullptr ? net::PlaceId{} : final_place(net);
  for (const auto& [of, searched] : dead_ends_) {
    if (searched.result.kind != Found::Kind::yes) continue;
    if (of == assume) {
      all.insert(all.begin(), searched.result.trace);
      continue;
    }
    const std::optional<Run> run =
        translated(searched.result.trace, under(of).abstract, net, subject_.net.transitions().size());
    if (run && is_dead_end(net, *run, end)) all.push_back(*run);
  }
  return all;
}

std::vector<std::uint32_t> Facts::subjects(Question::Kind kind, Assume assume) {
  std::vector<std::uint32_t> all;
  if (kind == Question::Kind::goes_on)
    for (const auto& set : under(assume).probed.subsystems) all.push_back(set.id.value);
  if (kind == Question::Kind::channels_flow)
    for (const auto& set : under(assume).probed.channels) all.push_back(set.id.value);
  if (kind == Question::Kind::exclusive_channels)
    for (const SharedMemory& memory : shared_memories(subject_.net)) all.push_back(memory.id());
  if (kind == Question::Kind::sound_pages)
    for (std::uint32_t page = 0; page < subject_.pages->pages.size(); ++page) all.push_back(page);
  if (kind == Question::Kind::live_behaviours)
    for (std::uint32_t place = 0; place < subject_.net.places().size(); ++place)
      if (subject_.net.places()[place].is(net::Layer::behaviour, PlaceRole::input)) all.push_back(place);
  return all;
}

net::PlaceId final_place(const net::Net& net) {
  for (std::uint32_t place = 0; place < net.places().size(); ++place)
    if (net.places()[place].is(net::Layer::system, PlaceRole::output)) return {place};
  return {};
}

std::string behaviour_of(const net::Net& net, net::PlaceId place) {
  return net.parts().behaviour_path(net[place].subsystem, net[place].behaviour);
}

}  // namespace tessera::verify
