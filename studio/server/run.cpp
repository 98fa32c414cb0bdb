#include "server/run.hpp"

#include <fmt/core.h>

#include <exception>
#include <fstream>
#include <utility>

#include "project/launch.hpp"
#include "project/listener.hpp"
#include "project/process.hpp"
#include "project/walk.hpp"
#include "server/follower.hpp"
#include "server/json_text.hpp"

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

json read_summary(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return stream ? json::parse(stream, nullptr, /*allow_exceptions=*/false) : json(nullptr);
}

}  // namespace

/// What is said while a controller is made, line by line to the browsers; the last lines are why it failed.
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

Run::Run(std::string id, RunRequest request, Place place, std::shared_ptr<const Analysis> analysis,
         std::mutex& building, Events& events)
    : id_(std::move(id)),
      request_(std::move(request)),
      place_(std::move(place)),
      analysis_(std::move(analysis)),
      building_(building),
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
    const std::optional<project::Controller> controller = make();
    if (controller) execute(*controller);
  } catch (const std::exception& error) {
    set_state(State::failed, error.what());
  }
}

std::optional<project::Controller> Run::make() {
  Teller teller(*this);
  set_state(State::building);
  const std::lock_guard lock(building_);
  if (stop_) {
    set_state(State::ended, "stopped");
    return std::nullopt;
  }
  teller.line("verifying, generating and compiling the controller");
  project::BuildOptions options;
  options.stop = &stop_;
  std::optional<project::Controller> controller = project::make_controller(place_.spec, options, teller);
  if (!controller && stop_)
    set_state(State::ended, "stopped");
  else if (!controller)
    set_state(State::failed, teller.error().empty() ? "the controller was not built" : teller.error());
  return controller;
}

void Run::execute(const project::Controller& controller) {
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
  options.folder = place_.folder.string();
  const bool has_world = controller.specification.model.simulation.has_value();
  project::Command command =
      project::controller_command(controller, options, request_.simulated ? "simulate" : "run",
                                  has_world && (request_.simulated || !request_.world.empty()));
  if (request_.simulated) {
    command.insert(command.end(), {"--controlled", fmt::format("--speed={}", request_.speed)});
    if (request_.paused) command.emplace_back("--paused");
  }
  set_state(request_.paused && request_.simulated ? State::paused : State::running);
  const project::Exit exit = project::capture_apart(
      command, stop_,
      [this](std::string_view line) {
        publish("log", {{"line", line}});
      },
      [this, &options](pid_t process) {
        follower_ = std::thread([this, process, folder = options.folder] { follow(process, folder); });
      });
  process_over_ = true;
  if (follower_.joinable()) follower_.join();
  json summary = read_summary(place_.folder / "summary.json");
  const bool failed = exit.code != 0 && !stop_ && exit.code != 130;
  const std::string why = summary.is_object() ? summary.value("ended", "") : exit.text;
  {
    const std::lock_guard lock(mutex_);
    outcome_ = summary.is_object() ? std::move(summary) : json(nullptr);
  }
  set_state(failed ? State::failed : State::ended, why);
}

void Run::follow(pid_t process, const std::filesystem::path& folder) {
  Follower follower(folder, *analysis_);
  bool connected = false;
  std::uint64_t pauses = 0;
  for (bool last = false;; last = process_over_) {
    if (request_.simulated && !connected) connected = link_.connect(analysis_->model->system, process);
    Follower::News news = follower.look(connected ? link_.snapshot() : std::nullopt);
    std::optional<State> changed;
    {
      const std::lock_guard lock(mutex_);
      time_ns_ = std::max(time_ns_, news.time_ns);
      if (news.marking) marking_ = *news.marking;
      if (!news.values.is_null()) values_ = news.values.at("values");
      if (!news.pose.is_null()) pose_ = news.pose;
      const State now = news.paused ? State::paused : State::running;
      // A step, or a breakpoint that comes soon, begins and ends between two snapshots.
      const bool rested_again = news.paused && news.pauses != std::exchange(pauses, news.pauses);
      if (news.has_state && (now != state_ || rested_again) && !last) changed = now;
    }
    if (!news.firings.is_null()) publish("firings", std::move(news.firings));
    if (!news.values.is_null()) publish("values", std::move(news.values));
    if (!news.pose.is_null()) publish("pose", std::move(news.pose));
    if (changed) set_state(*changed, news.broke_at.empty() ? "" : "breakpoint: " + news.broke_at);
    if (last && !news.more) break;
    if (!news.more) follower.rest();
  }
  link_.close();
}

json Run::info(bool all) const {
  const std::lock_guard lock(mutex_);
  json info{
      {"run", id_},  {"state", name_of(state_)},        {"kind", request_.simulated ? "simulate" : "run"},
      {"why", why_}, {"net_hash", analysis_->net_hash}, {"t", time_ns_}};
  if (!all) return info;
  info["marking"] = marking_;
  info["values"] = values_;
  info["pose"] = pose_;
  info["verdicts"] = verdicts_;
  info["outcome"] = outcome_;
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
  if (!request_.simulated) return "a controller in real time can only be stopped";
  if (is_building()) return "the controller is still being made";
  if (what == "breakpoints") {
    json places = json::array();
    for (const std::uint32_t place : command.value("places", std::vector<std::uint32_t>{})) {
      if (place >= analysis_->net->places().size()) return "the net has no such place";
      places.push_back(analysis_->net->places()[place].name);
    }
    command["places"] = places;
  }
  return link_.command(std::move(command));
}

}  // namespace tessera::server
