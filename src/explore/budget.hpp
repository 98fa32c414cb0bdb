#pragma once

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

#include "explore/watch.hpp"

namespace tessera::explore {

/// Thrown to end a task whose time is over, or that was told to stop. The code that began the task catches it
/// and goes on without its result.
class CutOff : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The time that a task of several steps has left of its limits. Every loop that may take long asks it.
///
/// Threads: any number may ask one.
class Budget {
 public:
  explicit Budget(Limits limits) : limits_(std::move(limits)), start_(Clock::now()) {}

  /// The rest for one exploration.
  [[nodiscard]] Limits left() const {
    Limits left = limits_;
    left.time = limits_.time - std::chrono::duration<double>(Clock::now() - start_);
    left.time = std::max(left.time, std::chrono::duration<double>(0));
    return left;
  }

  [[nodiscard]] bool stopped() const { return limits_.stop != nullptr && limits_.stop->load(); }
  /// No time is left, or the task was told to stop. Reads the clock: ask once in some hundred steps.
  [[nodiscard]] bool spent() const { return stopped() || Clock::now() - start_ >= limits_.time; }

  /// Throws CutOff, with the reason, if it is spent.
  void check() const {
    if (stopped()) throw CutOff("it was interrupted");
    if (spent()) throw CutOff("the time limit is reached");
  }

 private:
  using Clock = std::chrono::steady_clock;
  Limits limits_;
  Clock::time_point start_;
};

}  // namespace tessera::explore
