#pragma once

#include <string>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"

namespace tessera::verify {

/// A communication model as a net of its own: two sides that share the fused places. For each side, one
/// transition moves the token from its `out` back to its `in`, again and again.
struct ClosedModel {
  const net::Net& net;
  net::TransitionId sends_again, receives_again;
  std::string name;
  diagnostics::Span span;  ///< where the model begins
};

/// Judges a communication model before any system uses it. Each error names a shortest run of the two sides.
///
/// Errors: E431 a place can hold two tokens; E432 one slot can be written and read at once; E433 a side can
///         come to where it never ends, or to where nothing is ever written or read again; E434 too large to
///         tell. True: no error.
/// Threads: pure.
/// Source: van der Aalst, *The application of Petri nets to workflow management*, 1998 (soundness), for two
///         nets that share places.
[[nodiscard]] bool judge_soundness(const ClosedModel& model, diagnostics::Diagnostics& out);

}  // namespace tessera::verify
