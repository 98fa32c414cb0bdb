#include "verify/deciders/decider.hpp"
#include "verify/invariants/covered.hpp"
#include "verify/search/claims.hpp"

namespace tessera::verify {
namespace {

/// holds, but for the gaps.
Finding unless(const std::vector<Gap>& gaps) {
  if (gaps.empty()) return {.kind = Finding::Kind::holds};
  Finding finding;
  finding.why = gaps.front().why;
  for (const Gap& gap : gaps) finding.subjects.push_back(gap.subject);
  return finding;
}

/// Invariants say what cannot be; of that, they tell each kind of property something else.
Finding claims(const Question& question, Facts& facts) {
  using Kind = net::Property::Kind;
  const Kind kind = question.property->kind;
  Finding finding;
  finding.why = "the invariants do not exclude it";
  for (const std::uint32_t number : question.subjects) {
    const net::Claim& claim = question.property->claims[number];
    const bool excluded = facts.units().exclude(what_of(kind, claim));
    const bool wanted = kind == Kind::reachable || kind == Kind::always_reachable;
    if (excluded && !wanted) continue;
    if (excluded)
      return {.kind = Finding::Kind::violated, .why = complaint(kind, claim), .subjects = {number}};
    finding.subjects.push_back(number);
  }
  if (finding.subjects.empty()) return {.kind = Finding::Kind::holds};
  return finding;
}

/// Sums of tokens that no firing changes: those that the layers emit, or those that are found in a net
/// of another origin.
class ByInvariants final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "invariants"; }
  [[nodiscard]] const char* title() const override { return "place invariants"; }
  [[nodiscard]] bool searches() const override { return false; }

  [[nodiscard]] std::optional<Finding> decide(const Question& question, Facts& facts,
                                              const explore::Limits& /*limits*/) const override {
    const Subject& subject = facts.subject();
    Finding finding;
    if (subject.invariants.empty()) {
      if (question.kind != Question::Kind::safe) return std::nullopt;
      if (facts.safe()) finding.kind = Finding::Kind::holds;
      finding.why = facts.safe() ? "" : "no invariants were found that bound every place";
      return finding;
    }
    if (!facts.wrong_invariants().empty()) {
      finding.why = facts.wrong_invariants().front();
      return finding;
    }
    switch (question.kind) {
      case Question::Kind::safe:
        finding.why = facts.safe() ? "" : "the invariants do not bound every place";
        break;
      case Question::Kind::exclusive_channels:
        return unless(uncovered_memories(subject.net, facts.units()));
      case Question::Kind::sound_pages:
        return unless(uncovered_pages(*subject.pages, subject.net, facts.units()));
      case Question::Kind::claims:
        return claims(question, facts);
      default:
        return std::nullopt;
    }
    finding.kind = finding.why.empty() ? Finding::Kind::holds : Finding::Kind::unknown;
    return finding;
  }
};

}  // namespace

std::unique_ptr<Decider> by_invariants() { return std::make_unique<ByInvariants>(); }

}  // namespace tessera::verify
