// The times that a specification declares, as the bounds need them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "timing/bounds.hpp"

namespace tessera::timing {

/// A chain of the specification: from a device to another one.
struct DeclaredChain {
  std::string name;  ///< as the specification names it, or `leads`
  std::vector<spec::InstanceId> path;
  std::vector<Chain> ways{};              ///< the channels of the path; two subsystems may have several
  std::string leads{};                    ///< "robot.camera -> robot.control -> robot.motor"
  bool is_named = false;                  ///< the specification names it
  std::optional<Time> age{}, reaction{};  ///< what is asked
  std::string unused{};  ///< why there is no way: "robot.control does not send over ..."; empty: there is one
};

/// Subsystem i of `system` is instance i of the model, and channel c is channel c.
struct Declared {
  System system;
  /// Per subsystem: why nothing bounds its calls: "robot.control.drive does not say what it takes". Empty: they are
  /// bounded.
  std::vector<std::string> missing;
  std::vector<std::vector<std::string>> all_missing;  ///< per subsystem: all that `missing` could say
  std::vector<bool> differ;  ///< per subsystem: its behaviours do not all have the same times
  std::vector<bool>
      takes_turns;          ///< per subsystem: with those of equal priority on its processor (`round_robin`)
  std::vector<Time> stale;  ///< per subsystem: an older input makes it give the safe command; 0: none does
  /// Those that the specification names; else each receptor -> control -> effector of one agent, agent by agent.
  std::vector<DeclaredChain> chains;
};

/// Whether the specification says what calls take, or names chains.
[[nodiscard]] bool says_times(const spec::Model& model);
[[nodiscard]] Declared declared(const spec::Model& model);

/// The answer to what is asked of an age or reaction.
enum class Answer : std::uint8_t {
  not_asked,
  holds,
  violated,  ///< some run takes longer
  unknown,   ///< what is proved is longer than what is asked
  none       ///< there is no bound
};

/// The verdict on a chain.
struct ChainVerdict {
  ChainBound bound;
  bool exact = false;  ///< some run reaches both bounds
  std::string why;     ///< there is no bound, because of this; empty: there is one
  Answer age = Answer::not_asked, reaction = Answer::not_asked;
};

/// Precondition: the bounds are those of `declared.system`, and the chain is one of `declared`.
[[nodiscard]] ChainVerdict judge(const Declared& declared, const spec::Model& model, const Bounds& bounds,
                                 const DeclaredChain& chain);

/// All that the specification must say before the chain can have a bound: "robot.sensor.look does not say what it
/// takes".
[[nodiscard]] std::vector<std::string> missing_for(const Declared& declared, const DeclaredChain& chain);

/// Notes at chains of which something is asked, and that have no bound as long as something is missing.
///
/// Notes: N341.
void note_missing(const spec::Model& model, diagnostics::Diagnostics& out);

}  // namespace tessera::timing
