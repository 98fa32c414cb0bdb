#pragma once

#include "net/net.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// The model of a channel: the author's, or the built-in one of its modes and timeouts. Lives as long as
/// `model`.
///
/// Source of the built-in ones: non-blocking at both ends is the paper's fully asynchronous model (sec.
/// IV-E); the others are made by the paper's recipe. docs/specification.md draws them.
[[nodiscard]] const spec::CommunicationModel& model_of(const spec::Model& model,
                                                       const spec::Channel& channel);

/// The roles of what a model consists of: those of the built-in models, whose forms an author's model may
/// have too. A shared place has a role only if it starts with the tokens of that role.
[[nodiscard]] net::PlaceRole role_of(const spec::SharedPlace& place);
[[nodiscard]] net::PlaceRole role_of(const spec::ModelSide::Place& place);
[[nodiscard]] net::TransitionRole role_of(const spec::ModelSide::Transition& transition);

}  // namespace tessera::layers
