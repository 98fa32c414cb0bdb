#include "server/analysis/analysis.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "diagnostics/diagnostics.hpp"
#include "diagnostics/utf8.hpp"
#include "drawing/drawing.hpp"
#include "project/files/ros2_messages.hpp"
#include "project/verification/pipeline.hpp"
#include "server/analysis/spec_file.hpp"
#include "server/http/json_text.hpp"
#include "verify/hashes.hpp"

namespace tessera::server {

namespace {

using diagnostics::Diagnostics;
using Json = nlohmann::ordered_json;

/// Converts a byte column to a column in UTF-16 units, as browsers count; both from 1.
std::uint32_t browser_column(std::string_view line, std::uint32_t column) {
  std::uint32_t units = 1;
  for (std::size_t at = 0; at + 1 < column && at < line.size();) {
    const diagnostics::CodePoint point = diagnostics::decode(line, at);
    units += point.code > 0xffff ? 2 : 1;
    at += point.length;
  }
  return units;
}

bool is_ready(const std::shared_future<std::shared_ptr<const Analysis>>& analysis) {
  return analysis.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

Json diagnostic_json(const diagnostics::Diagnostic& one, const Diagnostics& all) {
  constexpr std::array<const char*, 3> severities{"error", "warning", "hint"};
  const std::string_view line = all.line(one.span.line);
  // The page marks the line in the text of the specification, where the lines of included files are not.
  const std::string included = all.sources().included_line(one.span.line);
  const std::uint32_t own = all.sources().own_line(one.span.line);
  return {{"severity", severities[static_cast<std::size_t>(one.severity)]},
          {"code", one.code},
          {"message", included.empty() ? one.message : included + ": " + one.message},
          {"hint", one.hint},
          {"line", own},
          {"column", browser_column(line, one.span.column)},
          {"end_line", own},
          {"end_column", browser_column(line, one.span.column + one.span.length)}};
}

}  // namespace

namespace {

/// Dates of files come from a clock that stands still between its ticks.
constexpr std::chrono::milliseconds clock_tick{20};

bool written_since(std::filesystem::file_time_type moment, const std::vector<std::filesystem::path>& files) {
  return std::ranges::any_of(files, [&](const std::filesystem::path& file) {
    std::error_code missing;
    const auto written = std::filesystem::last_write_time(file, missing);
    return !missing && written >= moment;
  });
}

}  // namespace

std::string state_of(const std::vector<std::filesystem::path>& files) {
  std::string state;
  for (const std::filesystem::path& file : files) {
    std::error_code missing;
    const auto changed = std::filesystem::last_write_time(file, missing).time_since_epoch().count();
    state += file.string() + " " + (missing ? std::string("-") : std::to_string(changed)) + "\n";
  }
  return state;
}

Analysis analyse(const std::string& name, const std::string& text, const std::filesystem::path& project) {
  Analysis analysis;
  const auto begun = std::filesystem::file_time_type::clock::now();
  Diagnostics found(name, text, project);
  project::Draft draft = project::draft_of(found, project);
  analysis.model = std::move(draft.model);
  analysis.pages = std::move(draft.nets.pages);
  analysis.net = std::move(draft.nets.flat);
  if (draft.nets.properties) analysis.properties = std::move(*draft.nets.properties);
  for (const std::string& file : found.sources().included()) analysis.included.push_back(project / file);
  // A file that was written meanwhile may have been read before: its state is not known.
  if (!written_since(begun - clock_tick, analysis.included))
    analysis.state_of_included = state_of(analysis.included);
  if (analysis.net) analysis.net_hash = verify::hash_of(*analysis.net);
  Json diagnostics = Json::array();
  for (const diagnostics::Diagnostic& one : found.sorted())
    diagnostics.push_back(diagnostic_json(one, found));
  std::string json = "{\"diagnostics\":" + text_of(diagnostics);
  if (analysis.net) {
    json += ",\"net_hash\":\"" + analysis.net_hash + "\",\"net\":";
    json += drawing::to_folded_json(*analysis.pages, *analysis.net) + "}";
  } else {
    json += ",\"net_hash\":null,\"net\":null}";
  }
  analysis.json = std::make_shared<const std::string>(std::move(json));
  return analysis;
}

std::shared_ptr<const Analysis> Analyses::of(const std::string& text) {
  const std::filesystem::path project = std::filesystem::absolute(file_).parent_path();
  // The same text has another meaning when a message definition that it names has changed.
  const std::string revision = revision_of(text) + project::state_of_messages(project);
  std::promise<std::shared_ptr<const Analysis>> promise;
  {
    std::unique_lock lock(mutex_);
    const auto found = std::ranges::find(kept_, revision, &Kept::revision);
    if (found != kept_.end()) {
      // Another thread may still be working on it.
      const std::shared_future<std::shared_ptr<const Analysis>> future = found->analysis;
      lock.unlock();
      std::shared_ptr<const Analysis> analysis = future.get();
      if (state_of(analysis->included) == analysis->state_of_included) return analysis;
      lock.lock();
      std::erase_if(kept_, [&](const Kept& one) {
        return one.revision == revision && is_ready(one.analysis) && one.analysis.get() == analysis;
      });
    }
    kept_.push_front({revision, promise.get_future().share()});
    if (kept_.size() > most_kept) kept_.pop_back();
  }
  try {
    auto made = std::make_shared<const Analysis>(analyse(file_.filename().string(), text, project));
    promise.set_value(made);
    return made;
  } catch (...) {
    promise.set_exception(std::current_exception());
    const std::lock_guard lock(mutex_);
    std::erase_if(kept_, [&](const Kept& one) { return one.revision == revision; });
    throw;
  }
}

}  // namespace tessera::server
