#pragma once

#include "ros2/codec/cdr.hpp"
#include "ros2/definitions/type.hpp"

/// Parts of messages that become parts of other messages, where they may be aligned otherwise.
namespace tessera::ros2 {

/// Reads a message of that type and writes the same. The reader fails if there is none.
void copy_message(const Structure& type, CdrReader& from, CdrWriter& to);
/// Writes a message of zeros and empty texts.
void write_empty_message(const Structure& type, CdrWriter& to);

}  // namespace tessera::ros2
