#pragma once

#include <string>
#include <utility>

#include "verify/deciders/decider.hpp"
#include "verify/deciders/question.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {

inline constexpr const char* none_applies = "the methods that were allowed do not apply";

/// The answers of the methods asked so far to one question.
class Answering {
 public:
  explicit Answering(Question question) : question_(std::move(question)) {
    result_.method = "no method";
    result_.why = none_applies;
  }

  [[nodiscard]] bool wants(const Decider& decider) const {
    if (result_.verdict == Verdict::unknown) return true;
    return result_.verdict == Verdict::violated && !result_.has_trace && has_runs(question_) &&
           decider.finds_runs();
  }
  [[nodiscard]] bool only_run() const { return result_.verdict == Verdict::violated; }
  [[nodiscard]] bool lacks_run() const { return only_run() && !result_.has_trace && has_runs(question_); }
  void cut_off(std::string what) {
    if (result_.cut_off.empty()) result_.cut_off = std::move(what);
  }
  [[nodiscard]] const Question& question() const { return question_; }
  [[nodiscard]] PropertyResult result() && { return std::move(result_); }

  void hear(Finding finding, const Decider& decider) {
    result_.states += finding.states;
    if (!finding.explanation.empty()) result_.explanation = std::move(finding.explanation);
    const std::string method = finding.method.empty() ? decider.title() : finding.method;
    if (only_run()) {
      if (finding.kind == Finding::Kind::violated) show(finding);
      return;
    }
    if (finding.kind == Finding::Kind::unknown) {
      result_.why = result_.why == none_applies
                        ? finding.why
                        : finding.why + " (and " + result_.method + ": " + result_.why + ")";
    } else {
      const bool holds = finding.kind == Finding::Kind::holds;
      result_.verdict = holds ? Verdict::holds : Verdict::violated;
      result_.why = std::move(finding.why);
      result_.hint = std::move(finding.hint);
      if (!holds) show(finding);
    }
    result_.method = method;
    // A decider that could say nothing, and names no subject, leaves all of them open.
    const bool is_silent = finding.kind == Finding::Kind::unknown && finding.subjects.empty();
    if (finding.kind != Finding::Kind::holds && !is_silent) question_.subjects = std::move(finding.subjects);
  }

 private:
  void show(Finding& finding) {
    result_.has_trace = finding.has_trace;
    result_.trace = std::move(finding.trace);
    result_.waits = std::move(finding.waits);
    result_.cut_off = std::move(finding.cut_off);
  }

  Question question_;
  PropertyResult result_;
};

}  // namespace tessera::verify
