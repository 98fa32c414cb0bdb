#include "server/runs/controller_link.hpp"

#include <chrono>
#include <string_view>
#include <utility>
#include <variant>

#include "tessera/monitor.hpp"

namespace tessera::server {

using Clock = std::chrono::steady_clock;

std::vector<std::string> listening_sockets() {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : project::control_sockets(monitor_folder()))
    if (project::ControlConnection::to(file)) names.push_back(file.filename().string());
  return names;
}

ControllerLink::~ControllerLink() { close(); }

bool ControllerLink::connect(const std::filesystem::path& file, bool own) {
  std::optional<project::ControlConnection> made = project::ControlConnection::to(file);
  if (!made) return false;
  const std::lock_guard lock(mutex_);
  connection_ = std::move(made);
  open_ = true;
  answered_.notify_all();
  return !own || say(line_of(command::Own{}));
}

bool ControllerLink::is_open() {
  const std::lock_guard lock(mutex_);
  return open_;
}

bool ControllerLink::is_over() {
  const std::lock_guard lock(mutex_);
  return over_;
}

bool ControllerLink::say(const std::string& line) const { return connection_ && connection_->send(line); }

bool ControllerLink::is_process(std::int64_t id) const { return connection_ && connection_->is_process(id); }

/// Reads the data that has arrived so far.
void ControllerLink::hear() {
  using Received = project::ControlConnection::Received;
  Received received = Received::bytes;
  while (connection_ && received == Received::bytes) {
    received = connection_->receive_at_once(heard_);
    if (heard_.exceeds_limits()) return close();
  }
  if (received == Received::over) close();
  understand();
}

/// Handles the messages up to a piece of the recording that waits to be taken; later messages are newer.
void ControllerLink::understand() {
  while (!piece_) {
    std::optional<project::ControlMessage> message = heard_.next();
    if (!message) break;
    if (!message->content) continue;  // from another version, or malformed
    if (auto* snapshot = std::get_if<Snapshot>(&*message->content))
      snapshot_ = std::move(*snapshot);
    else if (auto* answer = std::get_if<CommandAnswer>(&*message->content))
      take(std::move(*answer));
    else if (const auto* head = std::get_if<PieceHead>(&*message->content))
      piece_ = {std::move(message->bytes), head->begins, head->more};
    else if (const auto* scene = std::get_if<SceneHead>(&*message->content))
      take(*scene, message->bytes);
    else
      ended_ = true;
  }
  if (heard_.exceeds_limits()) close();  // not what a controller sends
}

void ControllerLink::take(CommandAnswer answer) {
  const std::lock_guard lock(mutex_);
  answers_[answer.id] = std::move(answer.problem);
  answered_.notify_all();
}

void ControllerLink::take(const SceneHead& head, std::string_view bytes) {
  constexpr std::uint64_t largest = std::uint64_t{256} << 20U;
  scene_asked_ = false;
  if (head.from == scene_.size() && head.total <= largest) scene_ += bytes;
  const bool whole = scene_.size() == head.total;
  scene_complete_ = whole || bytes.empty() || head.total > largest;
  if (scene_complete_ && !whole) scene_.clear();
}

std::optional<std::string> ControllerLink::scene() {
  if (scene_complete_) return scene_;
  if (scene_asked_ || !connection_) return std::nullopt;
  const std::lock_guard lock(mutex_);
  scene_asked_ = say(line_of(command::Scene{scene_.size()}));
  return std::nullopt;
}

GrowingRecording::Piece ControllerLink::recording() {
  const auto until = Clock::now() + std::chrono::milliseconds(100);
  if (!asked_ && !ended_ && connection_) {
    const std::lock_guard lock(mutex_);
    asked_ = say(line_of(command::Recording{}));
  }
  for (hear(); !piece_ && asked_ && connection_ && Clock::now() < until; hear())
    connection_->wait(std::chrono::milliseconds(10));
  GrowingRecording::Piece piece;
  piece.more = asked_ && connection_;
  if (!piece_) return piece;
  piece = *std::exchange(piece_, std::nullopt);
  asked_ = false;
  if (!connection_) piece.more = !piece.bytes.empty();
  return piece;
}

std::optional<Snapshot> ControllerLink::snapshot() {
  hear();
  return std::exchange(snapshot_, std::nullopt);
}

std::optional<Problem> ControllerLink::command(const ControlCommand& command) {
  constexpr auto patience = std::chrono::seconds(5);
  // On a busy machine a controller may take long to start. Its end ends the wait.
  constexpr auto patience_with_start = std::chrono::seconds(60);
  std::unique_lock lock(mutex_);
  if (!answered_.wait_for(lock, patience_with_start, [&] { return open_ || over_; }) || over_)
    return Problem{over_ ? "the controller has ended" : "the controller does not listen yet"};
  const std::int64_t id = ++last_;
  if (!say(line_of(command, id))) return Problem{"the controller takes no commands"};
  if (!answered_.wait_for(lock, patience, [&] { return !open_ || answers_.contains(id); }))
    return Problem{"the controller does not answer"};
  const auto answer = answers_.find(id);
  if (answer == answers_.end()) return Problem{"the controller has ended"};
  return std::move(answers_.extract(answer).mapped());
}

void ControllerLink::close() {
  const std::lock_guard lock(mutex_);
  connection_.reset();
  open_ = false;
  over_ = true;
  answered_.notify_all();
}

}  // namespace tessera::server
