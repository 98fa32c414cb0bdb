#include "server/runs/runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace tessera::server {

Runs::Started Runs::start(RunRequest request) {
  const SpecFile::Content content = file_.read();
  std::shared_ptr<const Analysis> analysis = analyses_.of(content.text);
  if (!content.error.empty() || !analysis->net)
    return {{}, 422, "the file on disk has errors, so there is nothing to run", "save a text without errors"};
  std::shared_ptr<Run> forgotten;  // destroyed outside the lock
  const std::lock_guard lock(mutex_);
  if (std::ranges::count_if(runs_, [](const auto& one) { return !one.second->over(); }) >=
      static_cast<std::ptrdiff_t>(most_running))
    return {{}, 429, "too much is running already", "stop a run"};
  if (request.kind == RunRequest::Kind::run)
    for (const auto& [number, run] : runs_)
      if (run->kind() == RunRequest::Kind::run && !run->over())
        return {{},
                409,
                fmt::format("run {} goes on, and only one run at a time can drive the devices", number),
                "stop it first"};
  const auto old = std::ranges::find_if(runs_, [](const auto& one) { return one.second->over(); });
  if (runs_.size() >= most_kept && old != runs_.end()) {
    forgotten = std::move(old->second);
    runs_.erase(old);
  }
  const std::uint64_t number = ++last_;
  runs_[number] = std::make_shared<Run>(std::to_string(number), std::move(request), file_.path(),
                                        std::move(analysis), events_);
  return {std::to_string(number), 202, {}, {}};
}

nlohmann::json Runs::list() const {
  nlohmann::json list = nlohmann::json::array();
  const std::lock_guard lock(mutex_);
  for (const auto& [number, run] : runs_) list.push_back(run->info(false));
  return list;
}

std::shared_ptr<Run> Runs::find(const std::string& id) const {
  std::uint64_t number = 0;
  const auto [end, problem] = std::from_chars(id.data(), id.data() + id.size(), number);
  const std::lock_guard lock(mutex_);
  const auto found =
      problem == std::errc{} && end == id.data() + id.size() ? runs_.find(number) : runs_.end();
  return found == runs_.end() ? nullptr : found->second;
}

std::optional<std::string> Runs::scene(const std::string& hash) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [number, run] : runs_)
    if (std::optional<std::string> glb = run->scene(hash)) return glb;
  return std::nullopt;
}

void Runs::stop_all() {
  std::map<std::uint64_t, std::shared_ptr<Run>> all;
  {
    const std::lock_guard lock(mutex_);
    all.swap(runs_);
  }
  for (const auto& [number, run] : all) run->stop();
}

}  // namespace tessera::server
