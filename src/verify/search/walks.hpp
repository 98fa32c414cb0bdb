#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "explore/budget.hpp"
#include "explore/pt_net.hpp"

namespace tessera::verify {

/// For each of the places: does it hold a token at some time of one of these walks? A walk is a run each of
/// whose firings is drawn from those that are possible. It begins anew where nothing is possible any more.
/// The walks end after so many firings in all, or once every place has held a token. They are always the
/// same.
///
/// Throws explore::CutOff if the budget is spent. Threads: pure.
[[nodiscard]] std::vector<bool> marked_on_walks(const explore::PtNet& net,
                                                const std::vector<std::uint32_t>& places, std::size_t firings,
                                                const explore::Budget& budget);

}  // namespace tessera::verify
