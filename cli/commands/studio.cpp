#include "server/studio.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "project/files/file_names.hpp"
#include "project/files/installation.hpp"
#include "project/process/process.hpp"
#include "project/verification/pipeline.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

namespace {

struct StudioCommandOptions {
  std::string spec = ".";
  int port = server::StudioOptions{}.port;
  bool no_browser = false;
};

/// Blocks SIGINT and SIGTERM for all threads that are made during its lifetime.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, &before_);
  }
  ~EndSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;
  void wait() const {
    int signal = 0;
    sigwait(&set_, &signal);
  }

 private:
  sigset_t set_{}, before_{};
};

void open_browser(const std::string& url) {
  // Without a display, the user opens the printed address.
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  try {
    static_cast<void>(project::capture({"xdg-open", url}));
  } catch (const std::exception&) {
  }
}

int studio_command(const StudioCommandOptions& options) {
  fs::path given = project::spec_file(options.spec);
  if (fs::is_directory(given)) given /= project::file_names::specification;
  const bool is_there = fs::exists(given);
  // A new file is begun only under the name of a specification: other names are most likely mistyped.
  const bool can_begin = given.extension() == ".yaml" || given.extension() == ".yml";
  const fs::path folder = fs::absolute(given).parent_path();
  if (!is_there && !(can_begin && fs::is_directory(folder)))
    return complain(
        fmt::format("there is no specification {}; `tessera new NAME` makes a project", given.string()));
  const project::Installation installation = project::Installation::find();
  server::StudioOptions studio;
  studio.spec = project::located(given);
  studio.port = options.port;
  studio.page = installation.share / "studio";  // in the build tree: a link to the output of Vite
  studio.share = installation.share;
  studio.version = TESSERA_VERSION;
  const EndSignals signals;
  const server::Studio running(studio);
  if (options.port != 0 && running.port() != options.port)
    fmt::print(stderr, "port {} is taken\n", options.port);
  fmt::print("{}\n", running.url());
  std::fflush(stdout);
  fmt::print(stderr, "studio of {}; Ctrl-C ends it\n", studio.spec.string());
  if (!is_there) fmt::print(stderr, "this file does not exist yet; the page offers ways to begin\n");
  if (!options.no_browser) open_browser(running.url());
  signals.wait();
  return ok;
}

}  // namespace

void add_studio(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("studio", "See, edit, verify and run a system in the browser");
  auto options = std::make_shared<StudioCommandOptions>();
  declare_specification(command, options->spec);
  command.option("--port", options->port, "Port to begin with: one that is taken leads to the next; 0: any")
      .within(0, 65535)
      .shows_default();
  command.flag("--no-browser", options->no_browser, "Print the address and open nothing");
  command.footer(
      "Prints the address with the token of this start; whoever has it can edit and run this project.\n"
      "Only this machine can connect. From another: ssh -L 8417:127.0.0.1:8417 HOST\n"
      "Example: tessera studio robot");
  command.callback([options, &exit_code] { exit_code = studio_command(*options); });
}

}  // namespace tessera::cli
