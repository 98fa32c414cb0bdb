#pragma once

#include <stdexcept>

namespace tessera::coppelia {

/// The connection to the simulator is unusable: no program listens, the server has gone, it does not answer
/// in time, or it speaks another protocol. The text is a sentence for the user.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// No reply arrived in time.
class NoReply : public LinkError {
 public:
  using LinkError::LinkError;
};

/// The simulator answered that it cannot execute the call.
class RefusedCall : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tessera::coppelia
