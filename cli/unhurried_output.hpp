#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace tessera::cli {

/// Text to a descriptor that may accept it slowly, or not at all: a stopped terminal, a full pipe or disk, a
/// reader that has gone. No writer waits or fails, because it may watch over robots. Text beyond the buffer
/// is left out, and the output says how many pieces that were.
///
/// Threads: any.
class UnhurriedOutput {
 public:
  /// Text beyond this unread amount is left out.
  static constexpr std::size_t most_waiting = std::size_t{1} << 20U;

  /// Receives the problem of the output, "Broken pipe", each time that one begins. It is called in a thread
  /// of the output, and must not wait or throw.
  using Complain = std::function<void(std::string_view)>;
  explicit UnhurriedOutput(int descriptor, Complain complain = {});
  /// Waits until all text is written, or cannot be.
  ~UnhurriedOutput();
  UnhurriedOutput(const UnhurriedOutput&) = delete;
  UnhurriedOutput& operator=(const UnhurriedOutput&) = delete;

  /// text: whole lines.
  void write(std::string text);
  /// Waits until all text is written or cannot be, at most for this time; not again while the reader is
  /// blocked.
  void settle(std::chrono::milliseconds longest);

 private:
  void write_all();
  void write_one(const std::string& text);

  const int descriptor_;
  const Complain complain_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  std::deque<std::string> waiting_;
  std::size_t bytes_ = 0, left_out_ = 0;
  bool writing_ = false, ending_ = false, stuck_ = false;
  int error_ = 0;  ///< of the last write; 0: it succeeded. Used by the thread only
  std::thread thread_;
};

}  // namespace tessera::cli
