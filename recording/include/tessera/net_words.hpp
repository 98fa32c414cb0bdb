#pragma once

#include <string_view>

/// The words that the layers write into the names of places and transitions, in one place: src/layers draws
/// with them, the runtime makes the layers above the subsystems again with them, and
/// tessera/named_transition.hpp reads them in recordings. Everybody else asks an element for its role
/// (net::PlaceRole, net::TransitionRole).
///
/// Source: Figat & Zielinski, ICRA 2019, sec. IV.
namespace tessera::words {

// Every page.
inline constexpr std::string_view input = "in";
inline constexpr std::string_view output = "out";
inline constexpr std::string_view start = "t_in";
inline constexpr std::string_view end = "t_out";
/// "t_follow_1": behaviour `follow` is left by its first entry of `next`.
inline constexpr std::string_view leave = "t_";

// A behaviour.
inline constexpr std::string_view send_page = "snd";
inline constexpr std::string_view receive_page = "rcv";
inline constexpr std::string_view step = "2";
inline constexpr std::string_view begin_sending = "t1";  ///< the transition function has been calculated
inline constexpr std::string_view end_sending = "t2";
inline constexpr std::string_view begin_receiving = "t3";
inline constexpr std::string_view go_on = "t4";
inline constexpr std::string_view terminal = "t5";
inline constexpr std::string_view error = "t6";

// A block of a communication page.
inline constexpr std::string_view transfer = "2";
inline constexpr std::string_view waiting = "wait";
inline constexpr std::string_view begin_transfer = "t1";
inline constexpr std::string_view overwrite = "t1o";
inline constexpr std::string_view end_transfer = "t2";
inline constexpr std::string_view take_acknowledgement = "t3";
inline constexpr std::string_view timeout = "timeout";
inline constexpr std::string_view skip = "skip";
inline constexpr std::string_view fork = "fork";
inline constexpr std::string_view join = "join";
inline constexpr std::string_view pass = "t1";  ///< of a page without blocks

// The memory of a channel.
inline constexpr std::string_view lock = "channel";
inline constexpr std::string_view empty = "empty";
inline constexpr std::string_view full = "full";
inline constexpr std::string_view acknowledged = "ack";

// The memory of a channel between processes, and what moves values from one side to the other.
inline constexpr std::string_view idle = "idle";                ///< nothing is on the way
inline constexpr std::string_view sent = "sent";                ///< the newest value is on the way
inline constexpr std::string_view more = "more";                ///< the newest value and older ones are
inline constexpr std::string_view sent_memory = "sent_memory";  ///< both sides are non-blocking:
inline constexpr std::string_view received_memory = "received_memory";  ///< each side has a lock of its own
inline constexpr std::string_view end_transfer_second = "t2n";
inline constexpr std::string_view end_transfer_more = "t2m";
inline constexpr std::string_view withdraw = "withdraw";  ///< the time is up: the value never arrives
inline constexpr std::string_view withdraw_newest = "withdraw_m";
inline constexpr std::string_view recall = "recall";  ///< the time is up: the value is taken back unread
inline constexpr std::string_view deliver = "deliver";
inline constexpr std::string_view replace = "replace";  ///< the newest value overwrites one that was not read
inline constexpr std::string_view deliver_older = "older";
inline constexpr std::string_view lose_older = "lost";

/// After the name of a behaviour's output: none of its initial conditions holds. A transition of the net that
/// is judged (verify/communication/abstraction.hpp), and of scenarios.
inline constexpr std::string_view no_successor = " none";

/// After the name of a channel between processes: what is added to the net that is judged if links may fail.
inline constexpr std::string_view link = ".link";
inline constexpr std::string_view link_back = ".link_back";  ///< for acknowledgements
inline constexpr std::string_view cut = ".cut";
inline constexpr std::string_view cut_back = ".cut_back";

}  // namespace tessera::words
