#include "server/studio.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cctype>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "project/files/file_names.hpp"
#include "project/files/files.hpp"
#include "project/files/installation.hpp"
#include "project/files/state_folder.hpp"
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

/// A page that leads to the studio, for the browser that this command opens. Every user of the machine can
/// read the arguments of a program, so the address with the token must not be one. Only this user can read
/// the file; it goes with this object.
class WayIn {
 public:
  /// folder: is made if it does not exist. Throws std::runtime_error if it cannot be written to.
  WayIn(const fs::path& folder, const std::string& url) {
    fs::create_directories(folder);
    remove_old(folder);
    file_ = (folder / (std::string(name) + "XXXXXX.html")).string();
    const int descriptor = mkostemps(file_.data(), /*suffixlen=*/5, O_CLOEXEC);  // mode 0600
    if (descriptor < 0) throw std::runtime_error("cannot write to " + folder.string());
    const bool written = project::write_all(
        descriptor, fmt::format("<!DOCTYPE html><meta charset=\"utf-8\"><title>Tessera studio</title>\n"
                                "<meta name=\"referrer\" content=\"no-referrer\">\n"
                                "<meta http-equiv=\"refresh\" content=\"0; url={0}\">\n"
                                "<p><a href=\"{0}\">Open the studio</a></p>\n",
                                url));
    if (close(descriptor) == 0 && written) return;
    unlink(file_.c_str());
    throw std::runtime_error("cannot write to " + folder.string());
  }
  ~WayIn() { unlink(file_.c_str()); }
  WayIn(const WayIn&) = delete;
  WayIn& operator=(const WayIn&) = delete;
  [[nodiscard]] std::string address() const {
    std::string address = "file://";
    for (const char c : file_) {
      const bool is_plain =
          (std::isalnum(static_cast<unsigned char>(c)) != 0) || c == '/' || c == '-' || c == '_' || c == '.';
      address += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return address;
  }

 private:
  static constexpr std::string_view name = "browser-";
  /// Those of commands that were killed.
  static void remove_old(const fs::path& folder) {
    std::error_code ignored;
    const auto old = fs::file_time_type::clock::now() - std::chrono::minutes(1);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
      if (entry.path().filename().string().starts_with(name) && entry.path().extension() == ".html" &&
          entry.last_write_time(ignored) < old)
        fs::remove(entry.path(), ignored);
  }
  std::string file_;
};

/// nullptr: no browser is opened, and the user opens the printed address.
std::unique_ptr<WayIn> open_browser(const fs::path& project, const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return nullptr;
  try {
    // A browser in a sandbox often reads the folders of projects, but neither /tmp nor /run.
    auto way_in = std::make_unique<WayIn>(project::state_folder(project), url);
    static_cast<void>(project::capture({"xdg-open", way_in->address()}));
    return way_in;
  } catch (const std::exception&) {
    return nullptr;
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
  const std::unique_ptr<WayIn> way_in =
      options.no_browser ? nullptr : open_browser(studio.spec.parent_path(), running.url());
  signals.wait();
  return ok;
}

}  // namespace

void add_studio(CommandLine& app) {
  Subcommand command = app.add("studio", "See, edit, verify and run a system in the browser");
  StudioCommandOptions& options = command.runs(studio_command);
  declare_specification(command, options.spec);
  command.option("--port", options.port, "Port to begin with: one that is taken leads to the next; 0: any")
      .within(0, 65535)
      .shows_default();
  command.flag("--no-browser", options.no_browser, "Print the address and open nothing");
  command.footer(
      "Prints the address with the token of this start; whoever has it can edit and run this project.\n"
      "Only this machine can connect. From another: ssh -L 8417:127.0.0.1:8417 HOST\n"
      "Example: tessera studio robot");
}

}  // namespace tessera::cli
