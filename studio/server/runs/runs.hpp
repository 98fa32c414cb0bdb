#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/analysis/analysis.hpp"
#include "server/analysis/spec_file.hpp"
#include "server/http/events.hpp"
#include "server/runs/run.hpp"

namespace tessera::server {

/// The runs since the studio was started. Their files stay in .tessera/runs/ (project::RunFolder).
///
/// Threads: any.
class Runs {
 public:
  Runs(SpecFile& file, Analyses& analyses, Events& events)
      : file_(file), analyses_(analyses), events_(events) {}

  static constexpr std::size_t most_running = 4, most_kept = 32;

  struct Started {
    std::string run;
    int status = 202;  ///< otherwise 422: the file on disk has errors; 429: too many runs
    std::string error, hint;
  };
  [[nodiscard]] Started start(RunRequest request);
  [[nodiscard]] nlohmann::json list() const;
  [[nodiscard]] std::shared_ptr<Run> find(const std::string& id) const;
  /// The glTF file of a scene that came through a tunnel; nullopt: there is none.
  [[nodiscard]] std::optional<std::string> scene(const std::string& hash) const;
  /// Ends all runs and waits until they have ended.
  void stop_all();

 private:
  SpecFile& file_;
  Analyses& analyses_;
  Events& events_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::shared_ptr<Run>> runs_;
  std::uint64_t last_ = 0;
};

}  // namespace tessera::server
