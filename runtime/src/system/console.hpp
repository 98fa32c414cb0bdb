#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "tessera/context.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Lines for people on standard error: "12.345 s  robot.control  text". One write per line; fixed buffers.
///
/// While a Session exists, a separate thread writes, and no other thread ever waits for the terminal: not if
/// it was stopped with Ctrl-S, if it is a pipe that is not read, or if it is gone.
///
/// Threads: any.
namespace console {

class Session {
 public:
  /// The treatment of a line if the terminal does not keep up.
  enum class Overflow : std::uint8_t {
    loses,  ///< the line is only counted
    waits   ///< print waits for room, unless a signal has come; only while nothing moves
  };
  explicit Session(Overflow overflow = Overflow::loses);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Waits until everything is written, or until nothing could be written for half a second.
  /// Reports the number of lost lines.
  ~Session();

  /// Waits in the same way. Returns how many lines have not been printed so far, or still wait.
  [[nodiscard]] std::uint64_t settle();

 private:
  bool outermost_;
};

/// Warnings and errors that differ in their numbers only are counted after the third: the 10th, the 100th and so
/// on are printed with the count, and the outermost Session says at its end how many were not.
void print(LogLevel level, Time time, std::string_view path, std::string_view text);
/// Prints the text unchanged, line by line.
void say(std::string_view text);
/// Rewrites the line that shows progress; the next print removes it.
void progress(std::string_view text);
void clear_progress();
/// Turns print off, or on again, for example while a thousand runs are made.
void silence(bool wanted);
}  // namespace console

/// "12.3 s of 60 s, 45.0x real time", rewritten a few times per second of real time.
///
/// Threads: one at a time.
class ProgressLine {
 public:
  ProgressLine(bool shown, std::optional<Duration> duration) : shown_(shown), duration_(duration) {}
  ~ProgressLine();
  void update(Time now);

 private:
  bool shown_;
  std::optional<Duration> duration_;
  std::optional<std::int64_t> start_ns_;
  std::int64_t next_ns_ = 0;
};

}  // namespace tessera
