#include "server/runs/run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <utility>

#include "project/files/run_folder.hpp"
#include "project/files/state_folder.hpp"
#include "project/launch.hpp"
#include "project/process/death.hpp"
#include "project/process/listener.hpp"
#include "project/process/process.hpp"
#include "project/verification/pipeline.hpp"
#include "server/http/json_text.hpp"
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
  }
  return "";
}

/// Replaces indices by names; false: there is no such element.
template <class Elements>
bool to_names(json& list, const Elements& elements) {
  for (json& one : list) {
    if (one.get<std::size_t>() >= elements.size()) return false;
    one = elements[one.get<std::size_t>()].name;
  }
  return true;
}

json read_summary(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return stream ? json::parse(stream, nullptr, /*allow_exceptions=*/false) : json(nullptr);
}

}  // namespace

/// Passes the messages while a controller is made to the browsers, line by line. The last lines
/// are the reason if it fails.
class Run::Teller final : public project::Listener {
 public:
  explicit Teller(const Run& run) : run_(run) {}
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
      events_(events) {
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
  }
  publish("run", std::move(told));
}

void Run::make_and_run() {
  try {
    if (request_.kind == RunRequest::Kind::attach) return attach();
    std::optional<project::Controller> controller = make();
    if (controller) execute(std::move(*controller));
  } catch (const std::exception& error) {
    set_state(State::failed, error.what());
  } catch (...) {  // from a library: MuJoCo's is no std::exception
    set_state(State::failed, "a library failed without saying why");
  }
}

std::optional<project::Controller> Run::make() {
  Teller teller(*this);
  set_state(State::building);
  project::LaunchOptions launch;
  launch.spec = spec_.string();
  const bool simulated = request_.kind == RunRequest::Kind::simulate || !request_.world.empty();
  if (!project::drivers_are_there(launch, simulated, teller)) {
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
  Teller teller(*this);
  const project::RunFolder folder(project::state_folder(controller.specification.project),
                                  name_of(request_.kind), project::RunFolder::Shown::as_last, teller);
  controller.program = folder.own(controller.program);
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
  options.base = controller.specification.project;
  options.folder = folder.path().string();
  const bool simulated = request_.kind == RunRequest::Kind::simulate;
  project::Command command = project::controller_command(controller, options, name_of(request_.kind),
                                                         simulated || !request_.world.empty());
  if (simulated) {
    command.insert(command.end(), {"--controlled", fmt::format("--speed={}", request_.speed)});
    if (request_.paused) command.emplace_back("--paused");
  }
  set_state(request_.paused && simulated ? State::paused : State::running);
  const std::filesystem::path note = folder.path() / "death.txt";
  const project::Exit exit = project::capture_apart(
      project::attended(command, note), stop_,
      [this](std::string_view line) {
        publish("log", {{"line", line}});
      },
      [this, &options](pid_t process) {
        const std::filesystem::path socket = std::filesystem::path(monitor_folder()) /
                                             fmt::format("{}.{}.sock", analysis_->model->system, process);
        follower_ = std::thread([this, socket, folder = options.folder] { follow(socket, folder); });
      });
  process_over_ = true;
  if (follower_.joinable()) follower_.join();
  json summary = read_summary(folder.path() / "summary.json");
  const bool failed = exit.code != 0 && !stop_ && exit.code != 130;
  std::string why = stop_ ? "stopped" : summary.is_object() ? summary.value("ended", "") : exit.text;
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
  Follower follower(RecordingStream::of_file(folder / "recording.tsr", GrowingRecording::From::newest),
                    folder / "path.csv", *analysis_);
  bool connected = false;
  for (bool last = false;; last = process_over_) {
    if (!connected) connected = link_.connect(socket, /*own=*/request_.kind == RunRequest::Kind::simulate);
    const bool more = tell(follower, connected ? link_.snapshot() : std::nullopt, last);
    if (last && !more) break;
    if (!more) Follower::rest();
  }
  link_.close();
}

/// true: more can be sent at once.
bool Run::tell(Follower& follower, std::optional<json> snapshot, bool last) {
  Follower::News news = follower.look(std::move(snapshot), last);
  std::optional<State> changed;
  {
    const std::lock_guard lock(mutex_);
    time_ns_ = std::max(time_ns_, news.time_ns);
    if (news.marking) marking_ = *news.marking;
    if (!news.values.is_null()) values_.update(news.values.at("values"));
    if (!news.pose.is_null()) pose_ = news.pose;
    for (const PathPoint& point : news.path) path_.add(point);
    if (!news.subsystems.is_null()) subsystems_ = news.subsystems;
    const State now = news.paused ? State::paused : State::running;
    if (news.has_state && (now != state_ || news.rested) && !last) changed = now;
  }
  controllable_ = controllable_ || news.has_state;
  if (!news.firings.is_null()) publish("firings", std::move(news.firings));
  if (!news.values.is_null()) publish("values", std::move(news.values));
  if (!news.pose.is_null()) publish("pose", std::move(news.pose));
  if (!news.subsystems.is_null()) publish("subsystems", std::move(news.subsystems));
  if (changed) set_state(*changed, news.broke_at.empty() ? "" : "breakpoint: " + news.broke_at);
  return news.more;
}

/// The reason why the running controller cannot be shown on this net; empty: it can.
std::string Run::refused(const json& snapshot) const {
  if (snapshot.value("net_hash", "") == analysis_->net_hash) return {};
  return fmt::format("the controller runs another net (of the system {}) than the specification here",
                     snapshot.value("system", "?"));
}

/// The controller's recording if it is a file within the project; otherwise an empty path. The end of a
/// tunnel names a file of another machine; this machine may have an old file with that name.
std::filesystem::path Run::readable(const json& snapshot) {
  std::error_code missing;
  const std::filesystem::path file = std::filesystem::canonical(snapshot.value("recording", ""), missing);
  const std::filesystem::path folder = spec_.parent_path();
  const auto [end, ignored] = std::ranges::mismatch(folder, file);
  const bool within = !missing && end == folder.end();
  return within && link_.is_process(snapshot.value("pid", std::int64_t{-1})) ? file : std::filesystem::path();
}

void Run::attach() {
  if (!link_.connect(std::filesystem::path(monitor_folder()) / request_.socket, /*own=*/false))
    return set_state(State::failed, "nobody listens at " + request_.socket);
  std::optional<json> snapshot;
  while (!snapshot && !stop_ && !link_.is_over()) {
    snapshot = link_.snapshot();
    if (!snapshot) Follower::rest();
  }
  if (!snapshot) return set_state(State::ended, "it has ended");
  if (const std::string why = refused(*snapshot); !why.empty()) return set_state(State::failed, why);
  const std::filesystem::path file = readable(*snapshot);
  Follower follower(file.empty() ? [this] { return link_.recording(); }
                                 : RecordingStream::of_file(file, GrowingRecording::From::newest),
                    file.empty() ? file : file.parent_path() / "path.csv", *analysis_);
  set_state(State::running);
  while (!stop_ && !link_.is_over()) {
    if (!tell(follower, std::exchange(snapshot, std::nullopt), /*last=*/false)) Follower::rest();
    snapshot = link_.snapshot();
  }
  while (!stop_ && tell(follower, std::exchange(snapshot, std::nullopt), /*last=*/true)) continue;
  link_.close();
  if (stop_ || link_.has_ended())
    return set_state(State::ended, stop_ ? "let go; it runs on" : "it has ended");
  set_state(State::failed, "the connection to the controller is lost; it may still be running");
}

json Run::info(bool all) const {
  const std::lock_guard lock(mutex_);
  json info{{"run", id_},  {"state", name_of(state_)},        {"kind", name_of(request_.kind)},
            {"why", why_}, {"net_hash", analysis_->net_hash}, {"t", time_ns_}};
  if (!all) return info;
  info["marking"] = marking_;
  info["values"] = values_;
  info["pose"] = pose_;
  info["path"] = path_.rows();
  info["verdicts"] = verdicts_;
  info["outcome"] = outcome_;
  info["subsystems"] = subsystems_;
  info["track"] = request_.track.empty() ? json(nullptr) : json(request_.track);
  return info;
}

std::string Run::control(json command) {
  const std::string what = command.value("command", "");
  if (over()) return "the run is over";
  if (what == "stop") {
    stop_ = true;
    return {};
  }
  if (request_.kind == RunRequest::Kind::run) return "a controller in real time can only be stopped";
  if (is_building()) return "the controller is still being made";
  if (request_.kind == RunRequest::Kind::attach && !controllable_)
    return "this controller can only be watched: it runs in real time";
  if (what == "breakpoints") {
    const bool known = to_names(command["places"], analysis_->net->places()) &&
                       to_names(command["transitions"], analysis_->net->transitions()) &&
                       to_names(command["conditions"], analysis_->net->transitions());
    if (!known) return "the net has no such place or transition";
  }
  return link_.command(std::move(command));
}

}  // namespace tessera::server
