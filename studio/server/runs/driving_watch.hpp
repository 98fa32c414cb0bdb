#pragma once

#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "server/http/events.hpp"

namespace tessera::server {

/// Watches which controllers drive devices now: those of this user in real time, on real devices or in a
/// simulated world, whoever has started them. It connects to the control socket of each once a second, while
/// a page is open, and publishes the event `driving` when something has changed.
///
/// Threads: any; it has one of its own.
class DrivingWatch {
 public:
  explicit DrivingWatch(Events& events);
  ~DrivingWatch();
  DrivingWatch(const DrivingWatch&) = delete;
  DrivingWatch& operator=(const DrivingWatch&) = delete;

  /// {"controllers": [{"name", "system", "process", "deployed", "answers", "emergency"}]} as of the last look.
  [[nodiscard]] nlohmann::json last() const;
  /// Looks again at once: somebody has told the controllers something.
  void look_soon();

 private:
  void watch();
  Events& events_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable news_;
  nlohmann::json last_ = {{"controllers", nlohmann::json::array()}};
  bool soon_ = false, over_ = false;
  std::thread thread_;  ///< the last: it uses the others
};

}  // namespace tessera::server
