#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// The roles of places and transitions in the five layers. Programs ask an element of a net, of the tables of
/// a controller, or of a recording for its role; its name is for people.
///
/// Source: Figat & Zielinski, ICRA 2019, sec. IV. "t1" and the like are the names of the paper.
namespace tessera {

enum class PlaceRole : std::uint8_t {
  none,          ///< no role, or a net that was not made from a specification
  input,         ///< of its page
  output,        ///< of its page
  waiting,       ///< of a block: until the value is acknowledged
  no_successor,  ///< a behaviour was left and no initial condition held: see verify::abstract_net
  fact,          ///< a value of something that the net of the subsystem knows: net::Parts::Fact
  // The memory of a channel, of the form that the built-in models have:
  lock,          ///< both sides are non-blocking: neither uses the memory now
  empty,         ///< no value
  full,          ///< a value that has not been read
  acknowledged,  ///< a value was read, and the sender does not know it yet
  // The memory of a channel between processes, besides `empty` and `full` of the receiver:
  idle,             ///< no value is on the way
  sent,             ///< the newest value is on the way, alone
  more,             ///< the newest value and older ones are on the way
  sent_memory,      ///< both sides are non-blocking: the sender does not use its memory now
  received_memory,  ///< the same of the receiver
  link,             ///< it still works: see verify::abstract_net
  link_back         ///< the same of the link that carries acknowledgements
};

/// "sent_memory": the name of the enumerator, as in generated tables.
[[nodiscard]] constexpr std::string_view name_of(PlaceRole role) {
  constexpr std::array<std::string_view, 17> names{
      "none", "input",    "output", "waiting",     "no_successor",
      "fact", "lock",     "empty",  "full",        "acknowledged",
      "idle", "sent",     "more",   "sent_memory", "received_memory",
      "link", "link_back"};
  static_assert(names.size() == static_cast<std::size_t>(PlaceRole::link_back) + 1);
  return names[static_cast<std::size_t>(role)];
}

/// Has only a channel between processes a place of this role?
[[nodiscard]] constexpr bool is_networked(PlaceRole role) {
  return role >= PlaceRole::idle && role <= PlaceRole::received_memory;
}

/// The step of a run that a transition is.
enum class Step : std::uint8_t {
  other,  ///< not known, or a net that was not made from a specification
  // Layers 1 and 2, the system and its agents.
  start_system,
  end_system,
  start_agent,
  end_agent,
  // Layer 3, a subsystem.
  start,        ///< it starts its first behaviour
  leave,        ///< an entry of `next` of the behaviour is taken
  begin_group,  ///< the first behaviour of a group begins
  leave_group,  ///< an entry of `next` of the group is taken
  // Layer 4, a behaviour.
  begin_sending,    ///< t1: the transition function has been calculated; with `receive: first` t3
  end_sending,      ///< t2; with `receive: first` one of t4, t5 and t6 ends the sending
  begin_receiving,  ///< t3; with `receive: first` t1
  end_receiving,    ///< t2 with `receive: first`: the transition function is about to run
  go_on,            ///< t4: the iteration ends, and the behaviour goes on
  terminal,         ///< t5
  error,            ///< t6: by a condition or a failure
  // Layer 5, communication.
  page,       ///< on a page, but in none of its blocks
  transfer,   ///< in a block, and none of the following
  overwrite,  ///< a new value replaces one that was not read
  skip,       ///< there is nothing to read; or, of a sender, nothing is sent
  timeout,    ///< the wait has ended without success
  // The medium of a channel between processes. These transitions belong to no subsystem.
  deliver,        ///< the newest value arrives
  replace,        ///< it arrives and overwrites one that has not been read
  deliver_older,  ///< an older value arrives
  lose_older,     ///< the older values never arrive
  // Only of the net that is judged: see verify::abstract_net.
  no_successor,  ///< a behaviour is left and no initial condition holds
  cut,           ///< the link fails for ever
  cut_back       ///< the same of the link that carries acknowledgements
};

namespace detail {
inline constexpr std::array<std::string_view, 28> step_names{
    "other",         "start_system", "end_system",  "start_agent",   "end_agent",   "start",
    "leave",         "begin_group",  "leave_group", "begin_sending", "end_sending", "begin_receiving",
    "end_receiving", "go_on",        "terminal",    "error",         "page",        "transfer",
    "overwrite",     "skip",         "timeout",     "deliver",       "replace",     "deliver_older",
    "lose_older",    "no_successor", "cut",         "cut_back"};
static_assert(step_names.size() == static_cast<std::size_t>(Step::cut_back) + 1);
}  // namespace detail

/// "begin_sending": the name of the enumerator, as in recordings, drawings and generated tables.
[[nodiscard]] constexpr std::string_view name_of(Step step) {
  return detail::step_names[static_cast<std::size_t>(step)];
}
/// The inverse; `other` if no step of this version has the name.
[[nodiscard]] constexpr Step step_named(std::string_view name) {
  for (std::size_t step = 0; step < detail::step_names.size(); ++step)
    if (detail::step_names[step] == name) return static_cast<Step>(step);
  return Step::other;
}

/// Whether it moves the values of a channel between processes, or ends its link.
[[nodiscard]] constexpr bool is_of_medium(Step step) {
  return step >= Step::deliver && step != Step::no_successor;
}
/// Whether it starts the system, an agent or a subsystem.
[[nodiscard]] constexpr bool is_start(Step step) {
  return step == Step::start_system || step == Step::start_agent || step == Step::start;
}
/// Whether it ends an iteration of a behaviour.
[[nodiscard]] constexpr bool ends_iteration(Step step) {
  return step == Step::go_on || step == Step::terminal || step == Step::error;
}

}  // namespace tessera
