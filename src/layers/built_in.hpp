#pragma once

#include "net/net.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// The communication model of a channel: the one that the specification names, or the built-in one for its
/// modes and timeouts, within a process or between two. Valid as long as `model`.
///
/// Source: paper, sec. IV-E. Non-blocking at both ends is its fully asynchronous model; the other built-in
/// models are made in the same way. docs/reference/specification.md draws them.
[[nodiscard]] const spec::CommunicationModel& model_of(const spec::Model& model,
                                                       const spec::Channel& channel);

/// The role of an element of a communication model. Roles are those of the built-in models; a model of the
/// author may have the same form. A shared place has a role only if it starts with the tokens of that role.
[[nodiscard]] PlaceRole role_of(const spec::SharedPlace& place);
[[nodiscard]] PlaceRole role_of(const spec::ModelSide::Place& place);
[[nodiscard]] Step role_of(const spec::ModelSide::Transition& transition);
[[nodiscard]] Step role_of(const spec::MediumTransition& transition);

}  // namespace tessera::layers
