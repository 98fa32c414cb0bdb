// Runs that were started elsewhere, and that are only followed: one controller, or all processes of a
// deployed system.
#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <utility>

#include "project/files/installation.hpp"
#include "server/runs/deployment_follower.hpp"
#include "server/runs/run.hpp"
#include "tessera/monitor.hpp"

namespace tessera::server {

using nlohmann::json;

/// Why that controller cannot be shown on this net; nullopt: it can.
std::optional<Problem> Run::why_not_attachable(const Snapshot& snapshot) const {
  if (snapshot.net_hash == analysis_->net_hash) return std::nullopt;
  return Problem{fmt::format("the controller runs another net (of the system {}) than the specification here",
                             snapshot.system)};
}

/// The controller's recording if it is a file within the project; otherwise an empty path. The end of a
/// tunnel names a file of another machine, and this one may have an old file of that name.
std::filesystem::path Run::readable_recording(const Snapshot& snapshot) {
  std::error_code missing;
  const std::filesystem::path file = std::filesystem::canonical(snapshot.recording.value_or(""), missing);
  const std::filesystem::path folder = spec_.parent_path();
  const auto [end, ignored] = std::ranges::mismatch(folder, file);
  const bool within = !missing && end == folder.end();
  return within && link_.is_process(snapshot.pid) ? file : std::filesystem::path();
}

/// The scene of a controller whose files cannot be read comes through its socket, piece by piece.
void Run::fetch_scene() {
  {
    const std::lock_guard lock(mutex_);
    if (scene_.is_null() || !glb_.empty()) return;
  }
  std::optional<std::string> glb = link_.scene();
  if (!glb) return;
  json scene;
  {
    const std::lock_guard lock(mutex_);
    glb_ = std::move(*glb);
    scene = scene_;
  }
  publish("scene", std::move(scene));  // again: now it can be loaded
}

void Run::attach() {
  if (!link_.connect(std::filesystem::path(monitor_folder()) / request_.socket, /*own=*/false))
    return set_state(State::failed, "no program listens at " + request_.socket);
  std::optional<Snapshot> snapshot;
  while (!snapshot && !stop_ && !link_.is_over()) {
    snapshot = link_.snapshot();
    if (!snapshot) RunFollower::rest();
  }
  if (!snapshot) return set_state(State::ended, "it has ended");
  if (const std::optional<Problem> why = why_not_attachable(*snapshot))
    return set_state(State::failed, why->text);
  const std::filesystem::path file = readable_recording(*snapshot);
  RunFollower follower(file.empty() ? [this] { return link_.recording(); }
                                    : RecordingStream::of_file(file, GrowingRecording::From::newest),
                       *analysis_, &reached_);
  set_state(State::running);
  while (!stop_ && !link_.is_over()) {
    if (!tell(follower, std::exchange(snapshot, std::nullopt), /*last=*/false)) RunFollower::rest();
    if (file.empty()) fetch_scene();
    snapshot = link_.snapshot();
  }
  while (!stop_ && tell(follower, std::exchange(snapshot, std::nullopt), /*last=*/true)) continue;
  link_.close();
  if (stop_ || link_.has_ended())
    return set_state(State::ended, stop_ ? "let go; it runs on" : "it has ended");
  set_state(State::failed, "the connection to the controller is lost; it may still be running");
}

namespace {

/// Empty: the installation has no library of the network, and this machine alone is watched.
project::OpenFeed network_feed() try {
  return project::feed_of_library(project::Installation::find().carrier_library);
} catch (const std::exception&) {
  return {};
}

}  // namespace

void Run::watch_deployment() {
  if (!analysis_->model->deployment)
    return set_state(State::failed, "the specification has no `deploy`: attach to a controller by its name");
  DeploymentFollower follower(*analysis_, reached_, network_feed());
  bool found = false;
  while (!stop_ && follower.is_going_on()) {
    DeploymentFollower::News news = follower.poll();
    if (!found && !news.deployment.is_null()) {
      found = true;
      set_state(State::running);
    }
    tell(std::move(news));
  }
  if (!found) return set_state(State::failed, stop_ ? "let go" : follower.why_nothing());
  set_state(State::ended, stop_ ? "let go; they run on" : "all processes have ended");
}

void Run::tell(DeploymentFollower::News news) {
  {
    const std::lock_guard lock(mutex_);
    time_ns_ = std::max(time_ns_, news.time_ns);
    firings_ = std::max(firings_, news.total_firings);
    if (news.marking) marking_ = *news.marking;
    if (!news.values.is_null()) values_.update(news.values.at("values"));
    if (!news.subsystems.is_null()) subsystems_ = news.subsystems;
    if (!news.deployment.is_null()) deployment_ = news.deployment;
  }
  if (!news.firings.is_null()) publish("firings", std::move(news.firings));
  if (!news.values.is_null()) publish("values", std::move(news.values));
  if (!news.subsystems.is_null()) publish("subsystems", std::move(news.subsystems));
  if (!news.deployment.is_null()) publish("deployment", std::move(news.deployment));
}

}  // namespace tessera::server
