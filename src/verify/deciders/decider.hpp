#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "explore/watch.hpp"
#include "verify/deciders/facts.hpp"
#include "verify/deciders/question.hpp"

namespace tessera::verify {

/// One method that decides questions.
///
/// A method is one class in a file of its own, made by a function declared here, and one line in portfolio().
class Decider {
 public:
  Decider() = default;
  virtual ~Decider() = default;
  Decider(const Decider&) = delete;
  Decider& operator=(const Decider&) = delete;
  Decider(Decider&&) = delete;
  Decider& operator=(Decider&&) = delete;

  /// What --method calls it: "circuits".
  [[nodiscard]] virtual const char* name() const = 0;
  /// What verdicts and explanations call it: "place invariants".
  [[nodiscard]] virtual const char* title() const = 0;

  /// nullopt: the method has nothing to do with such questions. A verdict is final. `unknown` says why, and
  /// may name fewer subjects than the question: the others are settled, in favour of the property.
  [[nodiscard]] virtual std::optional<Finding> decide(const Question& question, Facts& facts,
                                                      const explore::Limits& limits) const = 0;
  /// Does it come with runs? When a method that does not has found a violation, those that do are asked too.
  [[nodiscard]] virtual bool finds_runs() const { return false; }
};

[[nodiscard]] std::unique_ptr<Decider> by_invariants();
[[nodiscard]] std::unique_ptr<Decider> by_circuits();
[[nodiscard]] std::unique_ptr<Decider> by_waiting();
[[nodiscard]] std::unique_ptr<Decider> by_siphons();
[[nodiscard]] std::unique_ptr<Decider> by_exploration();

/// All methods, in the order in which they are tried: quick ones first.
[[nodiscard]] const std::vector<std::unique_ptr<Decider>>& portfolio();

}  // namespace tessera::verify
