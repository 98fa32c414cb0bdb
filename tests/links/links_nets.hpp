#pragma once

#include "named_net.hpp"

/// Nets of single subsystems at channels between processes, as src/layers/networked.cpp draws them, each with
/// one behaviour "run" and one port "x".
namespace tessera::testing::nets {

extern const SubsystemNet far_nb_sender, far_b_sender, far_b_sender_timed;
extern const SubsystemNet far_b_receiver, far_nb_receiver, far_b_receiver_timed;
extern const SubsystemNet far_exchange_sender, far_exchange_receiver;

}  // namespace tessera::testing::nets
