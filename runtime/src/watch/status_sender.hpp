#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "assembly/assembly.hpp"
#include "system/clock.hpp"

namespace tessera {

/// Sends the state of this process of a deployed system over the network while there are readers, five times a second
/// or less often. Its thread guards nothing and accepts no commands, so that nothing waits for it. A failure in it ends
/// the sending and not the run.
///
/// Threads: made and destroyed by one. The assembly and its carrier must outlive it.
class StatusSender {
 public:
  StatusSender(const Assembly& assembly, const Clock& clock);
  ~StatusSender();
  StatusSender(const StatusSender&) = delete;
  StatusSender& operator=(const StatusSender&) = delete;

 private:
  using Real = std::chrono::steady_clock;
  void serve();
  void serve_until_ended();
  /// Returns how long it shall rest.
  [[nodiscard]] Real::duration send();
  [[nodiscard]] bool ends_within(Real::duration time);

  const Assembly& assembly_;
  const Clock& clock_;
  std::mutex mutex_;
  std::condition_variable ending_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace tessera
