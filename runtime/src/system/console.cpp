#include "system/console.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <ctime>
#include <system_error>
#include <thread>
#include <utility>

#include "system/line_ring.hpp"
#include "system/patient_output.hpp"
#include "system/repeated_lines.hpp"
#include "system/service.hpp"
#include "system/stop_signals.hpp"
#include "system/waker.hpp"
#include "tessera/printable.hpp"

namespace tessera::console {
namespace {

constexpr std::size_t longest_line = 1000, most_lines = 256, most_with_progress = 8;
constexpr std::int64_t terminal_patience_ns = 500'000'000;
constexpr int look_up_ms = 50;

std::atomic<bool> progress_shown{false}, silent{false};
std::atomic<bool> to_journal{false};  // set by the outermost Session

/// Writes the lines of the ring. It lives as long as the process: a thread that is blocked in the driver of
/// a terminal may outlive its session.
class Writer {
 public:
  void begin(Session::Overflow overflow) {
    waits_ = overflow == Session::Overflow::waits;
    lost_ = 0;
    given_up_ = false;
    Stage left_behind = Stage::ending;
    // the thread that was left behind goes on for this session
    runs_ = stage_.compare_exchange_strong(left_behind, Stage::writing);
    if (runs_) return;
    stage_ = Stage::writing;
    try {
      thread_ = std::thread([this] { run(); });
      runs_ = true;
    } catch (const std::system_error&) {  // without a thread, each caller of print writes its lines
      stage_ = Stage::none;
    }
  }

  void end() {
    if (!runs_.exchange(false)) return;
    stage_ = Stage::ending;
    wakes_.wake();
    const std::int64_t until_ns = monotonic_ns() + 2 * terminal_patience_ns;
    while (stage_ != Stage::none && monotonic_ns() < until_ns) pause();
    if (!thread_.joinable()) return;
    if (stage_ == Stage::none)
      thread_.join();
    else
      thread_.detach();
  }

  [[nodiscard]] std::uint64_t settle() {
    std::uint64_t last = ring_.size();
    for (std::int64_t since_ns = monotonic_ns();
         runs_ && ring_.size() > 0 && monotonic_ns() - since_ns < terminal_patience_ns; pause()) {
      if (ring_.size() != last) since_ns = monotonic_ns();
      last = ring_.size();
    }
    return lost_ + ring_.size();
  }

  void put(std::string_view line) {
    if (!runs_) return write_at_once(line);
    bool taken = ring_.push(line);
    while (!taken && waits_ && StopSignals::pending() == 0) {
      pause();
      taken = ring_.push(line);
    }
    if (!taken) ++lost_;
    wakes_.wake();
  }

  /// Dropped if there is much to be written, or if the terminal takes nothing now.
  void put_progress(std::string_view line) {
    if (!runs_) {
      pollfd room{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
      if (poll(&room, 1, 0) > 0) write_at_once(line);
      return;
    }
    if (ring_.size() < most_with_progress && ring_.push(line)) wakes_.wake();
  }

 private:
  static void pause() {
    const timespec time{.tv_sec = 0, .tv_nsec = 1'000'000};
    nanosleep(&time, nullptr);
  }

  static void write_at_once(std::string_view line) {
    // A line that cannot be written is no reason to stop.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
  }

  void run() {
    PatientOutput output(STDERR_FILENO);
    std::uint64_t told = 0;
    for (;;) {
      const std::uint32_t ticket = wakes_.ticket();
      const bool last = stage_ == Stage::ending;
      while (!ring_.front().empty()) {
        if (!write_out(ring_.front(), output)) ++lost_;
        ring_.pop();
      }
      if (lost_ != told) told = tell_lost(output);
      Stage expected = Stage::ending;
      if (last && stage_.compare_exchange_strong(expected, Stage::none)) return;
      wakes_.sleep(ticket, -1);
    }
  }

  [[nodiscard]] std::uint64_t tell_lost(PatientOutput& output) const {
    const std::uint64_t lost = lost_;
    std::array<char, 128> line;
    const auto end = fmt::format_to_n(
        line.data(), line.size(), "tessera  {} lines not printed: the terminal did not take them\n", lost);
    static_cast<void>(write_out({line.data(), end.size}, output));
    return lost;
  }

  /// false: the line could not be written; at the end of the session, not even after some time.
  [[nodiscard]] bool write_out(std::string_view line, PatientOutput& output) const {
    std::int64_t stuck_ns = 0;
    for (;;) {
      const std::size_t before = line.size();
      switch (output.write(line)) {
        case PatientOutput::Result::all:
          return true;
        case PatientOutput::Result::gone:
          return false;
        case PatientOutput::Result::some:
          break;
      }
      const std::int64_t now_ns = monotonic_ns();
      if (line.size() != before || stage_ != Stage::ending) stuck_ns = 0;
      if (stuck_ns == 0) stuck_ns = now_ns;
      if (given_up_ || now_ns - stuck_ns > terminal_patience_ns) {
        given_up_ = true;
        return false;
      }
      output.await_room(look_up_ms);
    }
  }

  LineRing<most_lines, longest_line> ring_;
  WakeWord wakes_;
  /// State of the thread. One that is still `ending` when the next session begins was left behind.
  enum class Stage : std::uint8_t { none, writing, ending };
  std::atomic<Stage> stage_{Stage::none};
  std::atomic<bool> runs_{false}, waits_{false};
  mutable std::atomic<bool> given_up_{false};
  std::atomic<std::uint64_t> lost_{0};
  std::thread thread_;
};

/// Never destroyed: see Writer.
[[nodiscard]] Writer& writer() {
  static Writer& only = *new Writer;
  return only;
}

std::atomic<int> sessions{0};

/// Never destroyed: a thread may print to the very end.
[[nodiscard]] RepeatedLines& repeated() {
  static RepeatedLines& only = *new RepeatedLines;
  return only;
}

template <std::size_t Size>
[[nodiscard]] std::string_view cut(std::array<char, Size>& line, std::size_t wanted) {
  if (wanted > Size) line[Size - 1] = '\n';
  return {line.data(), std::min(wanted, Size)};
}

/// The level as in sd-daemon(3); empty: the output is no journal.
[[nodiscard]] const char* journal_level(LogLevel level) {
  if (!to_journal.load(std::memory_order_relaxed)) return "";
  return level == LogLevel::info ? "<6>" : level == LogLevel::warning ? "<4>" : "<3>";
}

[[nodiscard]] const char* erase_progress() {
  return progress_shown.exchange(false, std::memory_order_relaxed) ? "\r\x1b[K" : "";
}

}  // namespace

Session::Session(Overflow overflow) : outermost_(sessions++ == 0) {
  if (!outermost_) return;
  to_journal = writes_to_journal();
  writer().begin(overflow);
}

Session::~Session() {
  if (outermost_) {
    repeated().tell_left_out([](std::string_view path, std::string_view text, std::uint64_t left_out) {
      std::array<char, longest_line> line, room;
      const auto end =
          fmt::format_to_n(line.data(), line.size(), "{}{}  {} more like this were not printed: {}\n",
                           journal_level(LogLevel::info), path, left_out, printable(text, room));
      writer().put(cut(line, end.size));
    });
    writer().end();
  }
  --sessions;
}

std::uint64_t Session::settle() { return writer().settle(); }

void print(LogLevel level, Time time, std::string_view path, std::string_view text) {
  if (silent.load(std::memory_order_relaxed)) return;
  RepeatedLines::Turn turn;
  if (level != LogLevel::info) turn = repeated().next(static_cast<int>(level), path, text);
  if (!turn.printed) return;
  std::array<char, 32> times{};
  if (turn.count > 1) fmt::format_to_n(times.data(), times.size() - 1, " ({} times)", turn.count);
  std::array<char, longest_line> line, room;  // text of user code, too
  const char* mark = level == LogLevel::info ? "" : level == LogLevel::warning ? "warning: " : "error: ";
  const auto end = fmt::format_to_n(line.data(), line.size(), "{}{}{:.3f} s  {}  {}{}{}\n",
                                    journal_level(level), erase_progress(), seconds(time.time_since_epoch()),
                                    path, mark, printable(text, room), times.data());
  writer().put(cut(line, end.size));
}

void say(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min({text.find('\n'), text.size() - 1, longest_line - 1}) + 1;
    writer().put(text.substr(0, end));
    text.remove_prefix(end);
  }
}

void progress(std::string_view text) {
  if (to_journal.load(std::memory_order_relaxed)) return;
  std::array<char, longest_line> line;
  progress_shown.store(true, std::memory_order_relaxed);
  writer().put_progress(cut(line, fmt::format_to_n(line.data(), line.size(), "\r{}\x1b[K", text).size));
}

void clear_progress() {
  if (const std::string_view erase = erase_progress(); !erase.empty()) writer().put_progress(erase);
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
  if (!start_ns_) start_ns_ = wall_ns;
  if (wall_ns < next_ns_) return;
  next_ns_ = wall_ns + progress_period_ns;
  const double passed_s = seconds(now.time_since_epoch());
  std::array<char, 128> text;
  auto end = fmt::format_to_n(text.data(), text.size(), "{:.1f} s", passed_s).out;
  const auto room = [&] { return static_cast<std::size_t>(text.data() + text.size() - end); };
  if (duration_) end = fmt::format_to_n(end, room(), " of {:g} s", seconds(*duration_)).out;
  if (wall_ns > *start_ns_)
    end = fmt::format_to_n(end, room(), ", {:.1f}x real time",
                           passed_s * 1e9 / static_cast<double>(wall_ns - *start_ns_))
              .out;
  console::progress({text.data(), static_cast<std::size_t>(end - text.data())});
}

}  // namespace tessera
