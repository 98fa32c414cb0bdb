#pragma once

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "../eventually.hpp"
#include "command.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli_test {

/// Three real processes that talk over loopback. The controller is built once.
class Deploy : public Command {
 protected:
  Deploy() : project_(folder_ / "11_crossing_apart") {
    static bool built = false;
    kept() = fs::temp_directory_path() / ("tessera_deploy_" + std::to_string(getpid()));
    if (!std::exchange(built, true)) {
      fs::rename(example("11_crossing_apart"), kept());
      built = tessera("generate '" + kept().string() + "' --build").code == 0;
    }
    fs::create_directory_symlink(kept(), project_);
    // Others may run the same system on this machine.
    domain_ = " --domain " + std::to_string(1 + getpid() % 230);
  }
  static void TearDownTestSuite() { fs::remove_all(kept()); }
  static fs::path& kept() {
    static fs::path folder;
    return folder;
  }

  [[nodiscard]] nlohmann::json deployment() const {
    return nlohmann::json::parse(content_of(project_ / ".tessera/last/deployment.json"), nullptr, false);
  }
  [[nodiscard]] pid_t pid_of(std::size_t process) const {
    return deployment().at("processes").at(process).at("starts").back().at("pid").get<pid_t>();
  }
  [[nodiscard]] bool any_is_left() const {
    for (std::size_t process = 0; process < 3; ++process)
      if (kill(pid_of(process), 0) == 0) return true;
    return false;
  }
  /// Whether the processes of a run have started that is not over.
  [[nodiscard]] bool all_run() const {
    const nlohmann::json now = deployment();
    if (!now.is_object()) return false;
    for (const nlohmann::json& process : now.at("processes")) {
      const nlohmann::json& starts = process.at("starts");
      const std::string said = "process-" + process.at("name").get<std::string>() + ".tsr";
      if (starts.empty() || starts.back().contains("ended")) return false;
      std::error_code missing;
      const auto bytes = fs::file_size(project_ / ".tessera/last" / said, missing);
      if (missing || bytes == 0) return false;
    }
    return true;
  }
  /// The bytes after the header of a recording, of which only a part may be there: it is written page by page.
  [[nodiscard]] static std::size_t bytes_of_events(const fs::path& recording) {
    const std::string bytes = content_of(recording);
    std::uint32_t header = 0;
    if (bytes.size() < recording_magic.size() + sizeof header) return 0;
    std::memcpy(&header, bytes.data() + recording_magic.size(), sizeof header);
    const std::size_t begin = (recording_magic.size() + sizeof header + header + 7) / 8 * 8;
    return bytes.size() - std::min(begin, bytes.size());
  }
  /// Whether all processes fire. When their recordings begin, their devices are not open yet.
  [[nodiscard]] bool all_fire() const {
    if (!eventually([&] { return all_run(); })) return false;
    return std::ranges::all_of(std::array{"gate", "rover[0]", "rover[1]"}, [&](const char* process) {
      const fs::path recording = project_ / ".tessera/last" / fmt::format("process-{}.tsr", process);
      return eventually([&] { return bytes_of_events(recording) > 1000; });
    });
  }
  /// Runs it, and kills rover[0] when all fire.
  project::Exit run_and_kill(const std::string& options) const {
    bool killed = false;
    const std::string line = "cd '" + folder_.string() + "' && exec " + TESSERA_BINARY_DIR +
                             "/tessera run 11_crossing_apart --deploy" + domain_ + options;
    return project::capture({"sh", "-c", line}, [&](std::string_view said) {
      if (killed || !said.starts_with("rover[0] |")) return;
      killed = true;
      EXPECT_TRUE(all_fire());
      kill(pid_of(1), SIGKILL);
    });
  }

  fs::path project_;
  std::string domain_;
};

}  // namespace tessera::cli_test
