#include "cli/running_controller.hpp"

#include <vector>

#include "cli/terminal.hpp"
#include "tessera/monitor.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

std::optional<RunningController> RunningController::attach(const fs::path& socket_file) {
  std::optional<project::ControlConnection> made = project::ControlConnection::to(socket_file);
  if (!made) return std::nullopt;
  return RunningController(std::move(*made), socket_file.stem().string());
}

std::optional<std::string> RunningController::line() {
  for (;;) {
    if (const std::size_t end = pending_.find('\n'); end != std::string::npos) {
      std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      return line;
    }
    if (connection_.receive(pending_) != project::ControlConnection::Received::bytes) return std::nullopt;
  }
}

namespace {

std::vector<fs::path> sockets(const std::string& which) {
  std::vector<fs::path> found;
  for (const fs::path& file : project::control_sockets(monitor_folder())) {
    const std::string name = file.filename().string();  // SYSTEM.PID.sock or SYSTEM.PROCESS.PID.sock
    if (which.empty() || name.starts_with(which + ".") || name.ends_with("." + which + ".sock") ||
        name.find("." + which + ".") != std::string::npos)
      found.push_back(file);
  }
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
  complain("several controllers are running (" + names +
           "): name one, by its system, its process or its number");
  return std::nullopt;
}

}  // namespace tessera::cli
