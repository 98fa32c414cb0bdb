#include "cli/watching/running_controller.hpp"

#include <algorithm>
#include <utility>
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

std::optional<project::ControlMessage> RunningController::message() {
  if (coming_) return std::exchange(coming_, std::nullopt);
  for (;;) {
    if (std::optional<project::ControlMessage> message = heard_.next()) return message;
    if (heard_.exceeds_limits() || connection_.receive(heard_) != project::ControlConnection::Received::bytes)
      return std::nullopt;
  }
}

const project::ControlMessage* RunningController::coming_message() {
  if (!coming_) coming_ = message();
  return coming_ ? &*coming_ : nullptr;
}

namespace {

const project::Snapshot* snapshot_in(const project::ControlMessage* message) {
  return message != nullptr && message->content ? std::get_if<project::Snapshot>(&*message->content)
                                                : nullptr;
}

}  // namespace

void RunningController::learn_name() {
  connection_.limit_waits(std::chrono::seconds(2));
  const project::Snapshot* snapshot = snapshot_in(coming_message());
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
    SeenController& looked_at = seen.emplace_back(SeenController{std::move(one), {}});
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    looked_at.controller.be_patient_for(std::max(left, std::chrono::milliseconds(50)));
    if (const project::Snapshot* snapshot = snapshot_in(looked_at.controller.coming_message()))
      looked_at.snapshot = *snapshot;
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
