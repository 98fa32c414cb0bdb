#pragma once

#include <string_view>

/// A prefix of every word. Only a test sets one (tests/words).
#ifndef TESSERA_WORD_PREFIX
#define TESSERA_WORD_PREFIX ""
#endif

/// The words that the layers write into the names of places and transitions. All other code asks an element
/// for its role (tessera/net_roles.hpp).
///
/// Source: Figat & Zielinski, ICRA 2019, sec. IV.
namespace tessera::words {

// Words of every page.
inline constexpr std::string_view input = TESSERA_WORD_PREFIX "in";
inline constexpr std::string_view output = TESSERA_WORD_PREFIX "out";
inline constexpr std::string_view start = TESSERA_WORD_PREFIX "t_in";
inline constexpr std::string_view end = TESSERA_WORD_PREFIX "t_out";
/// "t_follow_1": behaviour `follow` is left by its first entry of `next`.
inline constexpr std::string_view leave = TESSERA_WORD_PREFIX "t_";

// Words of a behaviour.
inline constexpr std::string_view send_page = TESSERA_WORD_PREFIX "snd";
inline constexpr std::string_view receive_page = TESSERA_WORD_PREFIX "rcv";
/// The place between sending and receiving.
inline constexpr std::string_view step = TESSERA_WORD_PREFIX "2";
// Transitions between its places and pages, along the way of the token.
inline constexpr std::string_view first_step = TESSERA_WORD_PREFIX "t1";
inline constexpr std::string_view second_step = TESSERA_WORD_PREFIX "t2";
inline constexpr std::string_view third_step = TESSERA_WORD_PREFIX "t3";
inline constexpr std::string_view go_on = TESSERA_WORD_PREFIX "t4";
inline constexpr std::string_view terminal = TESSERA_WORD_PREFIX "t5";
inline constexpr std::string_view error = TESSERA_WORD_PREFIX "t6";

// Words of a block of a communication page.
inline constexpr std::string_view transfer = TESSERA_WORD_PREFIX "2";
inline constexpr std::string_view waiting = TESSERA_WORD_PREFIX "wait";
inline constexpr std::string_view begin_transfer = TESSERA_WORD_PREFIX "t1";
inline constexpr std::string_view overwrite = TESSERA_WORD_PREFIX "t1o";
inline constexpr std::string_view end_transfer = TESSERA_WORD_PREFIX "t2";
inline constexpr std::string_view take_acknowledgement = TESSERA_WORD_PREFIX "t3";
inline constexpr std::string_view timeout = TESSERA_WORD_PREFIX "timeout";
inline constexpr std::string_view skip = TESSERA_WORD_PREFIX "skip";
inline constexpr std::string_view fork = TESSERA_WORD_PREFIX "fork";
inline constexpr std::string_view join = TESSERA_WORD_PREFIX "join";
inline constexpr std::string_view pass = TESSERA_WORD_PREFIX "t1";  ///< of a page without blocks

// Words of the memory of a channel.
inline constexpr std::string_view lock = TESSERA_WORD_PREFIX "channel";
inline constexpr std::string_view empty = TESSERA_WORD_PREFIX "empty";
inline constexpr std::string_view full = TESSERA_WORD_PREFIX "full";
inline constexpr std::string_view acknowledged = TESSERA_WORD_PREFIX "ack";

// Words of the memory of a channel between processes, and of the transitions that move its values.
inline constexpr std::string_view idle = TESSERA_WORD_PREFIX "idle";  ///< nothing is on the way
inline constexpr std::string_view sent = TESSERA_WORD_PREFIX "sent";  ///< the newest value is on the way
inline constexpr std::string_view more = TESSERA_WORD_PREFIX "more";  ///< the newest value and older ones are
// Each side has a lock of its own, if both are non-blocking.
inline constexpr std::string_view sent_memory = TESSERA_WORD_PREFIX "sent_memory";
inline constexpr std::string_view received_memory = TESSERA_WORD_PREFIX "received_memory";
inline constexpr std::string_view end_transfer_second = TESSERA_WORD_PREFIX "t2n";
inline constexpr std::string_view end_transfer_more = TESSERA_WORD_PREFIX "t2m";
inline constexpr std::string_view withdraw =
    TESSERA_WORD_PREFIX "withdraw";  ///< the time is up: the value never arrives
inline constexpr std::string_view withdraw_newest = TESSERA_WORD_PREFIX "withdraw_m";
inline constexpr std::string_view recall =
    TESSERA_WORD_PREFIX "recall";  ///< the time is up: the value is taken back unread
inline constexpr std::string_view deliver = TESSERA_WORD_PREFIX "deliver";
inline constexpr std::string_view replace =
    TESSERA_WORD_PREFIX "replace";  ///< the newest value overwrites one that was not read
inline constexpr std::string_view deliver_older = TESSERA_WORD_PREFIX "older";
inline constexpr std::string_view lose_older = TESSERA_WORD_PREFIX "lost";

// Words of the places of what a subsystem knows; they follow the name of its buffer.
inline constexpr std::string_view came = TESSERA_WORD_PREFIX "came";        ///< the last receive took a value
inline constexpr std::string_view missed = TESSERA_WORD_PREFIX "missed";    ///< it did not, or there was none
inline constexpr std::string_view in_time = TESSERA_WORD_PREFIX "in_time";  ///< acknowledged, or nothing sent
inline constexpr std::string_view timed_out = TESSERA_WORD_PREFIX "timed_out";

/// Follows the name of a behaviour's output, if none of its initial conditions holds: a transition of the net
/// that is judged (verify/communication/abstraction.hpp), and of scenarios.
inline constexpr std::string_view no_successor = TESSERA_WORD_PREFIX " none";

/// Follows the name of a channel between processes: elements that are added to the judged net if links may
/// fail.
inline constexpr std::string_view link = TESSERA_WORD_PREFIX ".link";
inline constexpr std::string_view link_back = TESSERA_WORD_PREFIX ".link_back";  ///< for acknowledgements
inline constexpr std::string_view cut = TESSERA_WORD_PREFIX ".cut";
inline constexpr std::string_view cut_back = TESSERA_WORD_PREFIX ".cut_back";

}  // namespace tessera::words

#undef TESSERA_WORD_PREFIX
