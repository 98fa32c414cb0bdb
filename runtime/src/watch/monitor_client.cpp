#include "watch/monitor_client.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "system/waker.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/monitor.hpp"

namespace tessera {
namespace {

constexpr std::size_t most_unsent = std::size_t{16} << 20U;
constexpr std::int64_t client_patience_ns = 5'000'000'000;

}  // namespace

MonitorClient::~MonitorClient() { close(socket_); }

std::size_t MonitorClient::receive() {
  std::array<char, 4096> bytes{};
  const ssize_t count = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  gone_ = gone_ || count <= 0;
  if (count <= 0) return 0;
  received_.append(bytes.data(), static_cast<std::size_t>(count));
  return static_cast<std::size_t>(count);
}

std::optional<std::string> MonitorClient::take_line() {
  const std::size_t end = received_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  has_asked_ = true;
  return line;
}

void MonitorClient::check_limits() {
  gone_ = gone_ || received_.size() > longest_command || unsent_.size() > most_unsent;
}

void MonitorClient::add(std::string_view text) {
  if (unsent_.empty()) took_ns_ = monotonic_ns();
  unsent_ += text;
}

bool MonitorClient::add_piece(const std::string& recording) {
  if (recording_ == nullptr)
    recording_ = std::make_unique<GrowingRecording>(recording, GrowingRecording::From::newest);
  const GrowingRecording::Piece piece = recording_->next(longest_piece);
  add(line_of(PieceHead{.bytes = piece.bytes.size(), .begins = piece.begins, .more = piece.more}));
  add(piece.bytes);
  return !piece.bytes.empty();
}

void MonitorClient::add_scene(const std::string& file, std::uint64_t from) {
  std::error_code missing;
  const std::uintmax_t total = file.empty() ? 0 : std::filesystem::file_size(file, missing);
  std::string bytes;
  if (std::ifstream stream(file, std::ios::binary); !file.empty() && !missing && stream && from < total) {
    bytes.resize(static_cast<std::size_t>(std::min<std::uintmax_t>(total - from, longest_piece)));
    stream.seekg(static_cast<std::streamoff>(from));
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) bytes.clear();
  }
  add(line_of(SceneHead{.bytes = bytes.size(), .from = from, .total = missing ? 0 : total}));
  add(bytes);
}

void MonitorClient::send() {
  const ssize_t count = ::send(socket_, unsent_.data(), unsent_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  gone_ = gone_ || (count < 0 && errno != EAGAIN && errno != EINTR);
  if (count <= 0) return;
  unsent_.erase(0, static_cast<std::size_t>(count));
  took_ns_ = monotonic_ns();
}

void MonitorClient::skip_snapshot() {
  gone_ = gone_ || monotonic_ns() - took_ns_ > client_patience_ns;
  skipped_ = true;
}

bool MonitorClient::take_skipped() { return std::exchange(skipped_, false); }

}  // namespace tessera
