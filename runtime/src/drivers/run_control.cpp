#include "drivers/run_control.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

namespace tessera {

void RunControl::request_stop(std::string_view reason, bool fault) {
  if (fault) failed_.store(true, std::memory_order_release);
  std::uint32_t running = 0;
  if (!state_.compare_exchange_strong(running, 1, std::memory_order_acq_rel)) return;
  length_ = std::min(reason.size(), reason_.size());
  std::copy_n(reason.data(), length_, reason_.data());
}

void RunControl::begin_emergency(std::string_view why) {
  {
    const std::lock_guard lock(emergency_mutex_);
    if (emergency_.load(std::memory_order_relaxed)) return;
    emergency_length_ = std::min(why.size(), emergency_reason_.size());
    std::copy_n(why.data(), emergency_length_, emergency_reason_.data());
    emergency_.store(true, std::memory_order_seq_cst);
    emergencies_.fetch_add(1, std::memory_order_seq_cst);
  }
  tell_supervisor();
}

bool RunControl::end_emergency(Time valid_from) {
  {
    const std::lock_guard lock(emergency_mutex_);
    if (!emergency_.load(std::memory_order_relaxed)) return false;
    valid_from_.store(valid_from, std::memory_order_relaxed);
    emergencies_over_.fetch_add(1, std::memory_order_seq_cst);
    emergency_.store(false, std::memory_order_seq_cst);
  }
  tell_supervisor();
  return true;
}

std::string RunControl::emergency_reason() const {
  const std::lock_guard lock(emergency_mutex_);
  return {emergency_reason_.data(), emergency_length_};
}

void RunControl::tell_supervisor() const {
  const std::uint64_t one = 1;
  if (const int descriptor = news_.load(std::memory_order_acquire); descriptor >= 0) [[maybe_unused]]
    const ssize_t written = write(descriptor, &one, sizeof one);
}

}  // namespace tessera
