#include "cli/running_controller.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "cli/terminal.hpp"
#include "tessera/monitor.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

namespace {

void set_patience(int descriptor, int direction, std::chrono::milliseconds time) {
  const timeval patience{.tv_sec = time.count() / 1000, .tv_usec = time.count() % 1000 * 1000};
  setsockopt(descriptor, SOL_SOCKET, direction, &patience, sizeof patience);
}

}  // namespace

std::optional<RunningController> RunningController::attach(const fs::path& socket_file) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = socket_file.string();
  if (name.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, name.c_str(), name.size() + 1);
  RunningController made(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0), socket_file.stem().string());
  set_patience(made.descriptor_, SO_SNDTIMEO, std::chrono::seconds(1));  // limits connect, too
  const auto* raw = reinterpret_cast<const sockaddr*>(&address);
  if (made.descriptor_ < 0 || connect(made.descriptor_, raw, sizeof address) != 0) return std::nullopt;
  return made;
}

RunningController::~RunningController() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::optional<std::string> RunningController::line() {
  for (;;) {
    if (const std::size_t end = pending_.find('\n'); end != std::string::npos) {
      std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      return line;
    }
    char bytes[65536];
    const ssize_t count = ::read(descriptor_, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    pending_.append(bytes, static_cast<std::size_t>(count));
  }
}

void RunningController::be_patient_for(std::chrono::milliseconds time) {
  for (const int direction : {SO_RCVTIMEO, SO_SNDTIMEO}) set_patience(descriptor_, direction, time);
}

bool RunningController::send(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t count = ::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

namespace {

std::vector<fs::path> sockets(const std::string& which) {
  std::vector<fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(monitor_folder(), none)) {
    const std::string name = entry.path().filename().string();  // SYSTEM.PID.sock
    if (!name.ends_with(".sock")) continue;
    if (which.empty() || name.starts_with(which + ".") || name.ends_with("." + which + ".sock"))
      found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace

std::vector<RunningController> find_controllers(const std::string& which) {
  std::vector<RunningController> running;
  // A socket that does not answer was left behind by a process that was killed.
  for (const fs::path& file : sockets(which))
    if (std::optional<RunningController> one = RunningController::attach(file))
      running.push_back(std::move(*one));
  if (running.empty())
    complain((which.empty() ? "no controller is running" : "no controller '" + which + "' is running") +
             " in real time as this user; `tessera run` starts one");
  return running;
}

std::optional<RunningController> find_controller(const std::string& which) {
  std::vector<RunningController> running = find_controllers(which);
  if (running.size() == 1) return std::move(running.front());
  if (running.empty()) return std::nullopt;
  std::string names;
  for (const RunningController& one : running) names += (names.empty() ? "" : ", ") + one.name();
  complain("several controllers are running (" + names + "): name one, by its system or its process");
  return std::nullopt;
}

}  // namespace tessera::cli
