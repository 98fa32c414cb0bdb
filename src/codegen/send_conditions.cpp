// The function that says what an iteration sends.

#include <fmt/format.h>

#include <string>

#include "codegen/conditions.hpp"

namespace tessera::codegen {

std::string Conditions::sends() const {
  std::string cases;
  for (const spec::BehaviourId behaviour : asked_.ids()) {
    const spec::Behaviour& what = subsystem_.behaviours[behaviour];
    // The functions of the first member are those of all.
    const spec::BehaviourId first{behaviour.value - (what.member ? what.member->number : 0)};
    for (std::size_t at = 0; at < what.skippable.size(); ++at) {
      const spec::Skippable& output = what.skippable[at];
      std::string answer = "tessera::Sending::by_function";
      if (!output.by_function) {
        std::string asked;
        for (const std::size_t function : asked_[first].send[at])
          asked += fmt::format("{}conditions_.{}()", asked.empty() ? "" : " || ", functions_[function].name);
        answer = fmt::format("{} ? tessera::Sending::sends : tessera::Sending::skips", asked);
      }
      cases += fmt::format("    if (behaviour == {} && output == {})  // {}, {}\n      return {};\n",
                           behaviour.value, output.output.value, what.name,
                           subsystem_.outputs[output.output].name, answer);
    }
  }
  if (cases.empty()) return {};
  if (behaviour_text(subsystem_).starts_with("behaviour_of"))  // then conditions ask for the member
    cases = "    static_cast<void>(behaviour_of(behaviour));\n" + cases;
  return fmt::format(R"(
  tessera::Sending sends(std::uint16_t behaviour, std::uint32_t output) override {{
{}    return tessera::Sending::sends;
  }}
)",
                     cases);
}

}  // namespace tessera::codegen
