#include "sim/trace_writer.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace tessera::sim {
namespace {

void append(std::string& line, double value, int decimals) {
  std::array<char, 400> digits;  // the largest double has 309 digits before the point
  const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed, decimals).ptr;
  line.append(digits.begin(), end);
  line += ',';
}

}  // namespace

TraceWriter::TraceWriter(std::string path) : path_(std::move(path)) {
  if (!wanted()) return;
  file_.open(path_, std::ios::binary);
  if (!file_) reason_ = std::string(": ") + std::strerror(errno);
}

void TraceWriter::begin(const std::vector<std::string>& robots) {
  if (!wanted() || begun_) return;
  begun_ = true;
  if (robots.size() > 1) {
    file_ << several_robots;
    for (std::size_t index = 0; index < robots.size(); ++index)
      file_ << (index > 0 ? ", " : "") << robots[index];
    file_ << '\n';
  }
  file_ << trace_columns << '\n';
  file_.flush();
}

void TraceWriter::add(const TracePoint& point) {
  if (!wanted()) return;
  std::string line;
  append(line, point.t_s, 3);
  for (const double value : {point.x_m, point.y_m, point.heading_rad, point.eye_x_m, point.eye_y_m}) {
    append(line, value, 6);
  }
  line += point.on_line ? "1\n" : "0\n";
  file_ << line;
  // Another program may be following the file.
  const auto now = std::chrono::steady_clock::now();
  if (now - flushed_ < std::chrono::milliseconds(50)) return;
  flushed_ = now;
  file_.flush();
}

std::optional<Problem> TraceWriter::finish() {
  if (!wanted()) return std::nullopt;
  file_.flush();
  if (file_) return std::nullopt;
  return Problem{path_ + ": the trace could not be written" + reason_};
}

}  // namespace tessera::sim
