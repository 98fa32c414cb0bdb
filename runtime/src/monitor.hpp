#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "assembly.hpp"

namespace tessera {

/// Serves what the subsystems show (tessera/monitor.hpp) in a thread of its own, from construction to
/// destruction. Takes no part in the run: what goes wrong with it is in `failure` and ends nothing.
///
/// Threads: made and destroyed by one; the assembly must outlive it.
class Monitor {
 public:
  Monitor(const Assembly& assembly, const Clock& clock);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  [[nodiscard]] const std::string& failure() const { return failure_; }  ///< empty: it listens

 private:
  [[nodiscard]] bool listen_in(const std::string& folder);
  void serve();
  void admit();
  void send_to_all();
  [[nodiscard]] std::string snapshot() const;

  const Assembly& assembly_;
  const Clock& clock_;
  std::string socket_file_, failure_;
  int listening_ = -1, ending_ = -1;
  std::vector<int> clients_;
  std::thread thread_;
};

}  // namespace tessera
