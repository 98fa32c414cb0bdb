#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tessera::verify {

/// The state of one subsystem at the end of a run that shows a violation, as far as it concerns the
/// violation.
struct SubsystemAtEnd {
  enum class State : std::uint8_t {
    waits,         ///< for what `awaited` says, at `channel`, from one of `from`
    no_successor,  ///< it left a behaviour, and none of its initial conditions held
    ended,
    gives_no_more,  ///< it goes on, and never again gives what `awaited` says at `channel`
    takes_no_more   ///< it goes on, and receives from `channel` no more
  } state = State::waits;
  enum class Awaited : std::uint8_t { nothing, value, acknowledgement, memory } awaited = Awaited::nothing;
  std::string path;                    ///< "robot.control"
  std::string behaviour = {};          ///< no_successor: the one that was left, by its name
  std::string channel = {};            ///< "robot.control.motion->robot.motor.velocity"; empty: none
  std::vector<std::string> from = {};  ///< waits: paths of the subsystems that could give it
  std::string text = {};               ///< all of it in words
  bool operator==(const SubsystemAtEnd&) const = default;
};

/// "waits", "no_successor", ...
[[nodiscard]] const char* name_of(SubsystemAtEnd::State state);
/// "nothing", "value", ...
[[nodiscard]] const char* name_of(SubsystemAtEnd::Awaited awaited);

}  // namespace tessera::verify
