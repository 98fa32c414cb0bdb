#include "run_control.hpp"

#include <algorithm>

namespace tessera {

void RunControl::request_stop(std::string_view reason, bool fault) {
  if (fault) failed_.store(true, std::memory_order_release);
  std::uint32_t running = 0;
  if (!state_.compare_exchange_strong(running, 1, std::memory_order_acq_rel)) return;
  length_ = std::min(reason.size(), reason_.size());
  std::copy_n(reason.data(), length_, reason_.data());
}

}  // namespace tessera
