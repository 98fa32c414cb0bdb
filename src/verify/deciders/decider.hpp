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
/// Each method is one class in a file of its own, a function declared here that makes it, and one
/// line in portfolio().
class Decider {
 public:
  Decider() = default;
  virtual ~Decider() = default;
  Decider(const Decider&) = delete;
  Decider& operator=(const Decider&) = delete;
  Decider(Decider&&) = delete;
  Decider& operator=(Decider&&) = delete;

  /// Its name for --method: "circuits".
  [[nodiscard]] virtual const char* name() const = 0;
  /// Its name in verdicts and explanations: "place invariants".
  [[nodiscard]] virtual const char* title() const = 0;

  /// nullopt: the method does not handle such questions. `holds` and `violated` are final. `unknown` says
  /// why, and may name fewer subjects than the question: for the others the property is proved.
  [[nodiscard]] virtual std::optional<Finding> decide(const Question& question, Facts& facts,
                                                      const explore::Limits& limits) const = 0;
  /// May it take long? Such a method is not asked any more once the time is over.
  [[nodiscard]] virtual bool searches() const { return true; }
  /// Is the method tried on such a net, unless another one is named?
  [[nodiscard]] virtual bool suits(const net::Net& /*net*/) const { return true; }
  /// Does the method give runs? When one that does not has found a violation, those that do are asked too.
  [[nodiscard]] virtual bool finds_runs() const { return false; }
};

[[nodiscard]] std::unique_ptr<Decider> by_invariants();
[[nodiscard]] std::unique_ptr<Decider> by_circuits();
[[nodiscard]] std::unique_ptr<Decider> by_waiting();
[[nodiscard]] std::unique_ptr<Decider> by_siphons();
[[nodiscard]] std::unique_ptr<Decider> by_parts();
[[nodiscard]] std::unique_ptr<Decider> by_exploration();

/// All methods, in the order in which they are tried: quick ones first.
[[nodiscard]] const std::vector<std::unique_ptr<Decider>>& portfolio();

}  // namespace tessera::verify
