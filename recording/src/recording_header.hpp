#pragma once

#include "tessera/recording.hpp"

namespace tessera {

/// Reads Recording::header into the other members. false: the JSON lacks a field that every recording has.
[[nodiscard]] bool read_header(Recording& recording);

}  // namespace tessera
