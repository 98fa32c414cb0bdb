#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "project/build/controller.hpp"
#include "server/analysis/analysis.hpp"
#include "server/http/events.hpp"
#include "server/recordings/notices.hpp"
#include "server/recordings/robot_path.hpp"
#include "server/recordings/run_follower.hpp"
#include "server/runs/controller_link.hpp"
#include "server/runs/deployment_follower.hpp"
#include "server/runs/run_operators.hpp"
#include "server/runs/run_parameters.hpp"
#include "tessera/result.hpp"

namespace tessera::server {

/// A request for a run.
struct RunRequest {
  enum class Kind : std::uint8_t {
    simulate,   ///< on the simulated clock
    run,        ///< on the steady clock with real drivers
    attach,     ///< to a controller that another process has started
    deployment  ///< the same to all processes of a deployed system on this machine
  } kind = Kind::simulate;
  std::string socket;  ///< for attach: a name in tessera::monitor_folder()
  std::string world, track, duration;
  std::uint64_t seed = 1;
  double speed = 1;
  bool paused = false;
  double skip_to_s = 0;      ///< of simulate: as fast as possible up to this time of the run
  bool records_all = false;  ///< also values of more than 4 KiB, such as pictures
};

/// A command to a running run; each command reads its own members.
struct RunControl {
  std::string command;
  std::string subsystem;        ///< of step_iteration
  std::optional<double> speed;  ///< of speed
  std::string path, text;       ///< of set: a parameter and its value
  std::string who;              ///< of panel: the operator
  std::optional<std::map<std::string, std::variant<double, bool>>>
      inputs;                               ///< of panel, which has a path, too
  std::optional<double> after_s, within_s;  ///< of panel: RunOperators::Input
  [[nodiscard]] RunOperators::Input input() const { return {path, who, after_s, within_s}; }
  std::vector<std::uint32_t> places, transitions, conditions;  ///< of breakpoints: indices of the net
};

/// A controller from generation to its end, in threads of its own: made, started, followed by its recording.
/// An attached controller is only followed; it goes on when this object ends.
///
/// Threads: any.
class Run {
 public:
  /// spec: the specification. The files of the run get a separate folder (project::RunFolder).
  Run(std::string id, RunRequest request, std::filesystem::path spec,
      std::shared_ptr<const Analysis> analysis, Events& events);
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  enum class State : std::uint8_t { building, running, paused, ended, failed };
  [[nodiscard]] bool over() const;
  [[nodiscard]] RunRequest::Kind kind() const { return request_.kind; }
  /// {"run", "state", "kind", ...}: docs/reference/studio.md.
  [[nodiscard]] nlohmann::json info(bool all) const;
  /// The part of the net that it has reached so far: docs/reference/studio.md.
  [[nodiscard]] nlohmann::json coverage() const {
    return reached_.coverage(*analysis_->pages, *analysis_->net);
  }
  /// The scene with that hash, if it came through a tunnel.
  [[nodiscard]] std::optional<std::string> scene(const std::string& hash) const {
    const std::lock_guard lock(mutex_);
    if (glb_.empty() || scene_.is_null() || scene_.at("hash") != hash) return std::nullopt;
    return glb_;
  }
  /// nullopt: done.
  [[nodiscard]] std::optional<Problem> control(const RunControl& wanted);
  void stop() { stop_ = true; }
  /// The operators of its panels: docs/reference/studio.md.
  [[nodiscard]] nlohmann::json operators() const { return operators_.shown(stamp_now()); }

 private:
  class RunListener;
  [[nodiscard]] bool is_building() const;
  [[nodiscard]] std::optional<Problem> operate(const RunControl& wanted);
  void make_and_run();
  [[nodiscard]] std::optional<project::Controller> make();
  void execute(project::Controller controller);
  void attach();
  void watch_deployment();
  void fetch_scene();
  [[nodiscard]] std::optional<Problem> why_not_attachable(const Snapshot& snapshot) const;
  [[nodiscard]] std::filesystem::path readable_recording(const Snapshot& snapshot);
  void follow(const std::filesystem::path& socket, const std::filesystem::path& folder);
  [[nodiscard]] bool tell(RunFollower& follower, std::optional<Snapshot> snapshot, bool last);
  void tell(DeploymentFollower::News news);
  void set_state(State state, const std::string& why = {});
  void publish(const char* event, nlohmann::json data) const;

  const std::string id_;
  const RunRequest request_;
  const std::filesystem::path spec_;
  const std::shared_ptr<const Analysis> analysis_;
  Events& events_;
  Reached reached_;
  ControllerLink link_;
  RunOperators operators_;
  std::atomic<bool> stop_{false}, process_over_{false}, controllable_{false};
  std::thread follower_, thread_;

  mutable std::mutex mutex_;  ///< guards the members below
  State state_ = State::building;
  std::string why_;
  nlohmann::json outcome_, values_ = nlohmann::json::object(), verdicts_, pose_, subsystems_, scene_, poses_,
                           deployment_;
  replay::Thinned<PathPoint> path_{5000};
  std::string glb_;  ///< of scene_; empty: it is beside the recording, or has not arrived yet
  RunParameters parameters_;
  Notices notices_{1000};
  std::vector<std::uint32_t> marking_;
  std::int64_t time_ns_ = 0;
  std::uint64_t firings_ = 0;
};

}  // namespace tessera::server
