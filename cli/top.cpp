#include <fmt/core.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "tessera/monitor.hpp"

namespace tessera::cli {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Options {
  std::string which;
  bool once = false, lines = false;
};

/// The stream of lines that a running controller sends.
class Watched {
 public:
  /// nullopt: nobody listens there.
  static std::optional<Watched> attach(const fs::path& socket_file) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = socket_file.string();
    if (name.size() >= sizeof address.sun_path) return std::nullopt;
    std::memcpy(address.sun_path, name.c_str(), name.size() + 1);
    Watched watched(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const auto* raw = reinterpret_cast<const sockaddr*>(&address);
    if (watched.descriptor_ < 0 || connect(watched.descriptor_, raw, sizeof address) != 0)
      return std::nullopt;
    return watched;
  }
  Watched(Watched&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), pending_(std::move(other.pending_)) {}
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
  Watched& operator=(Watched&&) = delete;
  ~Watched() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  /// The next line; nullopt: the controller has ended.
  std::optional<std::string> line() {
    for (;;) {
      if (const std::size_t end = pending_.find('\n'); end != std::string::npos) {
        std::string line = pending_.substr(0, end);
        pending_.erase(0, end + 1);
        return line;
      }
      char bytes[65536];
      const ssize_t count = read(descriptor_, bytes, sizeof bytes);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return std::nullopt;
      pending_.append(bytes, static_cast<std::size_t>(count));
    }
  }

 private:
  explicit Watched(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
  std::string pending_;
};

/// The sockets of controllers that `which` (a system, a process, or empty for any) may mean.
std::vector<fs::path> sockets(const std::string& which) {
  std::vector<fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(monitor_folder(), none)) {
    const std::string name = entry.path().filename().string();  // SYSTEM.PID.sock
    if (!name.ends_with(".sock")) continue;
    if (which.empty() || name.starts_with(which + ".") || name.ends_with("." + which + ".sock"))
      found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

/// nullopt after the reason has been printed.
std::optional<Watched> attach(const std::string& which) {
  std::vector<Watched> running;
  std::string names;
  for (const fs::path& file : sockets(which)) {
    std::optional<Watched> watched = Watched::attach(file);
    if (!watched) continue;  // left behind by a process that was killed
    running.push_back(std::move(*watched));
    names += (names.empty() ? "" : ", ") + file.stem().string();
  }
  if (running.size() == 1) return std::move(running.front());
  if (running.empty())
    complain((which.empty() ? "no controller is running" : "no controller '" + which + "' is running") +
             " in real time as this user; `tessera run` starts one");
  else
    complain("several controllers are running (" + names + "): name one, by its system or its process");
  return std::nullopt;
}

// ---------------------------------------------------------------------------------------------- table

std::string duration_of(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.0f} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.1f} ms", seconds * 1e3);
  return fmt::format("{:.1f} s", seconds);
}

/// "20.0 of 20 Hz": iterations a second between two snapshots.
std::string rate_of(const json& now, const json& before, double elapsed_s) {
  const double done = now.at("iterations").get<double>() - before.at("iterations").get<double>();
  const double wanted = now.at("period_s").get<double>();
  const std::string kept = elapsed_s > 0 ? fmt::format("{:.1f}", done / elapsed_s) : "-";
  return wanted > 0 ? fmt::format("{} of {:.4g} Hz", kept, 1 / wanted) : kept + " Hz";
}

std::string state_of(const json& subsystem) {
  if (subsystem.at("ended").get<bool>()) return "ended";
  if (subsystem.at("behaviour").is_null()) return "-";
  return subsystem.at("behaviour").get<std::string>() + (subsystem.at("calling").get<bool>() ? " *" : "");
}

std::string table(const json& now, const json& before) {
  const double elapsed_s = now.at("time_s").get<double>() - before.at("time_s").get<double>();
  std::string text =
      fmt::format("{}  process {}  {:.1f} s  net {}\n\n{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n",
                  now.at("system").get<std::string>(), now.at("pid").get<int>(),
                  now.at("time_s").get<double>(), now.at("net_hash").get<std::string>(), "subsystem",
                  "behaviour", "rate", "call", "longest", "overruns", "errors");
  for (std::size_t index = 0; index < now.at("subsystems").size(); ++index) {
    const json& one = now.at("subsystems")[index];
    text += fmt::format("{:<28} {:<20} {:>18} {:>10} {:>10} {:>9} {:>7}\n", one.at("path").get<std::string>(),
                        state_of(one), rate_of(one, before.at("subsystems")[index], elapsed_s),
                        duration_of(one.at("call_s").get<double>()),
                        duration_of(one.at("longest_call_s").get<double>()),
                        one.at("overruns").get<std::uint64_t>(), one.at("errors").get<std::uint64_t>());
  }
  text += fmt::format("\n{:<60} {}\n", "channel", "state");
  for (const json& channel : now.at("channels")) {
    std::string marked;
    for (const json& place : channel.at("marked"))
      marked += (marked.empty() ? "" : " + ") + place.get<std::string>();
    text +=
        fmt::format("{:<60} {}\n", channel.at("name").get<std::string>(), marked.empty() ? "in use" : marked);
  }
  return text;
}

int top_command(const Options& options) {
  std::optional<Watched> watched = attach(options.which);
  if (!watched) return failed;
  json before;
  while (const std::optional<std::string> line = watched->line()) {
    json now = json::parse(*line, nullptr, false);
    if (now.is_discarded()) return complain("the controller sent what this version does not understand");
    if (now.contains("ended")) break;
    if (options.lines) {
      fmt::print("{}\n", *line);
      if (options.once) return ok;
    } else if (!before.is_null()) {
      const bool terminal = isatty(STDOUT_FILENO) != 0 && !options.once;
      fmt::print("{}{}", terminal ? "\033[H\033[2J" : "", table(now, before));
      if (options.once) return ok;
    }
    std::fflush(stdout);
    before = std::move(now);
  }
  fmt::print("the controller has ended\n");
  return ok;
}

}  // namespace

void add_top(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("top", "Watch a controller that runs in real time");
  auto options = std::make_shared<Options>();
  command->add_option("controller", options->which, "Its system or its process; needed if several run");
  command->add_flag("--once", options->once, "Print one table and end");
  command->add_flag("--json", options->lines, "Print the lines of JSON that the controller sends");
  command->footer(
      "A * behind a behaviour: its transition function is being executed. `call` is what its last one took,\n"
      "`in use`: one side writes or reads the channel's memory.\n"
      "Example: tessera run --world &  tessera top");
  command->callback([options, &exit_code] { exit_code = top_command(*options); });
}

}  // namespace tessera::cli
