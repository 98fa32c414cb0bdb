#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "tessera/context.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Lines for people, on standard error: "12.345 s  robot.control  text". One write per line, from fixed
/// buffers.
///
/// While a Session lives, a thread of its own writes, and nobody else ever waits for the terminal: not for
/// one that was stopped with Ctrl-S, a pipe that nobody reads, or one that is gone.
///
/// Threads: any.
namespace console {

class Session {
 public:
  /// What happens to a line when the terminal does not keep up.
  enum class Overflow : std::uint8_t {
    loses,  ///< it is counted instead
    waits   ///< print waits for room, unless a signal has come: nothing moves meanwhile
  };
  explicit Session(Overflow overflow = Overflow::loses);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Waits until everything is written, or nothing could be for half a second; says how many lines were not.
  ~Session();

  /// The same wait, and how many lines were not printed so far, or wait still.
  [[nodiscard]] std::uint64_t settle();

 private:
  bool outermost_;
};

void print(LogLevel level, Time time, std::string_view path, std::string_view text);
/// The text as it is, line by line.
void say(std::string_view text);
/// Rewrites the line that shows progress; the next print removes it.
void progress(std::string_view text);
void clear_progress();
/// From now on print does nothing, or again what it did: of a thousand runs nobody reads every line.
void silence(bool wanted);
}  // namespace console

/// "12.3 s of 60 s, 45.0x real time", rewritten a few times a second of the wall clock.
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
  std::int64_t start_ns_ = -1, next_ns_ = 0;
};

}  // namespace tessera
