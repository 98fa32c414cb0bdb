#include "reduce/reduce.hpp"
#include "siphons/exclusion.hpp"
#include "verify/deciders/decider.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::PlaceId;

/// Dead markings of the reduced net, with the invariants and traps that are found in it.
class BySiphons final : public Decider {
 public:
  [[nodiscard]] const char* name() const override { return "siphons"; }
  [[nodiscard]] const char* title() const override { return "siphons and traps"; }

  [[nodiscard]] std::optional<Finding> decide(const Question& question, Facts& facts,
                                              const explore::Limits& limits) const override {
    if (question.kind != Question::Kind::deadlock_free) return std::nullopt;
    if (!facts.known_dead_ends(question.assume).empty()) return std::nullopt;
    const net::Net& net = facts.under(question.assume).abstract;
    const PlaceId end = facts.subject().pages == nullptr ? PlaceId{} : final_place(net);
    reduce::Preserve what;
    const Reducing how = facts.reducing();
    what.safe = how.safe;
    if (end.valid()) what.observed.push_back(end);
    const reduce::Reduced reduced = reduce::reduce(net, what, how.rules);
    std::vector<Formula> unwanted{Formula::dead()};
    if (end.valid()) unwanted.push_back(Formula::negation(Formula::marked(*reduced.find(end))));
    explore::Limits share = limits;
    share.time *= 0.5;
    share.progress = nullptr;
    const siphons::Exclusion found =
        siphons::exclude(explore::PtNet(reduced.net), Formula::all(std::move(unwanted)), share,
                         {.conflicts = 20'000, .traps = 2'000});
    Finding finding;
    finding.explanation = std::to_string(reduced.net.places().size()) + " places after reductions, " +
                          std::to_string(found.units) + " invariants and " + std::to_string(found.traps) +
                          " traps";
    finding.why = found.why;
    if (found.kind == siphons::Exclusion::Kind::excluded) finding.kind = Finding::Kind::holds;
    if (found.kind == siphons::Exclusion::Kind::suspected) finding.why = "a siphon without a marked trap";
    return finding;
  }
};

}  // namespace

std::unique_ptr<Decider> by_siphons() { return std::make_unique<BySiphons>(); }

}  // namespace tessera::verify
