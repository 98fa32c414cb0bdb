#include "server/runs/run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <utility>

#include "project/files/file_names.hpp"
#include "project/files/run_folder.hpp"
#include "project/files/state_folder.hpp"
#include "project/launch.hpp"
#include "project/process/death.hpp"
#include "project/process/listener.hpp"
#include "project/process/process.hpp"
#include "project/verification/pipeline.hpp"
#include "server/http/json_text.hpp"
#include "server/runs/run_panels.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/monitor.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

const char* name_of(Run::State state) {
  switch (state) {
    case Run::State::building:
      return "building";
    case Run::State::running:
      return "running";
    case Run::State::paused:
      return "paused";
    case Run::State::ended:
      return "ended";
    case Run::State::failed:
      return "failed";
  }
  return "";
}

const char* name_of(RunRequest::Kind kind) {
  switch (kind) {
    case RunRequest::Kind::simulate:
      return "simulate";
    case RunRequest::Kind::run:
      return "run";
    case RunRequest::Kind::attach:
      return "attach";
    case RunRequest::Kind::deployment:
      return "deployment";
  }
  return "";
}

/// The names of elements; nullopt: there is no such element.
template <class Elements>
std::optional<std::vector<std::string>> names_at(const std::vector<std::uint32_t>& indices,
                                                 const Elements& elements) {
  std::vector<std::string> names;
  for (const std::uint32_t index : indices) {
    if (index >= elements.size()) return std::nullopt;
    names.push_back(elements[index].name);
  }
  return names;
}

/// For the controller, which uses names. nullopt: the net has no such place or transition.
std::optional<ControlCommand> breakpoints_of(const RunControl& wanted, const net::Net& net) {
  auto places = names_at(wanted.places, net.places());
  auto transitions = names_at(wanted.transitions, net.transitions());
  auto conditions = names_at(wanted.conditions, net.transitions());
  if (!places || !transitions || !conditions) return std::nullopt;
  return command::Breakpoints{std::move(*places), std::move(*transitions), std::move(*conditions)};
}

/// nullopt: there is no such command, or it sets breakpoints.
std::optional<ControlCommand> plain_command_of(const RunControl& wanted) {
  using namespace command;
  const std::string& what = wanted.command;
  if (what == "pause") return Pause{};
  if (what == "resume") return Resume{};
  if (what == "step_firing") return StepFiring{};
  if (what == "step_iteration") return StepIteration{wanted.subsystem};
  if (what == "speed") return Speed{wanted.speed.value_or(-1)};  // the controller refuses -1
  return std::nullopt;
}

json read_summary(const std::filesystem::path& file) {
  std::ifstream stream(file);
  json summary = stream ? json::parse(stream, nullptr, /*allow_exceptions=*/false) : json(nullptr);
  if (summary.is_object()) summary.erase("curves");  // for plots of a report
  return summary;
}

}  // namespace

/// Reports the lines of the build to the browsers; the last lines say why it failed.
class Run::RunListener final : public project::Listener {
 public:
  explicit RunListener(const Run& run) : run_(run) {}
  void say(std::string_view text) override {
    for (std::size_t start = 0; start < text.size();) {
      const std::size_t end = std::min(text.find('\n', start), text.size());
      line(text.substr(start, end - start));
      start = end + 1;
    }
  }
  void progress(std::string_view what) override {
    if (!what.empty()) line(what);
  }
  void line(std::string_view text) {
    if (text.find("error") != std::string_view::npos && error_.empty()) error_ = text;
    run_.publish("build", {{"line", text}});
  }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  const Run& run_;
  std::string error_;
};

Run::Run(std::string id, RunRequest request, std::filesystem::path spec,
         std::shared_ptr<const Analysis> analysis, Events& events)
    : id_(std::move(id)),
      request_(std::move(request)),
      spec_(std::move(spec)),
      analysis_(std::move(analysis)),
      events_(events),
      reached_(*analysis_->net),
      parameters_(*analysis_->model),
      marking_(MarkingTracker(*analysis_->net).marked()) {
  thread_ = std::thread([this] { make_and_run(); });
}

Run::~Run() {
  stop_ = true;
  thread_.join();
}

bool Run::is_building() const {
  const std::lock_guard lock(mutex_);
  return state_ == State::building;
}

bool Run::over() const {
  const std::lock_guard lock(mutex_);
  return state_ == State::ended || state_ == State::failed;
}

void Run::publish(const char* event, json data) const {
  data["run"] = id_;
  events_.publish(event, text_of(data));
}

void Run::set_state(State state, const std::string& why) {
  json told{{"state", name_of(state)}, {"why", why}};
  {
    const std::lock_guard lock(mutex_);
    state_ = state;
    why_ = why;
    told["outcome"] = outcome_;
    told["marking"] = marking_;
    told["firings"] = firings_;
  }
  publish("run", std::move(told));
}

void Run::make_and_run() {
  try {
    if (request_.kind == RunRequest::Kind::attach) return attach();
    if (request_.kind == RunRequest::Kind::deployment) return watch_deployment();
    std::optional<project::Controller> controller = make();
    if (controller) execute(std::move(*controller));
  } catch (const std::exception& error) {
    set_state(State::failed, error.what());
  } catch (...) {  // from a library: MuJoCo's is no std::exception
    set_state(State::failed, "a library failed without saying why");
  }
}

std::optional<project::Controller> Run::make() {
  RunListener teller(*this);
  set_state(State::building);
  project::LaunchOptions launch;
  launch.spec = spec_.string();
  const bool simulated = request_.kind == RunRequest::Kind::simulate || !request_.world.empty();
  if (!project::every_real_buffer_has_driver(launch, simulated, teller)) {
    set_state(State::failed, teller.error());
    return std::nullopt;
  }
  teller.line("verifying, generating and compiling the controller");
  project::BuildOptions options;
  options.stop = &stop_;
  std::optional<project::Controller> controller = project::make_controller(spec_, options, teller);
  if (!controller && stop_)
    set_state(State::ended, "stopped");
  else if (!controller)
    set_state(State::failed, teller.error().empty() ? "the controller was not built" : teller.error());
  return controller;
}

void Run::execute(project::Controller controller) {
  RunListener teller(*this);
  const project::RunFolder folder(project::state_folder(controller.specification.project),
                                  name_of(request_.kind), project::RunFolder::Shown::as_last, teller);
  controller.program = folder.own_copy_of(controller.program);
  {
    const std::lock_guard lock(mutex_);
    verdicts_ = json::object();
    for (const verify::PropertyResult& property : controller.report.properties)
      verdicts_[property.name] = project::name_of(property.verdict);
  }
  project::LaunchOptions options;
  options.duration = request_.duration;
  options.world = request_.world;
  options.track = request_.track;
  options.seed = request_.seed;
  if (request_.records_all) options.record_values = "all";
  options.base = controller.specification.project;
  options.folder = folder.path().string();
  const bool simulated = request_.kind == RunRequest::Kind::simulate;
  project::Command command = project::controller_command(controller, options, name_of(request_.kind),
                                                         simulated || !request_.world.empty());
  if (simulated) {
    command.insert(command.end(), {"--controlled", fmt::format("--speed={}", request_.speed)});
    if (request_.paused) command.emplace_back("--paused");
    if (request_.skip_to_s > 0) command.push_back(fmt::format("--skip-to={:.9f}s", request_.skip_to_s));
  }
  const bool begins_paused = request_.paused && request_.skip_to_s <= 0;
  set_state(begins_paused && simulated ? State::paused : State::running);
  const std::filesystem::path note = folder.path() / "death.txt";
  const project::Exit exit = project::capture_apart(
      project::with_death_note(command, note), stop_,
      [this](std::string_view line) {
        publish("log", {{"line", line}});
      },
      [this, &options](pid_t process) {
        const std::filesystem::path socket = monitor_file(analysis_->model->system, process);
        follower_ = std::thread([this, socket, folder = options.folder] { follow(socket, folder); });
      });
  process_over_ = true;
  if (follower_.joinable()) follower_.join();
  json summary = read_summary(folder.path() / project::file_names::summary);
  // A run that was stopped may have failed all the same: the guardian acted, or a device refused.
  const bool says_so = summary.is_object() && summary.value("failed", false);
  const bool failed = says_so || (exit.code != 0 && !stop_ && exit.code != 130);
  std::string why = stop_ && !says_so     ? "stopped"
                    : summary.is_object() ? summary.value("ended", "")
                                          : exit.text;
  if (!summary.is_object()) {
    const std::string death = project::describe_death(exit, note);
    if (!stop_ && !death.empty()) why = death;
    if (death.empty()) folder.withdraw();
  }
  {
    const std::lock_guard lock(mutex_);
    outcome_ = summary.is_object() ? std::move(summary) : json(nullptr);
  }
  set_state(failed ? State::failed : State::ended, why);
}

void Run::follow(const std::filesystem::path& socket, const std::filesystem::path& folder) {
  RunFollower follower(
      RecordingStream::of_file(folder / project::file_names::recording, GrowingRecording::From::newest),
      *analysis_, &reached_);
  bool connected = false;
  for (bool last = false;; last = process_over_) {
    if (!connected) connected = link_.connect(socket, /*own=*/request_.kind == RunRequest::Kind::simulate);
    const bool more = tell(follower, connected ? link_.snapshot() : std::nullopt, last);
    if (last && !more) break;
    if (!more) RunFollower::rest();
  }
  link_.close();
}

/// true: there is more to report at once.
bool Run::tell(RunFollower& follower, std::optional<Snapshot> snapshot, bool last) {
  RunFollower::News news = follower.poll(std::move(snapshot), last);
  std::optional<State> changed;
  json parameters;
  {
    const std::lock_guard lock(mutex_);
    if (news.lacks_parameters) parameters_.forget();
    for (const auto& [path, value] : news.parameters) parameters_.set(path, value);
    if (!news.parameters.empty() || news.lacks_parameters)
      parameters = {{"t", news.time_ns}, {"parameters", parameters_.shown()}};
    time_ns_ = std::max(time_ns_, news.time_ns);
    firings_ = std::max(firings_, news.total_firings);
    if (news.marking) marking_ = *news.marking;
    if (!news.notices.is_null())
      for (const json& notice : news.notices.at("notices")) notices_.add(notice);
    if (!news.values.is_null()) values_.update(news.values.at("values"));
    if (!news.pose.is_null()) pose_ = news.pose;
    if (!news.scene.is_null()) scene_ = news.scene;
    if (!news.whole_poses.is_null()) poses_ = std::move(news.whole_poses);
    for (const PathPoint& point : news.path) path_.add(point);
    if (!news.subsystems.is_null()) subsystems_ = news.subsystems;
    const State now = news.paused ? State::paused : State::running;
    if (news.has_state && (now != state_ || news.rested) && !last) changed = now;
  }
  controllable_ = controllable_ || news.has_state;
  if (!parameters.is_null()) publish("parameters", std::move(parameters));
  if (!news.firings.is_null()) publish("firings", std::move(news.firings));
  if (!news.values.is_null()) publish("values", std::move(news.values));
  if (!news.notices.is_null()) publish("notices", std::move(news.notices));
  if (!news.arrays.is_null()) publish("arrays", std::move(news.arrays));
  if (!news.pose.is_null()) publish("pose", std::move(news.pose));
  if (!news.scene.is_null()) publish("scene", std::move(news.scene));
  if (!news.poses.is_null()) publish("poses", std::move(news.poses));
  if (!news.subsystems.is_null()) publish("subsystems", std::move(news.subsystems));
  if (changed) set_state(*changed, news.broke_at.empty() ? "" : "breakpoint: " + news.broke_at);
  return news.more;
}

json Run::info(bool all) const {
  const std::lock_guard lock(mutex_);
  json info{{"run", id_},  {"state", name_of(state_)},        {"kind", name_of(request_.kind)},
            {"why", why_}, {"net_hash", analysis_->net_hash}, {"t", time_ns_}};
  if (!all) return info;
  info["marking"] = marking_;
  info["firings"] = firings_;
  info["values"] = values_;
  info["parameters"] = parameters_.shown();
  info["notices"] = notices_.kept();
  info["panels"] = panels_of(*analysis_->model, request_);
  info["pose"] = pose_;
  info["path"] = rows_of(path_);
  info["scene"] = scene_;
  info["poses"] = poses_;
  info["verdicts"] = verdicts_;
  info["outcome"] = outcome_;
  info["subsystems"] = subsystems_;
  info["deployment"] = deployment_;
  info["track"] = request_.track.empty() ? json(nullptr) : json(request_.track);
  return info;
}

std::optional<Problem> Run::operate(const RunControl& wanted) {
  // A request of an operator must not take effect later.
  if (!link_.is_open()) return Problem{"the controller does not listen yet"};
  if (!wanted.inputs) operators_.let_go(wanted.path, wanted.who);
  std::optional<Problem> refused = link_.command(command::Panel{wanted.path, wanted.who, wanted.inputs});
  if (!refused && wanted.inputs) operators_.gave(wanted.input(), stamp_now());
  return refused;
}

std::optional<Problem> Run::control(const RunControl& wanted) {
  if (over()) return Problem{"the run is over"};
  if (wanted.command == "stop") {
    stop_ = true;
    return std::nullopt;
  }
  if (is_building()) return Problem{"the controller is still being made"};
  // Every controller takes values of parameters, also one on the steady clock.
  if (wanted.command == "set" && request_.kind != RunRequest::Kind::deployment)
    return link_.command(command::Set{wanted.path, wanted.text});
  if (wanted.command == "panel" && request_.kind != RunRequest::Kind::deployment) return operate(wanted);
  if (request_.kind == RunRequest::Kind::run) return Problem{"a controller in real time can only be stopped"};
  const bool attached = request_.kind == RunRequest::Kind::attach;
  if ((attached && !controllable_) || request_.kind == RunRequest::Kind::deployment)
    return Problem{"this controller can only be watched: it runs in real time"};
  const bool of_breakpoints = wanted.command == "breakpoints";
  const std::optional<ControlCommand> command =
      of_breakpoints ? breakpoints_of(wanted, *analysis_->net) : plain_command_of(wanted);
  if (!command)
    return Problem{of_breakpoints ? "the net has no such place or transition" : "there is no such command"};
  return link_.command(*command);
}

}  // namespace tessera::server
