#pragma once

#include <cstdint>
#include <string_view>

namespace tessera {

/// What a transition of a subsystem is, as far as its name tells. Recordings know transitions by name only.
/// Code that has the net reads the role of net::Transition instead.
struct NamedTransition {
  enum class Kind : std::uint8_t {
    other,
    start,            ///< the subsystem starts its first behaviour
    leave,            ///< an entry of `next` of `behaviour` is taken
    begin_iteration,  ///< t1: the transition function of `behaviour` has been calculated
    go_on,            ///< t4: the iteration ends, and the behaviour goes on
    terminal,         ///< t5
    error,            ///< t6
    communication     ///< of a block of the communication of `behaviour`
  } kind = Kind::other;
  std::string_view behaviour{};  ///< empty: of none
  bool timeout = false;          ///< communication: it was waited for in vain
  bool skip = false;             ///< communication: there was nothing to read
  bool overwrite = false;        ///< communication: what was sent takes the place of what nobody has read

  /// Ends an iteration of a behaviour.
  [[nodiscard]] bool ends_iteration() const {
    return kind == Kind::go_on || kind == Kind::terminal || kind == Kind::error;
  }
};

/// name: "robot.control.follow.t1", of the subsystem "robot.control"; a name without that path is taken as
/// local. The views last as long as `name`.
[[nodiscard]] NamedTransition named_transition(std::string_view name, std::string_view subsystem);

/// The name without the path of its subsystem: "follow.t1"; as it is if it has another path.
[[nodiscard]] std::string_view local_name(std::string_view name, std::string_view subsystem);

}  // namespace tessera
