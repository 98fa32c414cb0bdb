#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "test_system.hpp"

namespace tessera::testing {

/// Firings that a recording holds by now.
[[nodiscard]] std::size_t firings_in(const std::string& file);

/// A run that is controlled: in a thread, with a socket in a folder of its own.
class Controlled : public ::testing::Test {
 protected:
  Controlled();
  ~Controlled() override;

  /// Two subsystems with rates, 10 ms and 20 ms, and a channel between them.
  static void build(TestSystem& system);
  /// Starts the run and connects to it.
  void start();
  /// Another connection to the run, which never blocks; -1: it was refused.
  [[nodiscard]] int connect_another() const;

  void send_line(const std::string& line) const;
  /// Whether the run has read all that was sent. It reads again only after it has dealt with what it has read.
  [[nodiscard]] bool has_read_all() const;
  /// The next line that it accepts; null: the run is over.
  [[nodiscard]] nlohmann::json await(const std::function<bool(const nlohmann::json&)>& wanted);
  /// The mistake in the command; empty: there is none.
  std::string command(nlohmann::json what);
  /// The snapshot that shows the run paused for at least so many times.
  nlohmann::json rest(std::uint64_t pauses);
  /// Asks for the bytes of the recording that come next.
  std::string piece();
  std::string what_comes_at_the_end();
  void finish();

  std::string folder_;
  std::function<void(TestSystem&)> build_ = build;
  TestSystem system_;
  const System* made_ = nullptr;  // of system_, while it runs
  RunOptions options_;
  RunSummary summary_;
  std::thread running_;
  std::atomic<bool> over_{false};
  int socket_ = -1, last_ = 0;
  bool more_ = false;  // of the recording
  std::string received_;

 private:
  bool receive();
  std::string next_piece();
};

}  // namespace tessera::testing
