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
/// Threads: any.
namespace console {
void print(LogLevel level, Time time, std::string_view path, std::string_view text);
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
