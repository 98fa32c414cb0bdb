#include <array>

#include "reduce/reduce.hpp"

namespace tessera::reduce {

std::span<const NamedRule> named_rules() {
  static constexpr std::array<NamedRule, 9> all{{
      {"dead_transitions", &Rules::dead_transitions},
      {"parallel_transitions", &Rules::parallel_transitions},
      {"identity_transitions", &Rules::identity_transitions},
      {"sink_places", &Rules::sink_places},
      {"constant_places", &Rules::constant_places},
      {"implicit_places", &Rules::implicit_places},
      {"start", &Rules::start},
      {"post_agglomeration", &Rules::post_agglomeration},
      {"pre_agglomeration", &Rules::pre_agglomeration},
  }};
  return all;
}

bool switch_off(Rules& rules, std::string_view name) {
  bool known = name == "all";
  for (const NamedRule& rule : named_rules()) {
    if (name != "all" && name != rule.name) continue;
    rules.*rule.on = false;
    known = true;
  }
  return known;
}

}  // namespace tessera::reduce
