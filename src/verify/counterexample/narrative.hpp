#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// A stretch of a run in which one subsystem acts on its own.
struct Act {
  std::size_t first = 0, last = 0;  ///< numbers of firings of the run, counted from 1
  std::string who;                  ///< "robot.control"; "" for the layers above
  /// The actions of the subsystem in the words of the specification, with the local names of transitions: "in
  /// follow: computes (t1), sends motion (t1, t2), waits for the acknowledgement".
  std::string text;
  std::uint32_t line = 0;  ///< of the specification, where the stretch begins; 0: none
  std::string included{};  ///< "parts/docking.yaml:3": it is a line of an included file, and `line` is 0
};

/// The words are for people who follow the drawn net, or for those who know the specification only.
enum class Wording : std::uint8_t {
  with_transitions,  ///< "receives grant (t1, t2), goes on to enter"
  plain              ///< "receives grant, goes on to enter because in.grant.fresh"
};

/// Describes in words a run of a net made of the five layers, or of its abstract net
/// (verify/communication/abstraction.hpp).
///
/// Threads: pure. Linear in the net and the run.
[[nodiscard]] std::vector<Act> narrate(const net::Net& net, const std::vector<net::TransitionId>& run,
                                       Wording wording = Wording::with_transitions);

}  // namespace tessera::verify
