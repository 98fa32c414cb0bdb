#pragma once

#include "named_net.hpp"

/// Nets of single subsystems for the tests, each with one behaviour "run" unless said otherwise.
namespace tessera::testing::nets {

extern const SubsystemNet alone;           ///< no channel
extern const SubsystemNet two_behaviours;  ///< first -> (0) second, (1) end; second -> (0) first
extern const SubsystemNet async_sender, async_receiver;  ///< NB -> NB over port "x"
extern const SubsystemNet nb_sender;                     ///< NB over a buffered port "x"
extern const SubsystemNet b_sender, b_sender_timed;
extern const SubsystemNet b_sender_skipping;  ///< as b_sender_timed; it may skip the send
extern const SubsystemNet
    nb_sender_persistent;  ///< after an error or a terminal condition it goes on with "run"
extern const SubsystemNet b_receiver, b_receiver_timed, nb_receiver;  ///< from a non-blocking sender
extern const SubsystemNet once_receiver;  ///< from a non-blocking one: waits for the first value only, timed
extern const SubsystemNet b_receiver_ack, b_receiver_ack_timed, nb_receiver_ack;  ///< from a blocking one
extern const SubsystemNet parallel_sender;  ///< blocking, "x" and "y" at once
extern const SubsystemNet async_relay;      ///< receives and sends "x", NB -> NB
/// The line follower of the paper: sensor -> (asynchronous "line") -> control -> ("motion", received blocking
/// with a timeout as "velocity") -> motor. control has the behaviours init and follow.
extern const SubsystemNet paper_sensor, paper_control, paper_motor;
/// A store of two items under a lock, drawn by hand: fused places of `two_slots`.
extern const SubsystemNet store_sender, store_receiver;
extern const std::span<const FusedPlace> two_slots;
/// A queue of two slots, as in the third example: fused places of `queue`.
extern const SubsystemNet queue_sender, queue_receiver;
extern const std::span<const FusedPlace> queue;
/// Subsystems that receive first: a receiver of each mode, a relay that goes on after every end, and two
/// behaviours, each of which leads to the other and receives nothing.
extern const SubsystemNet first_async_receiver, first_b_receiver, first_b_receiver_timed, first_relay,
    first_two_behaviours;
/// One slot; the receiver gives up by a transition that touches no fused place.
extern const SubsystemNet impatient_receiver;

}  // namespace tessera::testing::nets
