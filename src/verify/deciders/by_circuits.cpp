#include <algorithm>
#include <set>

#include "verify/circuits/strict_sides.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/deciders/running_claims.hpp"

namespace tessera::verify {
namespace {

using net::PlaceId;

Finding violated(std::string why, std::vector<std::uint32_t> subjects) {
  return {.kind = Finding::Kind::violated, .why = std::move(why), .subjects = std::move(subjects)};
}

Finding holds() { return {.kind = Finding::Kind::holds}; }

Finding open(const NetUnderAssumption& given, std::vector<std::uint32_t> subjects) {
  return {.why = given.why_no_circuits(), .subjects = std::move(subjects)};
}

std::string stuck_in_words(const NetUnderAssumption& given) {
  for (const CircuitGroup& group : given.circuits->groups) {
    if (group.stuck.empty()) continue;
    const CommunicationStructure& structure = *given.communication.structure;
    std::string words = in_words(structure, group);
    if (words.empty()) words = structure[group.stuck.front()].name + " can get stuck for ever";
    return words;
  }
  return {};
}

/// The circuit that stuck_in_words names.
std::vector<SubsystemAtEnd> stuck_at_end(const NetUnderAssumption& given) {
  const auto stuck = std::ranges::find_if(given.circuits->groups,
                                          [](const CircuitGroup& group) { return !group.stuck.empty(); });
  return stuck == given.circuits->groups.end() ? std::vector<SubsystemAtEnd>()
                                               : at_end(*given.communication.structure, *stuck);
}

Finding stuck(const NetUnderAssumption& given, std::vector<std::uint32_t> subjects) {
  Finding finding = violated(stuck_in_words(given), std::move(subjects));
  finding.waits = stuck_at_end(given);
  return finding;
}

Finding deadlock_free(const NetUnderAssumption& given) {
  if (given.circuits->deadlock_free == Answer::yes) return holds();
  if (given.circuits->deadlock_free == Answer::no) return stuck(given, {});
  return open(given, {});
}

/// One subsystem that is stuck is enough for a run: the one that stuck_in_words names first.
std::vector<std::uint32_t> first_stuck(const NetUnderAssumption& given) {
  for (const CircuitGroup& group : given.circuits->groups) {
    if (group.stuck.empty()) continue;
    SubsystemFlowId first = group.stuck.front();
    if (!group.circuit.empty() && std::ranges::count(group.stuck, group.circuit.front().subsystem) > 0)
      first = group.circuit.front().subsystem;
    return {(*given.communication.structure)[first].id.value};
  }
  return {};
}

Finding goes_on(const NetUnderAssumption& given, std::vector<std::uint32_t> subjects) {
  if (given.circuits->goes_on == Answer::yes) return holds();
  if (given.circuits->goes_on == Answer::no) return stuck(given, first_stuck(given));
  std::set<std::uint32_t> decided;
  for (const CircuitGroup& group : given.circuits->groups)
    if (group.applies())
      for (const SubsystemFlowId subsystem : group.subsystems)
        decided.insert((*given.communication.structure)[subsystem].id.value);
  std::erase_if(subjects, [&](std::uint32_t subsystem) { return decided.contains(subsystem); });
  return open(given, std::move(subjects));
}

/// Without strict sides over a network, a cut link changes no answer.
std::optional<Finding> stopped_by_cut(const NetUnderAssumption& given) {
  const CommunicationStructure& structure = *given.communication.structure;
  const std::vector<StrictSide> sides = strict_sides(structure);
  if (sides.empty()) return std::nullopt;
  Finding finding = violated(in_words(structure, sides), {structure[sides.front().subsystem].id.value});
  finding.method = "sides that wait for the network";
  finding.hint = timeout_hint(structure, given.abstract, sides);
  return finding;
}

Finding channels_flow(const NetUnderAssumption& given, std::vector<std::uint32_t> subjects) {
  const CommunicationStructure& structure = *given.communication.structure;
  if (!given.circuits->dry.empty()) {  // the run has to be of the channel that is named
    const ChannelFlow& dry = structure[given.circuits->dry.front()];
    return violated(dry.name + " can run dry for ever" + (dry.absence.empty() ? "" : ": " + dry.absence),
                    {dry.id.value});
  }
  std::set<std::uint32_t> clear;
  for (const ChannelFlow& channel : structure.channels) clear.insert(channel.id.value);
  for (const ChannelFlowId channel : given.circuits->unclear) clear.erase(structure[channel].id.value);
  std::erase_if(subjects, [&](std::uint32_t channel) { return clear.contains(channel); });
  return subjects.empty() ? holds() : open(given, std::move(subjects));
}

/// Selects, from places that start a behaviour, those of behaviours that follow no behaviour that can run.
std::vector<std::uint32_t> never_following(const NetUnderAssumption& given,
                                           const std::vector<std::uint32_t>& places) {
  std::set<std::string> reached;
  for (const SubsystemFlow& subsystem : given.communication.structure->subsystems)
    for (const BehaviourFlow& behaviour : subsystem.behaviours) reached.insert(behaviour.name);
  std::vector<std::uint32_t> never;
  for (const std::uint32_t place : places)
    if (!reached.contains(behaviour_of(given.abstract, {place}))) never.push_back(place);
  return never;
}

/// A subsystem that always goes on comes to the end of every round, where everything that may follow can;
/// and each starts with its first behaviour.
std::set<std::string> certainly_reached(const NetUnderAssumption& given) {
  std::set<std::string> reached;
  for (const CircuitGroup& group : given.circuits->groups)
    for (const SubsystemFlowId subsystem : group.subsystems) {
      const SubsystemFlow& flow = (*given.communication.structure)[subsystem];
      reached.insert(flow.behaviours.front().name);
      if (group.applies() && std::ranges::count(group.stuck, subsystem) == 0)
        for (const BehaviourFlow& behaviour : flow.behaviours) reached.insert(behaviour.name);
    }
  return reached;
}

Finding live_behaviours(const NetUnderAssumption& given, std::vector<std::uint32_t> places) {
  constexpr const char* by_structure = "communication structure";
  Finding finding;
  if (std::vector<std::uint32_t> never = never_following(given, places); !never.empty()) {
    const std::string first = behaviour_of(given.abstract, {never.front()});
    finding = violated(first + " follows no behaviour that can run", std::move(never));
    finding.method = by_structure;
    return finding;
  }
  const std::set<std::string> reached = certainly_reached(given);
  std::erase_if(places, [&](std::uint32_t place) {
    return reached.contains(behaviour_of(given.abstract, PlaceId{place}));
  });
  finding = places.empty() ? holds() : open(given, std::move(places));
  finding.method = by_structure;
  return finding;
}

/// Behaviours that run, or lead to each other.
std::optional<Finding> claims(const NetUnderAssumption& given, const net::HierarchicalNet& pages,
                              const Question& question) {
  Finding finding = open(given, {});
  for (const std::uint32_t number : question.subjects) {
    const net::Claim& claim = question.property->claims[number];
    const RunningVerdict verdict = judge_running(given, pages, question.property->kind, claim);
    if (verdict.answer == Answer::no) {
      const std::string about = claim.about.empty() ? "" : claim.about + ": ";
      return violated(about + verdict.why, {number});
    }
    if (verdict.answer == Answer::unknown) finding.subjects.push_back(number);
  }
  if (finding.subjects.empty()) return holds();
  // It does not handle properties that are not about running behaviours.
  if (finding.subjects.size() == question.subjects.size() && given.circuits->goes_on == Answer::yes)
    return std::nullopt;
  return finding;
}

/// Communication structure and event graph: docs/theory/circuits.md.
class ByCircuits final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "circuits"; }
  [[nodiscard]] const char* title() const override { return "circuits"; }
  [[nodiscard]] bool searches() const override { return false; }

  [[nodiscard]] std::optional<Finding> decide(const Question& question, Facts& facts,
                                              const explore::Limits& /*limits*/) const override {
    using Kind = Question::Kind;
    if (question.kind == Kind::safe || question.kind == Kind::exclusive_channels ||
        question.kind == Kind::sound_pages)
      return std::nullopt;
    const NetUnderAssumption& given = facts.under(question.assume);
    if (!given.circuits) return open(given, question.subjects);
    if (question.assume == Assume::partition && question.kind == Kind::goes_on)
      if (std::optional<Finding> stopped = stopped_by_cut(given)) return stopped;
    switch (question.kind) {
      case Kind::deadlock_free:
        return deadlock_free(given);
      case Kind::goes_on:
        return goes_on(given, question.subjects);
      case Kind::channels_flow:
        return channels_flow(given, question.subjects);
      case Kind::live_behaviours:
        return live_behaviours(given, question.subjects);
      case Kind::claims:
        return claims(given, *facts.subject().pages, question);
      default:
        return std::nullopt;
    }
  }
};

}  // namespace

std::unique_ptr<Decider> by_circuits() { return std::make_unique<ByCircuits>(); }

}  // namespace tessera::verify
