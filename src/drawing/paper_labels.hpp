#pragma once

#include "drawing/picture.hpp"

namespace tessera::drawing {

/// The paper's symbols.
///
///     element                  symbol
///     agent                    a_j, j counts from 1
///     subsystem                of agent j: c_j control, r_{j,k} virtual receptor, e_{j,k} virtual effector
///     real receptor, effector  R_{j,k}, E_{j,k}; they have no net and appear in no picture
///     behaviour                B, before it the subsystem's letter raised, after it the subsystem's
///                              indices and the behaviour's number h lowered: ^cB_{j,h}, ^rB_{j,k,h}
///     page snd or rcv          ^cP^snd_{j,h}
///     place                    p with the indices of the net that has it and its local name raised: p^in_j
///     transition               t with its local name lowered: t_1
///     transition function      ^cf_{j,h}
///     conditions               of the same behaviour: f with raised tau (terminal), epsilon (error), sigma
///                              (initial condition of the next behaviour)
///     input, output buffer     before the owner's letter x or y lowered, and raised the letter of the other
///                              end, or T for a transmission between control subsystems; after it the
///                              indices of the owner and of the other end: ^r_xc_{1,1} comes from r_{1,1}
///     fused places             the buffer of the producer, an arrow, the buffer of the consumer, and the
///                              part: channel, empty, full, ack
///
/// The paper introduces the symbols in the text of its examples. If one subsystem has several buffers to the
/// same neighbour, the names of the buffers follow in parentheses.
///
/// Source: Figat & Zielinski, ICRA 2019, sec. III and IV.
[[nodiscard]] std::unique_ptr<Labels> paper_labels(const net::HierarchicalNet& net, const spec::Model& model);

}  // namespace tessera::drawing
