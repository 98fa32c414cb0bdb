#include <algorithm>
#include <set>

#include "verify/circuits/strict_sides.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/waiting/waiting.hpp"

namespace tessera::verify {
namespace {

Finding open(const WaitingReport& report, std::vector<std::uint32_t> subjects) {
  return {.why = report.why_not, .subjects = std::move(subjects)};
}

/// A subsystem that goes on for ever keeps the system free of deadlocks.
bool deadlock_free(const CommunicationStructure& structure, const std::vector<bool>& goes_on) {
  for (std::uint32_t index = 0; index < goes_on.size(); ++index)
    if (goes_on[index] && std::ranges::none_of(structure.subsystems[index].behaviours, &BehaviourFlow::ends))
      return true;
  return std::ranges::all_of(goes_on, [](bool known) { return known; });
}

/// Behaviours and their subsystems that go on, and so come to everything that may follow.
std::set<std::string> certainly_reached(const CommunicationStructure& structure,
                                        const std::vector<bool>& goes_on) {
  std::set<std::string> reached;
  for (std::uint32_t index = 0; index < goes_on.size(); ++index)
    if (goes_on[index])
      for (const BehaviourFlow& behaviour : structure.subsystems[index].behaviours)
        reached.insert(behaviour.name);
  return reached;
}

/// Circular waits: subsystems that wait for each other: docs/theory/waiting.md.
class ByWaiting final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "waiting"; }
  [[nodiscard]] const char* title() const override { return "circular waits"; }

  [[nodiscard]] std::optional<Finding> decide(const Question& question, Facts& facts,
                                              const explore::Limits& limits) const override {
    using Kind = Question::Kind;
    const bool asked = question.kind == Kind::deadlock_free || question.kind == Kind::goes_on ||
                       question.kind == Kind::channels_flow || question.kind == Kind::live_behaviours;
    if (!asked || !facts.under(question.assume).communication.structure) return std::nullopt;
    const NetUnderAssumption& given = facts.under(question.assume);
    // A subsystem that has not ended in a dead marking does not go on.
    const bool refuted = (question.kind == Kind::deadlock_free || question.kind == Kind::goes_on) &&
                         !facts.known_dead_ends(question.assume).empty();
    if (refuted) return std::nullopt;
    if (question.assume == Assume::partition && !strict_sides(*given.communication.structure).empty())
      return std::nullopt;
    const WaitingReport& report = facts.waiting(question.assume, limits);
    Finding finding = judge(question, given, report);
    finding.explanation = std::to_string(report.stops) + " places to wait at, " +
                          std::to_string(report.traps) + " traps that keep a token";
    return finding;
  }

 private:
  static Finding judge(const Question& question, const NetUnderAssumption& given,
                       const WaitingReport& report) {
    const CommunicationStructure& structure = *given.communication.structure;
    if (question.kind == Question::Kind::deadlock_free) {
      if (deadlock_free(structure, report.goes_on)) return {.kind = Finding::Kind::holds};
      return open(report, {});
    }
    std::vector<std::uint32_t> left = question.subjects;
    if (question.kind == Question::Kind::live_behaviours) {
      const std::set<std::string> reached = certainly_reached(structure, report.goes_on);
      std::erase_if(
          left, [&](std::uint32_t place) { return reached.contains(behaviour_of(given.abstract, {place})); });
    } else {
      const std::set<std::uint32_t> good = question.kind == Question::Kind::goes_on
                                               ? going_on(structure, report.goes_on)
                                               : flowing(structure, report.goes_on);
      std::erase_if(left, [&](std::uint32_t subject) { return good.contains(subject); });
    }
    if (left.empty()) return {.kind = Finding::Kind::holds};
    return open(report, std::move(left));
  }

  static std::set<std::uint32_t> going_on(const CommunicationStructure& structure,
                                          const std::vector<bool>& goes_on) {
    std::set<std::uint32_t> ids;
    for (std::uint32_t index = 0; index < goes_on.size(); ++index)
      if (goes_on[index]) ids.insert(structure.subsystems[index].id.value);
    return ids;
  }

  static std::set<std::uint32_t> flowing(const CommunicationStructure& structure,
                                         const std::vector<bool>& goes_on) {
    const std::vector<bool> flows = flowing_channels(structure, goes_on);
    std::set<std::uint32_t> ids;
    for (std::uint32_t index = 0; index < flows.size(); ++index)
      if (flows[index]) ids.insert(structure.channels[index].id.value);
    return ids;
  }
};

}  // namespace

std::unique_ptr<Decider> by_waiting() { return std::make_unique<ByWaiting>(); }

}  // namespace tessera::verify
