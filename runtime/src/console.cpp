#include "console.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <atomic>

#include "waker.hpp"

namespace tessera::console {
namespace {

std::atomic<bool> progress_shown{false}, silent{false};

template <std::size_t Size>
void emit(std::array<char, Size>& line, std::size_t wanted) {
  const std::size_t size = wanted < Size ? wanted : Size;
  if (wanted > Size) line[Size - 1] = '\n';
  // A lost line is no reason to stop a robot.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), size);
}

}  // namespace

void print(LogLevel level, Time time, std::string_view path, std::string_view text) {
  if (silent.load(std::memory_order_relaxed)) return;
  std::array<char, 896> line;
  const char* erase = progress_shown.exchange(false, std::memory_order_relaxed) ? "\r\x1b[K" : "";
  const char* mark = level == LogLevel::info ? "" : level == LogLevel::warning ? "warning: " : "error: ";
  const auto end = fmt::format_to_n(line.data(), line.size(), "{}{:.3f} s  {}  {}{}\n", erase,
                                    seconds(time.time_since_epoch()), path, mark, text);
  emit(line, end.size);
}

void progress(std::string_view text) {
  std::array<char, 256> line;
  progress_shown.store(true, std::memory_order_relaxed);
  emit(line, fmt::format_to_n(line.data(), line.size(), "\r{}\x1b[K", text).size);
}

void clear_progress() {
  std::array<char, 8> line;
  if (progress_shown.exchange(false, std::memory_order_relaxed))
    emit(line, fmt::format_to_n(line.data(), line.size(), "\r\x1b[K").size);
}

void silence(bool wanted) { silent.store(wanted, std::memory_order_relaxed); }

}  // namespace tessera::console

namespace tessera {
namespace {

constexpr std::int64_t progress_period_ns = 200'000'000;

}  // namespace

ProgressLine::~ProgressLine() {
  if (shown_) console::clear_progress();
}

void ProgressLine::update(Time now) {
  if (!shown_) return;
  const std::int64_t wall_ns = monotonic_ns();
  if (start_ns_ < 0) start_ns_ = wall_ns;
  if (wall_ns < next_ns_) return;
  next_ns_ = wall_ns + progress_period_ns;
  const double passed_s = seconds(now.time_since_epoch());
  std::array<char, 128> text;
  auto end = fmt::format_to_n(text.data(), text.size(), "{:.1f} s", passed_s).out;
  const auto room = [&] { return static_cast<std::size_t>(text.data() + text.size() - end); };
  if (duration_) end = fmt::format_to_n(end, room(), " of {:g} s", seconds(*duration_)).out;
  if (wall_ns > start_ns_)
    end = fmt::format_to_n(end, room(), ", {:.1f}x real time",
                           passed_s * 1e9 / static_cast<double>(wall_ns - start_ns_))
              .out;
  console::progress({text.data(), static_cast<std::size_t>(end - text.data())});
}

}  // namespace tessera
