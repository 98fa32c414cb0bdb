#pragma once

#include <string_view>

/// The words that the layers write into the names of places and transitions. src/layers draws the net with
/// them, and the runtime builds the layers above the subsystems with them. All other code asks an element for
/// its role (net::PlaceRole, net::TransitionRole, tessera::Step).
///
/// They are not constexpr, so that a test can link others in their place (tests/words).
///
/// Source: Figat & Zielinski, ICRA 2019, sec. IV.
namespace tessera::words {

// Words of every page.
extern const std::string_view input;
extern const std::string_view output;
extern const std::string_view start;
extern const std::string_view end;
/// "t_follow_1": behaviour `follow` is left by its first entry of `next`.
extern const std::string_view leave;

// Words of a behaviour.
extern const std::string_view send_page;
extern const std::string_view receive_page;
extern const std::string_view step;         ///< the place between sending and receiving
extern const std::string_view first_step;   ///< transitions between its places and pages, along the way
extern const std::string_view second_step;  ///< of the token
extern const std::string_view third_step;
extern const std::string_view go_on;
extern const std::string_view terminal;
extern const std::string_view error;

// Words of a block of a communication page.
extern const std::string_view transfer;
extern const std::string_view waiting;
extern const std::string_view begin_transfer;
extern const std::string_view overwrite;
extern const std::string_view end_transfer;
extern const std::string_view take_acknowledgement;
extern const std::string_view timeout;
extern const std::string_view skip;
extern const std::string_view fork;
extern const std::string_view join;
extern const std::string_view pass;  ///< of a page without blocks

// Words of the memory of a channel.
extern const std::string_view lock;
extern const std::string_view empty;
extern const std::string_view full;
extern const std::string_view acknowledged;

// Words of the memory of a channel between processes, and of the transitions that move its values.
extern const std::string_view idle;             ///< nothing is on the way
extern const std::string_view sent;             ///< the newest value is on the way
extern const std::string_view more;             ///< the newest value and older ones are
extern const std::string_view sent_memory;      ///< both sides are non-blocking:
extern const std::string_view received_memory;  ///< each side has a lock of its own
extern const std::string_view end_transfer_second;
extern const std::string_view end_transfer_more;
extern const std::string_view withdraw;  ///< the time is up: the value never arrives
extern const std::string_view withdraw_newest;
extern const std::string_view recall;  ///< the time is up: the value is taken back unread
extern const std::string_view deliver;
extern const std::string_view replace;  ///< the newest value overwrites one that was not read
extern const std::string_view deliver_older;
extern const std::string_view lose_older;

/// Follows the name of a behaviour's output, if none of its initial conditions holds: a transition of the net
/// that is judged (verify/communication/abstraction.hpp), and of scenarios.
extern const std::string_view no_successor;

/// Follows the name of a channel between processes: elements that are added to the judged net if links may
/// fail.
extern const std::string_view link;
extern const std::string_view link_back;  ///< for acknowledgements
extern const std::string_view cut;
extern const std::string_view cut_back;

}  // namespace tessera::words
