#include "server/runs/deployment_follower.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "project/meeting_place.hpp"
#include "project/process/waiting_chains.hpp"
#include "server/recordings/marking_tracker.hpp"
#include "server/recordings/recording_stream.hpp"
#include "server/runs/or_null.hpp"
#include "tessera/monitor.hpp"

namespace tessera::server {

using nlohmann::json;
using project::WatchedProcess;

namespace {

constexpr auto between_reads = std::chrono::milliseconds(30);
constexpr auto between_joint_markings = std::chrono::milliseconds(500);
constexpr auto between_reports = std::chrono::milliseconds(500);
constexpr auto between_behaviours = std::chrono::milliseconds(200);
constexpr std::size_t most_joint_firings = 2000, most_chains = 200, most_links = 2000;

double seconds_since(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - time).count();
}

}  // namespace

DeploymentFollower::DeploymentFollower(const Analysis& analysis, Reached& reached,
                                       project::OpenFeed open_feed)
    : analysis_(analysis),
      reached_(reached),
      watch_(monitor_folder(), analysis.model->system, analysis.net_hash),
      initial_(MarkingTracker(*analysis.net).marked()),
      seen_(Clock::now()) {
  if (open_feed)
    watch_.watch_network(std::move(open_feed),
                         project::meeting_place(*analysis.model->deployment, {}, project::machine_name()));
}

DeploymentFollower::News DeploymentFollower::poll() {
  watch_.poll(std::chrono::milliseconds(15));
  News news;
  const std::vector<const WatchedProcess*> all = watch_.processes();
  if (std::ranges::any_of(all, [](const auto* one) { return one->is_there(); })) {
    seen_ = Clock::now();
    any_ = true;
  }
  follow_new_ones();
  if (Clock::now() - read_ >= between_reads) {
    read_ = Clock::now();
    read_recordings(news);
  }
  if (!all.empty() && Clock::now() - subsystems_told_ >= between_behaviours) {
    subsystems_told_ = Clock::now();
    news.subsystems = subsystems();
  }
  if (!all.empty() && Clock::now() - told_ >= between_reports) {
    told_ = Clock::now();
    news.deployment = {{"t", time_ns_},
                       {"network", watch_.watches_network()},
                       {"remark", watch_.remark()},
                       {"processes", processes()},
                       {"links", links()},
                       {"waits", waits()}};
  }
  news.time_ns = time_ns_;
  return news;
}

/// Processes of other machines are found within 5 s or so.
bool DeploymentFollower::is_going_on() const {
  return Clock::now() - seen_ < std::chrono::seconds(any_ ? 5 : 7);
}

std::string DeploymentFollower::why_nothing() const {
  return watch_.of_another_net() > 0
             ? fmt::format("processes of {} run, but with another net than the specification here",
                           analysis_.model->system)
             : fmt::format("no process of {} runs on this machine in real time as this user{}{}{}",
                           analysis_.model->system, watch_.watches_network() ? ", and none is heard" : "",
                           watch_.remark().empty() ? "" : ": ", watch_.remark());
}

void DeploymentFollower::follow_new_ones() {
  std::set<std::string> there;
  for (const WatchedProcess* one : watch_.processes()) {
    there.insert(one->socket);
    if (followed_.contains(one->socket) || one->snapshot.net_hash.empty()) continue;
    const auto began = one->heard - std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(one->snapshot.time_s));
    if (!first_began_) first_began_ = began;
    Followed& followed = followed_[one->socket];
    followed.behind_ns = std::chrono::nanoseconds(began - *first_began_).count();
    followed.marked = initial_;
    std::error_code missing;
    const std::filesystem::path file = one->snapshot.recording.value_or("");
    if (one->is_local && std::filesystem::exists(file, missing))
      followed.recording = std::make_unique<RunFollower>(
          RecordingStream::of_file(file, GrowingRecording::From::newest), analysis_, &reached_);
  }
  // Another start has replaced it.
  for (auto at = followed_.begin(); at != followed_.end();) {
    if (there.contains(at->first)) {
      ++at;
      continue;
    }
    gone_firings_ += at->second.firings;
    at = followed_.erase(at);
  }
}

void DeploymentFollower::read_recordings(News& news) {
  std::vector<std::pair<std::int64_t, std::uint32_t>> fired;
  std::uint64_t dropped = 0;
  json values = json::object();
  for (auto& [socket, one] : followed_) {
    if (one.recording == nullptr) continue;
    RunFollower::News own = one.recording->poll(std::nullopt, /*last=*/false);
    if (own.marking) one.marked = std::move(*own.marking);
    one.firings = std::max(one.firings, own.total_firings);
    const auto here = [&, behind = one.behind_ns](std::int64_t time) {
      const std::int64_t moved = std::max<std::int64_t>(time + behind, 0);
      time_ns_ = std::max(time_ns_, moved);
      return moved;
    };
    if (own.time_ns > 0) static_cast<void>(here(own.time_ns));
    if (!own.values.is_null()) values.update(own.values.at("values"));
    if (own.firings.is_null()) continue;
    dropped += own.firings.at("dropped").get<std::uint64_t>();
    for (const json& firing : own.firings.at("firings"))
      fired.emplace_back(here(firing.at(0).get<std::int64_t>()), firing.at(1).get<std::uint32_t>());
  }
  news.total_firings = gone_firings_;
  for (const auto& [socket, one] : followed_) news.total_firings += one.firings;
  if (!values.empty()) news.values = {{"t", time_ns_}, {"values", std::move(values)}};
  if (fired.empty() && dropped == 0) return;
  std::ranges::stable_sort(fired, {}, &std::pair<std::int64_t, std::uint32_t>::first);
  if (fired.size() > most_joint_firings) {
    const std::size_t more = fired.size() - most_joint_firings;
    fired.erase(fired.begin(), fired.begin() + static_cast<std::ptrdiff_t>(more));
    dropped += more;
  }
  news.firings = {
      {"t", time_ns_}, {"dropped", dropped}, {"total", news.total_firings}, {"firings", std::move(fired)}};
  if (dropped == 0 && Clock::now() - marking_told_ < between_joint_markings) return;
  marking_told_ = Clock::now();
  news.marking = joint_marking();
  news.firings["marking"] = *news.marking;
}

/// Each process changes the marking from the initial one by its firings; the order of these changes does not
/// matter. The transitions of the network between them are not recorded: for a place of a channel between
/// processes, the marking is that of one end.
std::vector<std::uint32_t> DeploymentFollower::joint_marking() const {
  std::map<std::uint32_t, std::size_t> holds;
  std::size_t followed = 0;
  for (const auto& [socket, one] : followed_) {
    if (one.recording == nullptr) continue;
    ++followed;
    for (const std::uint32_t place : one.marked) ++holds[place];
  }
  std::vector<std::uint32_t> marked;
  for (const auto& [place, count] : holds)
    if (count == followed || !std::ranges::binary_search(initial_, place)) marked.push_back(place);
  return marked;
}

json DeploymentFollower::subsystems() const {
  json event{{"t", time_ns_}, {"subsystems", json::array()}, {"channels", json::array()}};
  for (const WatchedProcess* one : watch_.processes())
    if (one->is_there()) add_subsystems(one->snapshot, event);
  return event;
}

json DeploymentFollower::processes() const {
  json all = json::array();
  for (const spec::Process& process : analysis_.model->deployment->processes) {
    json agents = json::array();
    for (const spec::AgentId agent : process.agents) agents.push_back(analysis_.model->agents[agent].path);
    json one{{"name", process.name}, {"agents", std::move(agents)}, {"state", "absent"},
             {"since_s", nullptr},   {"host", process.host},        {"pid", nullptr},
             {"time_s", nullptr},    {"emergency", nullptr},        {"overruns", 0},
             {"errors", 0},          {"followed", false},           {"by_network", false},
             {"left_out", 0},        {"subsystems", json::array()}};
    if (const WatchedProcess* seen = watch_.find(process.name); seen != nullptr) {
      const Snapshot& now = seen->snapshot;
      std::uint64_t overruns = 0, errors = 0;
      for (const Snapshot::Subsystem& subsystem : now.subsystems) {
        overruns += subsystem.overruns;
        errors += subsystem.errors;
        one["subsystems"].push_back(
            {{"path", subsystem.path},
             {"behaviour", subsystem.behaviour ? json(*subsystem.behaviour) : json(nullptr)},
             {"ended", subsystem.ended}});
      }
      one["state"] = name_of(seen->state);
      if (seen->since) one["since_s"] = seconds_since(*seen->since);
      one["host"] = now.host;
      one["pid"] = now.pid;
      one["time_s"] = now.time_s;
      if (now.emergency) one["emergency"] = *now.emergency;
      one["overruns"] = overruns;
      one["errors"] = errors;
      one["by_network"] = seen->by_network;
      one["left_out"] = now.left_out;
      const auto followed = followed_.find(seen->socket);
      one["followed"] = followed != followed_.end() && followed->second.recording != nullptr;
    }
    all.push_back(std::move(one));
  }
  return all;
}

json DeploymentFollower::links() const {
  json all = json::array();
  for (const WatchedProcess* one : watch_.processes()) {
    if (one->state != WatchedProcess::State::running) continue;  // what it knew is old
    const Snapshot& now = one->snapshot;
    for (const Snapshot::Link& link : now.links) {
      if (all.size() >= most_links) return all;
      all.push_back({{"process", one->name()},
                     {"peer", link.process},
                     {"reachable", link.reachable},
                     {"for_s", now.time_s - link.since_s},
                     {"heard_s", link.heard_s ? json(now.time_s - *link.heard_s) : json(nullptr)},
                     {"signs", link.signs},
                     {"signs_lost", link.signs_lost},
                     {"sent", link.sent},
                     {"repeated", link.repeated},
                     {"received", link.received},
                     {"duplicates", link.duplicates},
                     {"clock_ahead_s", or_null(link.clock_ahead_s)},
                     {"clock_uncertainty_s", link.clock_uncertainty_s}});
    }
  }
  return all;
}

json DeploymentFollower::waits() const {
  json all = json::array();
  for (const project::WaitingChain& chain : project::waiting_chains(watch_)) {
    if (all.size() >= most_chains) break;
    json steps = json::array();
    for (const project::WaitingStep& step : chain.steps)
      steps.push_back({{"subsystem", step.subsystem},
                       {"process", step.process},
                       {"waits_for", step.waits_for},
                       {"other_process", step.other_process},
                       {"channel", step.channel},
                       {"text", step.text()}});
    all.push_back({{"steps", std::move(steps)}, {"end", chain.end}});
  }
  return all;
}

}  // namespace tessera::server
