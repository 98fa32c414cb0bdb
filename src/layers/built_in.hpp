#pragma once

#include "spec/model/model.hpp"

namespace tessera::layers {

/// The communication model of a channel: the one that the specification names, or the built-in one for its
/// modes and timeouts. Valid as long as `model`.
///
/// Source: paper, sec. IV-E. Non-blocking at both ends is its fully asynchronous model; the other built-in
/// models are made in the same way. docs/specification.md draws them.
[[nodiscard]] const spec::CommunicationModel& model_of(const spec::Model& model,
                                                       const spec::Channel& channel);

}  // namespace tessera::layers
