#pragma once

#include "spec/model/communication_model.hpp"

namespace tessera::layers {

/// The actions of one side of a channel.
struct SideMode {
  bool blocks = false, timeout = false;
};

/// The communication model of a channel that crosses processes: the sender's block, the receiver's block, and
/// the medium between them, which keeps values that are on the way. Each side has its own memory: slot 0 is
/// the sender's, slot 1 the receiver's.
///
/// A value is `sent` if it is the newest and alone on the way; `more` stands for it and any number of older
/// ones. The newest value is never lost: a network that loses a message is one that takes longer, since the
/// sender sends it again. docs/use/fleets.md explains the four ends of a timeout.
[[nodiscard]] spec::CommunicationModel networked(SideMode send, SideMode receive);

}  // namespace tessera::layers
