#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "tessera/time.hpp"

namespace tessera {

/// The request to end a run, and the stalled subsystems. All threads of a run share it.
///
/// Threads: any, unless said otherwise. Never blocks for long, never allocates after construction.
class RunControl {
 public:
  explicit RunControl(std::uint32_t instances)
      : ended_(std::make_unique<std::atomic<bool>[]>(instances)),
        stalled_(std::make_unique<std::atomic<bool>[]>(instances)) {}

  /// Only the first reason counts; it is cut at 512 bytes. fault: the run failed.
  void request_stop(std::string_view reason, bool fault);
  [[nodiscard]] bool stopping() const { return state_.load(std::memory_order_acquire) != 0; }
  /// Only after the threads of the run have ended.
  [[nodiscard]] std::string_view reason() const { return {reason_.data(), length_}; }
  [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_acquire); }

  /// The process ends although user code is still running: calls from that code no longer return.
  void abandon() { abandoned_.store(true, std::memory_order_release); }
  [[nodiscard]] bool abandoned() const { return abandoned_.load(std::memory_order_acquire); }

  /// ended: false: it begins again.
  void mark_ended(std::uint32_t instance, bool ended = true) {
    ended_[instance].store(ended, std::memory_order_release);
  }
  [[nodiscard]] bool has_ended(std::uint32_t instance) const {
    return ended_[instance].load(std::memory_order_acquire);
  }

  /// The process is about to be suspended: until resume, only safe commands go to devices.
  void suspend() { suspended_.store(true, std::memory_order_seq_cst); }
  /// valid_from: effectors ignore values that were sent before.
  void resume(Time valid_from) {
    valid_from_.store(valid_from, std::memory_order_relaxed);
    suspensions_over_.fetch_add(1, std::memory_order_seq_cst);
    suspended_.store(false, std::memory_order_seq_cst);
  }
  [[nodiscard]] bool suspended() const { return suspended_.load(std::memory_order_seq_cst); }
  [[nodiscard]] Time valid_from() const { return valid_from_.load(std::memory_order_relaxed); }

  /// The run is held: no subsystem makes another step until it goes on. Unlike `suspend`, this says nothing of devices.
  void pause(bool paused) { paused_.store(paused, std::memory_order_seq_cst); }
  [[nodiscard]] bool paused() const { return paused_.load(std::memory_order_acquire); }

  /// Begins the emergency stop, unless one is in force already: only safe commands go to devices until an
  /// operator ends it. why: as in request_stop.
  void begin_emergency(std::string_view why);
  /// Ends the emergency stop for an operator. valid_from: as in resume. false: there was none.
  bool end_emergency(Time valid_from);
  [[nodiscard]] bool emergency() const { return emergency_.load(std::memory_order_seq_cst); }
  /// The number of emergency stops so far.
  [[nodiscard]] std::uint32_t emergencies() const { return emergencies_.load(std::memory_order_seq_cst); }
  /// The reason of the emergency stop that is in force, or of the last one.
  [[nodiscard]] std::string emergency_reason() const;
  /// Sets an eventfd that is written to when an emergency stop begins or ends, and by tell_supervisor; -1: none.
  void set_supervisor_event(int descriptor) { news_.store(descriptor, std::memory_order_release); }

  /// Another process sets `acted` when it has given the devices their safe command for this one, which stood
  /// still: from then on, no other command goes to a device, whichever thread wakes first. Call it before the
  /// run has threads; `acted` must outlive them.
  void withhold_after(const std::atomic<bool>& acted) { acted_outside_ = &acted; }

  /// A device does not take its safe command: until it has, only safe commands go to the others, too. Threads: the
  /// supervisor's.
  void hold_devices(bool held) { held_.store(held, std::memory_order_seq_cst); }
  [[nodiscard]] bool holds_devices() const { return held_.load(std::memory_order_seq_cst); }
  /// There is news of a device that does not take its safe command: writes to the event of
  /// set_supervisor_event.
  void tell_supervisor() const;

  /// The number of ended periods in which only safe commands could go to devices.
  struct Interruptions {
    std::uint32_t suspensions = 0, emergencies = 0;
    [[nodiscard]] bool operator==(const Interruptions&) const = default;
  };
  /// Read it before a command is judged. If the number is greater when the command is given, such a period
  /// has ended in between. The ends are counted, not the beginnings, because a command may also be judged
  /// during an interruption.
  [[nodiscard]] Interruptions interruptions() const {
    return {suspensions_over_.load(std::memory_order_seq_cst),
            emergencies_over_.load(std::memory_order_seq_cst)};
  }

  /// Whether only safe commands may go to devices.
  [[nodiscard]] bool withholds_commands() const {
    return stopping() || suspended() || emergency() || holds_devices() ||
           (acted_outside_ != nullptr && acted_outside_->load());
  }

  /// The transition function has run longer than its watchdog allows, and has not returned.
  void mark_stalled(std::uint32_t instance, bool stalled) {
    stalled_[instance].store(stalled, std::memory_order_seq_cst);
  }
  [[nodiscard]] bool is_stalled(std::uint32_t instance) const {
    return stalled_[instance].load(std::memory_order_seq_cst);
  }

 private:
  std::atomic<std::uint32_t> state_{0}, emergencies_{0}, suspensions_over_{0}, emergencies_over_{0};
  std::atomic<bool> abandoned_{false}, failed_{false}, suspended_{false}, emergency_{false}, held_{false},
      paused_{false};
  const std::atomic<bool>* acted_outside_ = nullptr;  // in memory that is shared with another process
  std::atomic<int> news_{-1};
  mutable std::mutex emergency_mutex_;  // guards the members below; it is held no longer than a copy takes
  std::array<char, 512> emergency_reason_{};
  std::size_t emergency_length_ = 0;
  std::atomic<Time> valid_from_{Time::min()};
  std::array<char, 512> reason_{};
  std::size_t length_ = 0;
  std::unique_ptr<std::atomic<bool>[]> ended_, stalled_;
};

}  // namespace tessera
