#pragma once

#include <future>
#include <memory>
#include <string>

#include "ros2/fast/service.hpp"

namespace tessera::ros2 {

/// Makes our side of a service for another side that runs rmw_fastrtps_cpp, in a thread of its own, since that takes
/// tens of milliseconds. It loads the library for Fast DDS, which is the one that TESSERA_ROS2_FAST_LIBRARY names, or
/// lies beside this library.
///
/// Threads: one at a time.
class FastLibrary {
 public:
  /// Begins; the second time, it does nothing.
  void begin(const FastSetup& setup);
  /// nullptr: it was not begun, or is under way, or has failed.
  [[nodiscard]] FastService* service();
  /// Why it has failed; empty: it has not.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  struct Made {
    std::unique_ptr<FastService> service;
    std::string error;
  };
  static Made made(const FastSetup& setup);

  std::future<Made> making_;
  std::unique_ptr<FastService> service_;
  std::string error_;
  bool begun_ = false;
};

}  // namespace tessera::ros2
