#pragma once

#include <cstddef>

#include "tessera/bounded_sequence.hpp"
#include "tessera/large_array.hpp"

namespace tessera {

/// A BoundedSequence whose copies share their elements until one of them is written to, as those of a
/// LargeArray.
template <class T, std::size_t Most>
using LargeSequence = BoundedSequence<T, Most, LargeArray<T, Most>>;

}  // namespace tessera
