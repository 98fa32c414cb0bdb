#include "verify/deciders/decider.hpp"

namespace tessera::verify {

const std::vector<std::unique_ptr<Decider>>& portfolio() {
  static const std::vector<std::unique_ptr<Decider>> all = [] {
    std::vector<std::unique_ptr<Decider>> deciders;
    deciders.push_back(by_invariants());
    deciders.push_back(by_circuits());
    deciders.push_back(by_waiting());
    deciders.push_back(by_siphons());
    deciders.push_back(by_parts());
    deciders.push_back(by_exploration());
    return deciders;
  }();
  return all;
}

}  // namespace tessera::verify
