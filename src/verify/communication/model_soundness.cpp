#include "verify/communication/model_soundness.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "explore/explore.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::Operation;
using net::PlaceId;
using net::TransitionId;

class ModelJudgement {
 public:
  ModelJudgement(const ClosedModel& model, diagnostics::Diagnostics& out)
      : model_(model), net_(model.net), explored_(model.net), out_(out) {
    limits_.time = std::chrono::seconds(20);
    limits_.bytes = std::uint64_t{1} << 28U;
  }

  bool result() {
    const std::size_t before = out_.error_count();
    // The other questions suppose a safe net.
    if (judge_safety()) {
      judge_slots();
      judge_progress();
    }
    return out_.error_count() == before;
  }

 private:
  bool judge_safety() {
    std::vector<Formula> two;
    for (std::uint32_t place = 0; place < net_.places().size(); ++place)
      two.push_back(Formula::at_least({place}, 2));
    const explore::Answer answer = explore::find(explored_, Formula::any(std::move(two)), limits_);
    if (answer.kind == explore::Answer::Kind::no) return true;
    if (answer.kind == explore::Answer::Kind::unknown) return give_up(answer);
    for (std::uint32_t place = 0; place < net_.places().size(); ++place)
      if (answer.trace.end[place] > 1) {
        complain("E431", net_.places()[place].span,
                 "is not safe: place '" + net_.places()[place].name + "' holds two tokens", answer,
                 "take the place's token before giving it one");
        break;
      }
    return false;
  }

  void judge_slots() {
    for (const PlaceId write : places_of(Operation::Kind::write))
      for (const PlaceId read : places_of(Operation::Kind::read)) {
        if (net_[write].operation.slot != net_[read].operation.slot) continue;
        const Formula both = Formula::all({Formula::marked(write), Formula::marked(read)});
        const explore::Answer answer = explore::find(explored_, both, limits_);
        if (answer.kind == explore::Answer::Kind::unknown) give_up(answer);
        if (answer.kind == explore::Answer::Kind::yes)
          complain(
              "E432", net_[read].span,
              "lets slot " + std::to_string(net_[write].operation.slot + 1) + " be written and read at once",
              answer, "both sides must take one token for it, and give it back when they are done");
      }
  }

  /// The transitions that start an operation.
  [[nodiscard]] std::vector<TransitionId> starting(Operation::Kind kind) const {
    std::vector<TransitionId> found;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      if (net_[net_.postset({index}).front().place].operation.kind == kind) found.push_back({index});
    return found;
  }

  void judge_progress() {
    const std::vector<std::pair<std::vector<TransitionId>, std::string>> wanted{
        {{model_.sends_again}, "can get stuck: 'send' never comes to 'out' again"},
        {{model_.receives_again}, "can get stuck: 'receive' never comes to 'out' again"},
        {starting(Operation::Kind::write), "can run dry: nothing is ever written again"},
        {starting(Operation::Kind::read), "can run dry: nothing is ever read again"}};
    std::vector<explore::Obligation> obligations;
    for (const auto& [transitions, problem] : wanted) obligations.push_back({transitions});
    const std::vector<explore::Answer> answers = explore::can_always_fire(explored_, obligations, limits_);
    // A side that is stuck says more than the consequences of this.
    for (std::size_t index = 0; index < wanted.size(); ++index) {
      if (answers[index].kind == explore::Answer::Kind::yes) continue;
      if (answers[index].kind == explore::Answer::Kind::unknown) give_up(answers[index]);
      if (answers[index].kind == explore::Answer::Kind::no)
        complain("E433", model_.span, wanted[index].second, answers[index],
                 "from every marking a partner who goes on must be able to bring both sides to their end");
      return;
    }
  }

  [[nodiscard]] std::vector<PlaceId> places_of(Operation::Kind kind) const {
    std::vector<PlaceId> found;
    for (std::uint32_t index = 0; index < net_.places().size(); ++index)
      if (net_.places()[index].operation.kind == kind) found.push_back({index});
    return found;
  }

  void complain(const char* code, diagnostics::Span span, const std::string& problem,
                const explore::Answer& answer, const char* hint) {
    std::string run;
    for (const TransitionId id : answer.trace.firings) run += (run.empty() ? "" : ", ") + net_[id].name;
    out_.error(
        code, span.line > 0 ? span : model_.span,
        "model '" + model_.name + "' " + problem + (run.empty() ? ", from the start" : " after " + run),
        hint);
  }

  bool give_up(const explore::Answer& answer) {
    out_.error("E434", model_.span, "model '" + model_.name + "' is too large to be judged: " + answer.why);
    return false;
  }

  const ClosedModel& model_;
  const net::Net& net_;
  explore::PtNet explored_;
  explore::Limits limits_;
  diagnostics::Diagnostics& out_;
};

}  // namespace

bool judge_soundness(const ClosedModel& model, diagnostics::Diagnostics& out) {
  return ModelJudgement(model, out).result();
}

}  // namespace tessera::verify
