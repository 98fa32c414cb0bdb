#pragma once

#include <string>

#include "net/property.hpp"
#include "verify/deciders/facts.hpp"

namespace tessera::verify {

/// The verdict on a claim that behaviours of one subsystem run, or lead to each other. It is decided by which
/// behaviour may follow which, and needs a subsystem that always goes on.
struct RunningVerdict {
  Answer answer = Answer::unknown;
  std::string why;  ///< for the answer no
};
[[nodiscard]] RunningVerdict judge_running(const NetUnderAssumption& given, const net::HierarchicalNet& pages,
                                           net::Property::Kind kind, const net::Claim& claim);

}  // namespace tessera::verify
