// The times that a specification declares, as the bounds need them.
#pragma once

#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "timing/bounds.hpp"

namespace tessera::timing {

/// A chain of the specification: from a device to another one.
struct DeclaredChain {
  std::string name;  ///< "robot.camera -> robot.control -> robot.motor"
  std::vector<spec::InstanceId> path;
  std::vector<Chain> ways;  ///< the channels of the path; two subsystems may have several. Never empty
};

/// Subsystem i of `system` is instance i of the model, and channel c is channel c.
struct Declared {
  System system;
  /// Per subsystem: why nothing bounds its calls: "robot.control.drive does not say what it takes". Empty: they are
  /// bounded.
  std::vector<std::string> missing;
  /// Each receptor -> control -> effector of one agent, agent by agent.
  std::vector<DeclaredChain> chains;
};

[[nodiscard]] Declared declared(const spec::Model& model);

/// The verdict on a chain.
struct ChainVerdict {
  ChainBound bound;
  bool exact = false;  ///< some run reaches both bounds
  std::string why;     ///< there is no bound, because of this; empty: there is one
};

/// Precondition: the bounds are those of `declared.system`, and the chain is one of `declared`.
[[nodiscard]] ChainVerdict judge(const Declared& declared, const spec::Model& model, const Bounds& bounds,
                                 const DeclaredChain& chain);

}  // namespace tessera::timing
