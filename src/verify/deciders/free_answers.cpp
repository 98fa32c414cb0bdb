#include "verify/deciders/free_answers.hpp"

#include "verify/communication/free_net.hpp"

namespace tessera::verify {

bool carries_over(const Question& question, Facts& free, const net::Net& net) {
  using Kind = Question::Kind;
  switch (question.kind) {
    case Kind::safe:
    case Kind::exclusive_channels:
      return true;
    case Kind::deadlock_free:
    case Kind::sound_pages:
      return !facts_decide_sends(net);
    case Kind::goes_on:
    case Kind::channels_flow: {
      const NetUnderAssumption& given = free.under(question.assume);
      return given.communication.structure && choices_change_nothing(*given.communication.structure, net);
    }
    case Kind::live_behaviours:
      return false;
    case Kind::claims:
      return question.property->kind == net::Property::Kind::never ||
             question.property->kind == net::Property::Kind::always;
  }
  return false;
}

}  // namespace tessera::verify
