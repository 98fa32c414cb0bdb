#include "server/runs/sweeps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <utility>

#include "project/files/files.hpp"
#include "project/files/run_folder.hpp"
#include "project/files/state_folder.hpp"
#include "project/launch.hpp"
#include "project/process/death.hpp"
#include "project/process/listener.hpp"
#include "server/http/json_text.hpp"
#include "server/runs/run_parameters.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::int64_t now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

/// All files of the project, with size and date: a run may read any of them.
std::string state_of_files(const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code problem;
  for (fs::recursive_directory_iterator entry(folder, problem), last; !problem && entry != last;
       entry.increment(problem)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(".")) {
      entry.disable_recursion_pending();
      continue;
    }
    std::error_code gone;
    if (!entry->is_regular_file(gone)) continue;
    const auto changed = fs::last_write_time(entry->path(), gone).time_since_epoch().count();
    found.push_back(
        fmt::format("{} {} {}\n", entry->path().string(), fs::file_size(entry->path(), gone), changed));
    constexpr std::size_t most = 5000;
    // So many are not compared: nothing is taken from an earlier sweep.
    if (found.size() > most) return fmt::format("at {} ms", now_ms());
  }
  std::ranges::sort(found);
  std::string all;
  for (const std::string& one : found) all += one;
  return all;
}

/// The command without an option and its value.
void leave_out(project::Command& command, std::string_view option) {
  const auto found = std::ranges::find(command, option);
  if (found != command.end()) command.erase(found, found + 2);
}

void forget_old_files(const fs::path& folder) {
  constexpr std::size_t most = 100;
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::error_code problem;
  for (fs::directory_iterator entry(folder, problem), last; !problem && entry != last;
       entry.increment(problem))
    if (entry->path().extension() == ".jsonl" && entry->is_regular_file(problem))
      files.emplace_back(entry->last_write_time(problem), entry->path());
  std::ranges::sort(files);
  for (std::size_t at = 0; at + most < files.size(); ++at) fs::remove(files[at].second, problem);
}

}  // namespace

class Sweeps::BuildListener final : public project::Listener {
 public:
  BuildListener(Sweeps& sweeps, std::uint64_t id, Job& job) : sweeps_(sweeps), id_(id), job_(job) {}
  void say(std::string_view text) override {
    if (text.find("error") != std::string_view::npos && error_.empty()) error_ = text;
  }
  void progress(std::string_view what) override {
    {
      const std::lock_guard lock(sweeps_.mutex_);
      job_.line = what;
    }
    sweeps_.tell(id_, job_);
  }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  Sweeps& sweeps_;
  std::uint64_t id_;
  Job& job_;
  std::string error_;
};

/// The data that the processes of a sweep share.
struct Sweeps::Work {
  struct Task {
    std::string value;
    std::uint64_t seed = 0;
  };
  project::Command command;  ///< of all runs, without value, seed and summary
  fs::path folder;
  std::mutex mutex;  ///< guards what follows
  std::deque<Task> tasks;
  SweepFile file;
};

Sweeps::~Sweeps() {
  for (auto& [id, job] : jobs_) job->stop = true;
  for (auto& [id, job] : jobs_) job->thread.join();
}

unsigned Sweeps::processes() {
  constexpr unsigned most = 16;
  return std::clamp(std::thread::hardware_concurrency(), 2U, most + 1) - 1;
}

Sweeps::Started Sweeps::start(SweepRequest request) {
  const SpecFile::Content content = file_.read();
  const std::shared_ptr<const Analysis> analysis = analyses_.of(content.text);
  if (!content.error.empty() || !analysis->net || !analysis->model)
    return {0, 422, "the file on disk has errors, so there is nothing to run", "save a text without errors"};
  if (std::string wrong = wrong_with_sweep(*analysis->model, request); !wrong.empty())
    return {0, 422, wrong, ""};
  const std::lock_guard lock(mutex_);
  for (const auto& [id, job] : jobs_)
    if (job->state == "building" || job->state == "running")
      return {0, 429, "a sweep goes on already", "wait for it or stop it"};
  while (jobs_.size() >= most_kept) {
    jobs_.begin()->second->thread.join();
    jobs_.erase(jobs_.begin());
  }
  const std::uint64_t id = ++last_;
  Job& job = *(jobs_[id] = std::make_unique<Job>(std::move(request)));
  job.thread = std::thread([this, id, &job] { run(id, job); });
  return {id, 202, {}, {}};
}

void Sweeps::run(std::uint64_t id, Job& job) {
  try {
    BuildListener teller(*this, id, job);
    project::LaunchOptions launch;
    launch.spec = file_.path().string();
    if (!project::every_real_buffer_has_driver(launch, /*simulated=*/true, teller))
      return end(id, job, "failed", teller.error());
    project::BuildOptions options;
    options.stop = &job.stop;
    std::optional<project::Controller> controller = project::make_controller(file_.path(), options, teller);
    if (!controller && job.stop) return end(id, job, "stopped", "");
    if (!controller)
      return end(id, job, "failed", teller.error().empty() ? "the controller was not built" : teller.error());
    execute(id, job, std::move(*controller));
  } catch (const std::exception& error) {
    end(id, job, "failed", error.what());
  } catch (...) {
    end(id, job, "failed", "a library failed without saying why");
  }
}

void Sweeps::execute(std::uint64_t id, Job& job, project::Controller controller) {
  const SweepRequest& request = job.request;
  const fs::path& home = controller.specification.project;
  const std::string identity =
      project::hash_of(project::content_of(controller.program) +
                       controller.specification.diagnostics.whole_text() + state_of_files(home) + "\n" +
                       request.parameter + "\n" + request.duration + (request.interleave ? "i" : ""));
  BuildListener teller(*this, id, job);
  const fs::path state = project::state_folder(home);
  const project::RunFolder folder(state, "sweep", project::RunFolder::Shown::no, teller);
  controller.program = folder.own_copy_of(controller.program);
  project::LaunchOptions options;
  options.duration = request.duration;
  options.base = home;
  options.folder = folder.path().string();
  Work all{project::controller_command(controller, options, "simulate", /*simulated=*/true),
           folder.path(),
           {},
           {},
           SweepFile(state / "sweeps" / (identity + ".jsonl"))};
  for (const char* option : {"--record", "--record-values", "--record-limit", "--summary", "--seed"})
    leave_out(all.command, option);
  if (request.interleave) all.command.emplace_back("--interleave");
  {
    const std::lock_guard lock(mutex_);
    job.state = "running";
    job.line.clear();
  }
  const std::vector<std::string> values =
      request.parameter.empty() ? std::vector<std::string>{""} : request.values;
  // All values with the first seed come first: the whole curve appears early.
  for (std::uint64_t at = 0; at < request.runs; ++at)
    for (const std::string& value : values) {
      const SweepRow* known = all.file.find(value, request.seed + at);
      if (known != nullptr)
        add(id, job, *known, /*reused=*/true);
      else
        all.tasks.push_back({value, request.seed + at});
    }
  tell(id, job);
  std::vector<std::thread> workers;
  for (unsigned process = 0; process < std::min<std::size_t>(processes(), all.tasks.size()); ++process)
    workers.emplace_back([this, id, &job, &all, process] { work(id, job, all, process); });
  for (std::thread& worker : workers) worker.join();
  forget_old_files(state / "sweeps");
  folder.withdraw();
  std::error_code ignored;
  fs::remove(folder.path(), ignored);
  bool lacks_some = false;
  {
    const std::lock_guard lock(mutex_);
    lacks_some = job.rows.size() < values.size() * request.runs;
  }
  end(id, job, job.stop && lacks_some ? "stopped" : "done", "");
}

void Sweeps::work(std::uint64_t id, Job& job, Work& all, unsigned process) {
  const fs::path summary = all.folder / fmt::format("process-{}.json", process);
  const fs::path note = all.folder / fmt::format("process-{}.txt", process);
  while (!job.stop) {
    Work::Task task;
    {
      const std::lock_guard lock(all.mutex);
      if (all.tasks.empty()) return;
      task = std::move(all.tasks.front());
      all.tasks.pop_front();
    }
    project::Command command = all.command;
    command.insert(command.end(), {"--seed", std::to_string(task.seed), "--summary", summary.string()});
    if (!job.request.parameter.empty())
      command.insert(command.end(), {"--set", job.request.parameter + "=" + task.value});
    std::error_code ignored;
    fs::remove(summary, ignored);
    SweepRow row;
    try {
      const project::Exit exit = project::capture_apart(project::with_death_note(command, note), job.stop);
      if (job.stop) return;  // it was cut off
      const json text = json::parse(project::content_of(summary), nullptr, /*allow_exceptions=*/false);
      if (text.is_object()) {
        row = SweepRow::of_summary(text);
      } else {
        const std::string death = project::describe_death(exit, note);
        row.failed = true;
        row.ended = !death.empty() ? death : exit.text.substr(0, 500);
        row.numbers["failed"] = 1;
      }
    } catch (const std::exception& error) {
      row.failed = true;
      row.ended = error.what();
      row.numbers["failed"] = 1;
    }
    row.value = task.value;
    row.seed = task.seed;
    {
      const std::lock_guard lock(all.mutex);
      all.file.add(row);
    }
    add(id, job, std::move(row), /*reused=*/false);
  }
}

void Sweeps::add(std::uint64_t id, Job& job, SweepRow row, bool reused) {
  constexpr std::int64_t between_ms = 200;
  bool due = false;
  {
    const std::lock_guard lock(mutex_);
    job.rows.push_back(std::move(row));
    job.reused += reused ? 1 : 0;
    due = !reused && now_ms() - job.told_at_ms >= between_ms;
  }
  if (due) tell(id, job);
}

void Sweeps::end(std::uint64_t id, Job& job, const std::string& state, const std::string& why) {
  // At once, since the thread of a job that has ended needs the lock no more: start() waits for it.
  const std::lock_guard lock(mutex_);
  job.state = state;
  job.why = why;
  job.line.clear();
  publish(id, job);
}

json Sweeps::facts(std::uint64_t id, const Job& job) const {
  const SweepRequest& request = job.request;
  return {{"sweep", std::to_string(id)},
          {"state", job.state},
          {"why", job.why},
          {"line", job.line},
          {"parameter", request.parameter},
          {"values", request.values},
          {"runs", request.runs},
          {"seed", request.seed},
          {"for", request.duration},
          {"interleave", request.interleave},
          {"done", job.rows.size()},
          {"of", std::max<std::size_t>(1, request.values.size()) * request.runs},
          {"reused", job.reused}};
}

void Sweeps::tell(std::uint64_t id, Job& job) {
  const std::lock_guard lock(mutex_);
  publish(id, job);
}

void Sweeps::publish(std::uint64_t id, Job& job) {
  constexpr std::size_t most_rows = 1000;
  do {
    json event = facts(id, job);
    const std::size_t end = std::min(job.rows.size(), job.told + most_rows);
    event["from"] = job.told;
    event["rows"] = json::array();
    for (; job.told < end; ++job.told) event["rows"].push_back(job.rows[job.told].shown());
    events_.publish("sweep", text_of(event));
  } while (job.told < job.rows.size());
  job.told_at_ms = now_ms();
}

json Sweeps::list() const {
  json all{{"parameters", json::array()}, {"processes", processes()}, {"sweeps", json::array()}};
  const std::shared_ptr<const Analysis> analysis = analyses_.of(file_.read().text);
  if (analysis->model) all["parameters"] = RunParameters(*analysis->model).shown();
  const std::lock_guard lock(mutex_);
  for (const auto& [id, job] : jobs_) all["sweeps"].push_back(facts(id, *job));
  return all;
}

std::optional<json> Sweeps::info(std::uint64_t sweep) const {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(sweep);
  if (found == jobs_.end()) return std::nullopt;
  json info = facts(sweep, *found->second);
  info["from"] = 0;
  info["rows"] = json::array();
  for (const SweepRow& row : found->second->rows) info["rows"].push_back(row.shown());
  return info;
}

bool Sweeps::stop(std::uint64_t sweep) {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(sweep);
  if (found == jobs_.end()) return false;
  found->second->stop = true;
  return true;
}

}  // namespace tessera::server
