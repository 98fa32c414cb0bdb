#include "verify/meaning.hpp"

namespace tessera::verify {

std::string meaning_of(Verdict verdict, Sort sort) {
  if (verdict == Verdict::unknown) return {};
  if (verdict == Verdict::violated)
    return sort == Sort::existential
               ? "this is so with conditions too"
               : "conditions may exclude the run: it is one only if they allow each of its choices";
  switch (sort) {
    case Sort::universal:
      return "this is so with conditions too";
    case Sort::completeness:
      return "this is so with conditions too, as long as one holds wherever a choice is due";
    case Sort::always_can:
      return "this is so with conditions too, if every branch that is offered is taken eventually";
    case Sort::follows:
      return "with conditions too the second follows every time, if every branch that is offered is taken "
             "eventually";
    case Sort::existential:
      return "conditions may still exclude what the net allows";
  }
  return {};
}

}  // namespace tessera::verify
