#pragma once

#include <string>

#include "net/property.hpp"
#include "verify/deciders/facts.hpp"

namespace tessera::verify {

/// A claim that behaviours of one subsystem run, or lead to each other, decided by which behaviour may follow
/// which, provided that the subsystem always goes on.
struct RunningVerdict {
  Answer answer = Answer::unknown;
  std::string why;  ///< of no
};
[[nodiscard]] RunningVerdict judge_running(const NetUnderAssumption& given, const net::HierarchicalNet& pages,
                                           net::Property::Kind kind, const net::Claim& claim);

}  // namespace tessera::verify
