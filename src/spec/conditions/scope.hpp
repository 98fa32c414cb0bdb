#pragma once

#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// The names that the conditions of one subsystem may use.
struct ConditionScope {
  SubsystemKind kind;
  const std::vector<Field>& inputs;
  const std::vector<Field>& outputs;
  const std::vector<Field>& real;
  const std::vector<Field>& memory;
  const std::vector<Parameter>& parameters;
  const std::vector<Parameter>& system_parameters;
  const Types& types;
  const Member* member = nullptr;  ///< for which the condition is, so that it may name `i`; null: for none
};

}  // namespace tessera::spec
