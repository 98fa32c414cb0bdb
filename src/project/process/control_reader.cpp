#include "project/process/control_reader.hpp"

#include <variant>

#include "tessera/monitor.hpp"

namespace tessera::project {

namespace {

constexpr std::size_t most_unread = std::size_t{64} << 20U;

std::size_t bytes_behind(const std::optional<ControlLine>& line) {
  if (!line) return 0;
  if (const auto* piece = std::get_if<PieceHead>(&*line)) return piece->bytes;
  if (const auto* scene = std::get_if<SceneHead>(&*line)) return scene->bytes;
  return 0;
}

}  // namespace

void ControlReader::add(std::string_view bytes) {
  unread_.erase(0, begin_);
  begin_ = 0;
  unread_ += bytes;
}

std::optional<ControlMessage> ControlReader::next() {
  const std::size_t end = unread_.find('\n', begin_);
  if (announces_too_much_ || end == std::string::npos) return std::nullopt;
  ControlMessage message;
  message.line = unread_.substr(begin_, end - begin_);
  message.content = read_control_line(message.line);
  const std::size_t behind = bytes_behind(message.content);
  announces_too_much_ = behind > longest_piece;
  if (announces_too_much_ || behind > unread_.size() - end - 1) return std::nullopt;
  message.bytes = unread_.substr(end + 1, behind);
  begin_ = end + 1 + behind;
  return message;
}

bool ControlReader::exceeds_limits() const {
  return announces_too_much_ || unread_.size() - begin_ > most_unread;
}

}  // namespace tessera::project
