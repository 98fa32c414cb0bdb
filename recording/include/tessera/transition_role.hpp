#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tessera {

/// The function of a transition in the five layers. The tables of a controller and its recordings contain it.
///
/// Source: Figat & Zielinski, ICRA 2019, sec. IV. "t1" and the like are the names of the paper.
enum class Step : std::uint8_t {
  other,  ///< not known
  // Layers 1 and 2, the system and its agents.
  start_system,
  end_system,
  start_agent,
  end_agent,
  // Layer 3, a subsystem.
  start,  ///< it starts its first behaviour
  leave,  ///< an entry of `next` of the behaviour is taken
  // Layer 4, a behaviour.
  begin_sending,    ///< t1: the transition function has been calculated; with `receive: first` t3
  end_sending,      ///< t2
  begin_receiving,  ///< t3; with `receive: first` t1
  end_receiving,    ///< t2 with `receive: first`: the transition function is about to run
  go_on,            ///< t4: the iteration ends, and the behaviour goes on
  terminal,         ///< t5
  error,            ///< t6
  // Layer 5, communication.
  page,       ///< on a page, but in none of its blocks
  transfer,   ///< in a block, and none of the following
  overwrite,  ///< a new value replaces one that was not read
  skip,       ///< there is nothing to read
  timeout,    ///< the wait has ended without success
  // The medium of a channel between processes. These transitions belong to no subsystem.
  deliver,
  replace,
  deliver_older,
  lose_older
};

/// "begin_sending": the name of the enumerator, as in recordings and generated tables.
[[nodiscard]] std::string_view name_of(Step step);
/// The inverse; `other` if no step of this version has the name.
[[nodiscard]] Step step_named(std::string_view name);

/// The role of a transition of a run.
struct TransitionRole {
  Step step = Step::other;
  std::string behaviour{};                 ///< the behaviour that it belongs to, or leaves; empty: none
  std::optional<std::uint32_t> channel{};  ///< of a block or a medium: into Recording::channels

  /// Whether it ends an iteration of a behaviour.
  [[nodiscard]] bool ends_iteration() const {
    return step == Step::go_on || step == Step::terminal || step == Step::error;
  }
  /// Whether it belongs to the communication of a behaviour.
  [[nodiscard]] bool communicates() const { return step >= Step::page && step <= Step::timeout; }
};

}  // namespace tessera
