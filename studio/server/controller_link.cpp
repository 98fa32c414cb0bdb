#include "server/controller_link.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

#include "tessera/monitor.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

/// -1: nobody listens there.
int connected_to(const std::filesystem::path& file) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (file.native().size() >= sizeof address.sun_path) return -1;
  std::memcpy(address.sun_path, file.c_str(), file.native().size() + 1);
  const int made = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (connect(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return made;
  close(made);
  return -1;
}

}  // namespace

std::vector<std::string> listening_sockets() {
  std::vector<std::string> names;
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(monitor_folder(), ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (entry->path().extension() != ".sock" || !entry->is_socket(ignored)) continue;
    const int found = connected_to(entry->path());
    if (found < 0) continue;
    close(found);
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

ControllerLink::~ControllerLink() { close(); }

bool ControllerLink::connect(const std::filesystem::path& file, bool own) {
  const int made = connected_to(file);
  if (made < 0) return false;
  const std::lock_guard lock(mutex_);
  socket_ = made;
  open_ = true;
  answered_.notify_all();
  return !own || say("{\"command\":\"own\"}\n");
}

bool ControllerLink::is_over() {
  const std::lock_guard lock(mutex_);
  return over_;
}

bool ControllerLink::say(const std::string& line) {
  return send(socket_, line.data(), line.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(line.size());
}

std::optional<json> ControllerLink::snapshot() {
  if (socket_ < 0) return std::nullopt;
  std::array<char, 65536> bytes{};
  ssize_t count = 0;
  while ((count = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0)
    heard_.append(bytes.data(), static_cast<std::size_t>(count));
  if (count == 0) close();
  std::optional<json> last;
  for (std::size_t end; (end = heard_.find('\n')) != std::string::npos; heard_.erase(0, end + 1)) {
    json line =
        json::parse(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    if (!line.is_object()) continue;
    if (!line.contains("answer")) {
      last = std::move(line);
      continue;
    }
    const std::lock_guard lock(mutex_);
    answers_[line.value("answer", 0)] = line.value("error", "");
    answered_.notify_all();
  }
  return last;
}

std::string ControllerLink::command(json command) {
  constexpr auto patience = std::chrono::seconds(5);
  std::unique_lock lock(mutex_);
  if (!answered_.wait_for(lock, patience, [&] { return open_ || over_; }) || over_)
    return over_ ? "the controller has ended" : "the controller does not listen yet";
  const int id = ++last_;
  command["id"] = id;
  if (!say(command.dump() + "\n")) return "the controller takes no commands";
  if (!answered_.wait_for(lock, patience, [&] { return !open_ || answers_.contains(id); }))
    return "the controller does not answer";
  const auto answer = answers_.find(id);
  return answer == answers_.end() ? "the controller has ended" : answers_.extract(answer).mapped();
}

void ControllerLink::close() {
  const std::lock_guard lock(mutex_);
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  open_ = false;
  over_ = true;
  answered_.notify_all();
}

}  // namespace tessera::server
