#include "siphons/clauses.hpp"

#include <cadical.hpp>

namespace tessera::siphons {

class Clauses::Implementation final : public CaDiCaL::Terminator {
 public:
  explicit Implementation(explore::Watch& watch) : watch_(watch) {
    solver.set("quiet", 1);
    solver.connect_terminator(this);
  }
  ~Implementation() override { solver.disconnect_terminator(); }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  Implementation(Implementation&&) = delete;
  Implementation& operator=(Implementation&&) = delete;

  bool terminate() override { return !watch_.go_on(0, 0); }

  CaDiCaL::Solver solver;

 private:
  explore::Watch& watch_;
};

Clauses::Clauses(explore::Watch& watch) : solver_(std::make_unique<Implementation>(watch)) {}
Clauses::~Clauses() = default;

void Clauses::add(const std::vector<int>& literals) {
  for (const int literal : literals) solver_->solver.add(literal);
  solver_->solver.add(0);
}

int Clauses::all_of(const std::vector<int>& literals) {
  if (literals.size() == 1) return literals.front();
  const int all = variable();
  std::vector<int> one_is_missing{all};
  for (const int literal : literals) {
    add({-all, literal});
    one_is_missing.push_back(-literal);
  }
  add(one_is_missing);
  return all;
}

Clauses::Answer Clauses::solve(std::optional<int> most_conflicts) {
  constexpr int satisfiable = 10, unsatisfiable = 20;
  if (solver_->terminate()) return Answer::gave_up;
  if (most_conflicts) solver_->solver.limit("conflicts", *most_conflicts);
  const int answer = solver_->solver.solve();
  if (answer == satisfiable) return Answer::satisfied;
  return answer == unsatisfiable ? Answer::contradiction : Answer::gave_up;
}

bool Clauses::is_true(int literal) const { return solver_->solver.val(literal) == literal; }

}  // namespace tessera::siphons
