#include "server/analysis/verify_jobs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "diagnostics/diagnostics.hpp"
#include "layers/layers.hpp"
#include "project/verification/run_files.hpp"
#include "project/verification/violation.hpp"
#include "server/http/json_text.hpp"
#include "tessera/nearest.hpp"
#include "verify/verify.hpp"

namespace tessera::server {

namespace {

using nlohmann::json;

/// The result of `tessera verify --json`. A property with a run also has the indices of its transitions
/// (those beyond the net's stand for "no initial condition holds") and the run in words.
json result_json(const Analysis& analysis, const verify::Report& report) {
  json result = project::report_json(*analysis.net, &*analysis.pages, report);
  for (std::size_t index = 0; index < report.properties.size(); ++index) {
    const verify::PropertyResult& property = report.properties[index];
    json& one = result["properties"][index];
    one["at_end"] = project::at_end_json(property.waits);
    one["steps"] = nullptr;
    one["narrative"] = nullptr;
    if (!property.has_trace) continue;
    one["steps"] = json::array();
    for (const net::TransitionId id : property.trace) one["steps"].push_back(id.value);
    one["narrative"] = project::story_json(project::net_of_run(*analysis.net, property), property.trace,
                                           verify::Wording::plain);
  }
  return result;
}

}  // namespace

VerifyJobs::~VerifyJobs() {
  for (auto& [id, job] : jobs_) job->stop = true;
  for (auto& [id, job] : jobs_) job->thread.join();
}

VerifyJobs::Started VerifyJobs::start(Request request) {
  const std::shared_ptr<const Analysis> analysis = analyses_.of(request.text);
  if (!analysis->net) return {0, 422, "a specification with errors has no net to verify", ""};
  std::vector<std::string> names = verify::default_properties_of(*analysis->net);
  for (const net::Property& property : analysis->properties) names.push_back(property.name);
  for (const std::string& name : request.properties)
    if (std::ranges::find(names, name) == names.end())
      return {0, 422, "there is no property '" + name + "'", did_you_mean(name, names).text};
  const std::lock_guard lock(mutex_);
  if (std::ranges::count_if(jobs_, [](const auto& job) { return !job.second->done; }) >=
      static_cast<std::ptrdiff_t>(most_running))
    return {0, 429, "too much is being verified already", "wait for it or stop it"};
  forget_old();
  const std::uint64_t id = ++last_;
  Job& job = *(jobs_[id] = std::make_unique<Job>());
  job.thread = std::thread(
      [this, id, &job, analysis, request = std::move(request)] { run(id, job, *analysis, request); });
  return {id, 202, {}, {}};
}

void VerifyJobs::run(std::uint64_t id, Job& job, const Analysis& analysis, const Request& request) {
  using Clock = std::chrono::steady_clock;
  events_.publish("verify", fmt::format(R"({{"job":"{}","state":"running"}})", id));
  std::string result = "null";
  try {
    const std::vector<net::Invariant> invariants =
        layers::invariants(*analysis.model, *analysis.pages, *analysis.net);
    verify::ProveOptions how;
    how.time = std::chrono::duration<double>(request.seconds);
    how.only = request.properties;
    how.stop = &job.stop;
    Clock::time_point told{};
    how.progress = [&](const std::string& property, const explore::Progress& progress) {
      if (Clock::now() - told < std::chrono::milliseconds(100)) return;
      told = Clock::now();
      events_.publish("verify", text_of(json{{"job", std::to_string(id)},
                                             {"state", "running"},
                                             {"property", property},
                                             {"states", progress.markings},
                                             {"rate", progress.markings_per_second}}));
    };
    const verify::Report report =
        verify::prove({*analysis.net, &*analysis.pages, invariants, analysis.properties}, how);
    result = text_of(result_json(analysis, report));
  } catch (const std::exception& error) {
    result = text_of(json{{"error", error.what()}});
  } catch (...) {
    result = text_of(json{{"error", "the verification failed without saying why"}});
  }
  const std::lock_guard lock(mutex_);
  job.result = std::move(result);
  job.done = true;
  events_.publish("verify", fmt::format(R"({{"job":"{}","state":"{}","result":{}}})", id,
                                        job.stop ? "stopped" : "done", job.result));
}

std::optional<std::string> VerifyJobs::state(std::uint64_t id) const {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return std::nullopt;
  const Job& job = *found->second;
  if (!job.done) return fmt::format(R"({{"job":"{}","state":"running","result":null}})", id);
  return fmt::format(R"({{"job":"{}","state":"{}","result":{}}})", id, job.stop ? "stopped" : "done",
                     job.result);
}

bool VerifyJobs::stop(std::uint64_t id) {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return false;
  if (!found->second->done) found->second->stop = true;
  return true;
}

void VerifyJobs::forget_old() {
  for (auto job = jobs_.begin(); job != jobs_.end() && jobs_.size() >= most_kept;) {
    if (!job->second->done) {
      ++job;
      continue;
    }
    job->second->thread.join();
    job = jobs_.erase(job);
  }
}

}  // namespace tessera::server
