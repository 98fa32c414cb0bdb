#include "verify/facts.hpp"

#include "verify/forbidden.hpp"
#include "verify/place_invariants.hpp"

namespace tessera::verify {

Case::Case(const Subject& subject, Assume assume)
    : abstract(abstract_net(subject.net, assume)), probed(probed_net(abstract)) {
  if (subject.pages == nullptr) {
    communication.why_not = "the net is not made of the five layers";
    return;
  }
  communication = communication_structure(subject.net, assume);
  if (communication.structure) circuits = judge_circuits(*communication.structure);
}

std::string Case::why_no_circuits() const {
  if (!communication.structure) return communication.why_not;
  for (const CircuitGroup& group : circuits->groups)
    if (!group.applies()) return group.why_not;
  return "the criterion does not tell";
}

Facts::Facts(const Subject& subject)
    : subject_(subject), wrong_(verify::wrong_invariants(subject.net, subject.invariants)) {
  if (wrong_.empty() && !subject.invariants.empty())
    safe_ = unbounded_places(subject.net, subject.invariants).empty();
}

const UnitInvariants& Facts::units() {
  if (!units_) units_.emplace(subject_.net, subject_.invariants);
  return *units_;
}

const Case& Facts::under(Assume assume) {
  std::optional<Case>& wanted = assume == Assume::conditions ? conditions_ : exceptions_;
  if (!wanted) wanted.emplace(subject_, assume);
  return *wanted;
}

std::vector<std::uint32_t> Facts::subjects(Question::Kind kind, Assume assume) {
  std::vector<std::uint32_t> all;
  const bool of_sets = kind == Question::Kind::goes_on || kind == Question::Kind::channels_flow;
  if (of_sets) {
    const ProbedNet& probed = under(assume).probed;
    for (const ProbedNet::Set& set : kind == Question::Kind::goes_on ? probed.subsystems : probed.channels)
      all.push_back(set.id);
  }
  if (kind == Question::Kind::exclusive_channels)
    for (const SharedMemory& memory : shared_memories(subject_.net)) all.push_back(memory.id());
  if (kind == Question::Kind::sound_pages)
    for (std::uint32_t page = 0; page < subject_.pages->pages.size(); ++page) all.push_back(page);
  if (kind == Question::Kind::live_behaviours)
    for (std::uint32_t place = 0; place < subject_.net.places().size(); ++place)
      if (subject_.net.places()[place].operation.kind == net::Operation::Kind::transition_function)
        all.push_back(place);
  return all;
}

std::string behaviour_of(const net::Net& net, net::PlaceId place) {
  return net[place].name.substr(0, net[place].name.rfind('.'));
}

}  // namespace tessera::verify
