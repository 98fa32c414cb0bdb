#include "cli/watching/running_controller.hpp"

#include <algorithm>
#include <variant>
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

void RunningController::learn_name() {
  connection_.limit_waits(std::chrono::seconds(2));
  const std::optional<std::string> first = line();
  if (!first) return;
  pending_.insert(0, *first + "\n");
  std::optional<project::ControlLine> said = project::read_control_line(*first);
  const auto* snapshot = said ? std::get_if<project::Snapshot>(&*said) : nullptr;
  if (snapshot == nullptr) return;
  name_ = snapshot->system + "." + (snapshot->name ? *snapshot->name + "." : "") +
          std::to_string(snapshot->process);
}

namespace {

/// name: SYSTEM.PID or SYSTEM.PROCESS.PID
bool is_meant(const std::string& name, const std::string& which) {
  return which.empty() || name.starts_with(which + ".") || name.ends_with("." + which) ||
         name.find("." + which + ".") != std::string::npos;
}

}  // namespace

std::vector<RunningController> running_controllers(const std::string& which) {
  std::vector<RunningController> running;
  for (const fs::path& file : project::control_sockets(monitor_folder())) {
    const bool shortened = has_shortened_name(file.native());
    if (!shortened && !is_meant(file.stem().string(), which)) continue;
    // A socket that does not answer was left behind by a process that was killed.
    std::optional<RunningController> one = RunningController::attach(file);
    if (!one) continue;
    if (shortened) one->learn_name();
    if (is_meant(one->name(), which)) running.push_back(std::move(*one));
  }
  return running;
}

int complain_of_none(const std::string& which) {
  return complain((which.empty() ? "no controller is running" : "no controller '" + which + "' is running") +
                  " in real time as this user; `tessera run` starts one");
}

std::vector<RunningController> find_controllers(const std::string& which) {
  std::vector<RunningController> running = running_controllers(which);
  if (running.empty()) complain_of_none(which);
  return running;
}

std::vector<SeenController> first_look(std::vector<RunningController> controllers) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(2);
  std::vector<SeenController> seen;
  for (RunningController& one : controllers) {
    SeenController& looked_at = seen.emplace_back(SeenController{std::move(one), {}, {}});
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    looked_at.controller.be_patient_for(std::max(left, std::chrono::milliseconds(50)));
    looked_at.line = looked_at.controller.line().value_or("");
    std::optional<project::ControlLine> line = project::read_control_line(looked_at.line);
    if (auto* snapshot = line ? std::get_if<project::Snapshot>(&*line) : nullptr)
      looked_at.snapshot = std::move(*snapshot);
  }
  return seen;
}

std::optional<std::string> common_deployment(const std::vector<SeenController>& controllers) {
  std::optional<std::string> system;
  for (const SeenController& one : controllers) {
    if (!one.snapshot) continue;  // it hangs; its system is one of the others', or it is the only one
    if (!one.snapshot->name || (system && *system != one.snapshot->system)) return std::nullopt;
    system = one.snapshot->system;
  }
  const bool all = system && std::ranges::all_of(controllers, [&](const SeenController& one) {
                     return one.controller.name().starts_with(*system + ".");
                   });
  return all ? system : std::nullopt;
}

int complain_of_several(const std::vector<SeenController>& controllers) {
  std::string names;
  for (const SeenController& one : controllers) names += (names.empty() ? "" : ", ") + one.controller.name();
  return complain("several controllers are running (" + names +
                  "): name one, by its system, its process or its number");
}

}  // namespace tessera::cli
