#pragma once

#include "drawing/picture.hpp"

namespace tessera::drawing {

/// The paper's symbols.
///
/// | what                     | symbol |
/// |--------------------------|---------------------------------------------------------------------------------|
/// | agent                    | a_j, j counts from 1 | | subsystem                | c_j control, r_{j,k}
/// virtual receptor, e_{j,k} virtual effector (of agent j)    | | real receptor, effector  | R_{j,k},
/// E_{j,k}: no net, they appear in no picture                             | | behaviour                | B
/// with the subsystem's letter raised before it, and the subsystem's indices and | | | the behaviour's number
/// h lowered after it: ^cB_{j,h}, ^rB_{j,k,h}               | | page snd or rcv          | ^cP^snd_{j,h} | |
/// place                    | p with the indices of the net that draws it and its local name raised: p^in_j |
/// | transition               | t with its local name lowered: t_1 | | transition function      | ^cf_{j,h} |
/// | conditions               | of the same behaviour, f with raised tau (terminal), epsilon (error), sigma |
/// |                          | (initial condition of the next behaviour) | | input, output buffer     | x or
/// y lowered before the owner's letter; raised before it the letter of the    | |                          |
/// other end, or T for a transmission between control subsystems; after it the     | | | owner's indices and
/// the other end's: ^r_xc_{1,1} is what c_1 hears from r_{1,1} | | fused places             | the buffer of
/// the producer, an arrow, the buffer of the consumer, and the part: | |                          | channel,
/// empty, full, ack                                                       |
///
/// The paper gives every element its symbol in the text of its examples; where one subsystem has several
/// buffers to the same neighbour, their names follow in parentheses. Source: Figat & Zielinski, ICRA 2019,
/// sec. III and IV.
[[nodiscard]] std::unique_ptr<Labels> paper_labels(const net::HierarchicalNet& net, const spec::Model& model);

}  // namespace tessera::drawing
