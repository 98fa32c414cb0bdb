#include "verify/deciders/facts.hpp"

#include <algorithm>

#include "explore/units.hpp"
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

const WaitingReport& Facts::waiting(Assume assume, const explore::Limits& limits) {
  WaitingReport& report = waiting_[assume];
  if (report.complete) return report;
  const NetUnderAssumption& given = under(assume);
  std::vector<const CircuitGroup*> refused;
  for (const CircuitGroup& group : given.circuits->groups)
    if (!group.applies()) refused.push_back(&group);
  report = judge_waiting(*given.communication.structure, refused, limits);
  for (const CircuitGroup& group : given.circuits->groups)
    if (group.applies())
      for (const SubsystemFlowId subsystem : group.subsystems)
        report.goes_on[subsystem.value] = std::ranges::count(group.stuck, subsystem) == 0;
  return report;
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
      if (subject_.net.places()[place].is(net::Layer::behaviour, net::PlaceRole::input)) all.push_back(place);
  return all;
}

net::PlaceId final_place(const net::Net& net) {
  for (std::uint32_t place = 0; place < net.places().size(); ++place)
    if (net.places()[place].is(net::Layer::system, net::PlaceRole::output)) return {place};
  return {};
}

std::string behaviour_of(const net::Net& net, net::PlaceId place) {
  return net.parts().behaviour_path(net[place].subsystem, net[place].behaviour);
}

}  // namespace tessera::verify
