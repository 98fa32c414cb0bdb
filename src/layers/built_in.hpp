#pragma once

#include "spec/model/model.hpp"

namespace tessera::layers {

/// The model of a channel: the author's, or the built-in one of its modes and timeouts. Lives as long as
/// `model`.
///
/// Source of the built-in ones: non-blocking at both ends is the paper's fully asynchronous model (sec.
/// IV-E); the others are made by the paper's recipe. docs/specification.md draws them.
[[nodiscard]] const spec::CommunicationModel& model_of(const spec::Model& model,
                                                       const spec::Channel& channel);

}  // namespace tessera::layers
