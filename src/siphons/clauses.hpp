#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "explore/watch.hpp"

namespace tessera::siphons {

/// A question to a SAT solver that can be extended between answers. A literal is the number of a variable;
/// a negative number is its negation.
///
/// Threads: one. Gives up when the watch does.
class Clauses {
 public:
  explicit Clauses(explore::Watch& watch);
  ~Clauses();
  Clauses(const Clauses&) = delete;
  Clauses& operator=(const Clauses&) = delete;
  Clauses(Clauses&&) = delete;
  Clauses& operator=(Clauses&&) = delete;

  /// A new variable.
  [[nodiscard]] int variable() { return ++last_; }
  /// Adds a clause: one of the literals is true.
  void add(const std::vector<int>& literals);
  /// A literal that is true if and only if all of these are.
  [[nodiscard]] int all_of(const std::vector<int>& literals);

  enum class Answer : std::uint8_t { satisfied, contradiction, gave_up };
  /// Gives up after so many conflicts (nullopt: never), or when the watch ends it.
  [[nodiscard]] Answer solve(std::optional<int> most_conflicts = std::nullopt);
  /// Precondition: satisfied, and nothing was added since.
  [[nodiscard]] bool is_true(int literal) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> solver_;
  int last_ = 0;
};

}  // namespace tessera::siphons
