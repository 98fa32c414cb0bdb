#include "cli/watching/running_controller.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "cli/terminal.hpp"
#include "tessera/monitor.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

std::optional<RunningController> RunningController::attach(const fs::path& socket_file) {
  std::optional<project::ControlConnection> made = project::ControlConnection::to(socket_file);
  if (!made) return std::nullopt;
  return RunningController(std::move(*made), socket_file);
}

std::optional<project::ControlMessage> RunningController::message() {
  if (coming_) return std::exchange(coming_, std::nullopt);
  for (;;) {
    if (std::optional<project::ControlMessage> message = heard_.next()) return message;
    if (heard_.exceeds_limits() || connection_.receive(heard_) != project::ControlConnection::Received::bytes)
      return std::nullopt;
  }
}

const project::ControlMessage* RunningController::coming_message() {
  if (!coming_) coming_ = message();
  return coming_ ? &*coming_ : nullptr;
}

namespace {

const Snapshot* snapshot_in(const project::ControlMessage* message) {
  return message != nullptr && message->content ? std::get_if<Snapshot>(&*message->content) : nullptr;
}

}  // namespace

bool RunningController::learn_name(std::chrono::milliseconds longest) {
  connection_.limit_waits(longest);
  const Snapshot* snapshot = snapshot_in(coming_message());
  if (snapshot == nullptr) return false;
  name_ = snapshot->system + "." + (snapshot->process ? *snapshot->process + "." : "") +
          std::to_string(snapshot->pid);
  return true;
}

namespace {

/// name: SYSTEM.PID or SYSTEM.PROCESS.PID
bool is_meant(const std::string& name, const std::string& which) {
  return which.empty() || name.starts_with(which + ".") || name.ends_with("." + which) ||
         name.find("." + which + ".") != std::string::npos;
}

}  // namespace

namespace {

using Clock = std::chrono::steady_clock;

/// The time until then, but never none: a message that has come already is always taken.
std::chrono::milliseconds left_until(Clock::time_point end) {
  return std::max(std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()),
                  std::chrono::milliseconds(50));
}

/// Sockets of processes that may be meant: a shortened name does not tell.
std::vector<fs::path> sockets_of(const fs::path& folder, const std::string& which) {
  std::vector<fs::path> files = project::control_sockets(folder);
  std::erase_if(files, [&](const fs::path& file) {
    return !has_shortened_name(file.native()) && !is_meant(file.stem().string(), which);
  });
  return files;
}

/// Connects to each once. Returns those that take no connection now, although a process may listen.
std::vector<fs::path> connect_to(const std::vector<fs::path>& files,
                                 const std::function<void(RunningController, const fs::path&)>& reached) {
  std::vector<fs::path> busy;
  for (const fs::path& file : files) {
    project::ControlConnection::Attempt made = project::ControlConnection::attempt(file);
    if (made.connection)
      reached(RunningController(std::move(*made.connection), file), file);
    else if (made.may_listen)
      busy.push_back(file);
  }
  return busy;
}

}  // namespace

bool RunningController::tell(const ControlCommand& command) {
  be_patient_for(patience);
  return connection_.send(line_of(command, ++told_));
}

std::optional<CommandAnswer> RunningController::answer(Clock::time_point end,
                                                       std::optional<Snapshot>* first) {
  // It sends its state several times a second, beside answers: lines come as long as it runs. Lines that have come
  // already are taken in any case, because others may have taken all the time.
  const auto last = std::max(end, Clock::now() + std::chrono::milliseconds(200));
  do {
    be_patient_for(left_until(end));
    std::optional<project::ControlMessage> said = message();
    if (!said) break;
    auto* answer = said->content ? std::get_if<CommandAnswer>(&*said->content) : nullptr;
    if (answer != nullptr && answer->id == told_) return std::move(*answer);
    auto* snapshot = said->content ? std::get_if<Snapshot>(&*said->content) : nullptr;
    if (first != nullptr && !*first && snapshot != nullptr) *first = std::move(*snapshot);
  } while (Clock::now() < last);
  return std::nullopt;
}

FoundControllers look_for_controllers(const std::string& which, const Greet& greet) {
  FoundControllers found;
  std::vector<std::pair<RunningController, fs::path>> unnamed;
  const auto greeted = [&](RunningController& one) {
    if (greet) greet(one);
    found.running.push_back(std::move(one));
  };
  const auto reached = [&](RunningController one, const fs::path& file) {
    if (has_shortened_name(file.native()) && !which.empty())
      unnamed.emplace_back(std::move(one), file);
    else
      greeted(one);
  };
  const auto end = Clock::now() + std::chrono::seconds(1);
  found.silent = connect_to(sockets_of(monitor_folder(), which), reached);
  while (!found.silent.empty() && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    found.silent = connect_to(found.silent, reached);
  }
  const auto named_until = Clock::now() + std::chrono::seconds(2);
  for (auto& [one, file] : unnamed) {
    if (!one.learn_name(left_until(named_until)))
      found.silent.push_back(file);
    else if (is_meant(one.name(), which))
      greeted(one);
  }
  if (which.empty())
    for (RunningController& one : found.running)
      if (has_shortened_name(one.name())) one.learn_name(left_until(named_until));
  return found;
}

int complain_of_silent(const std::vector<fs::path>& silent, const std::string& what) {
  for (const fs::path& file : silent)
    complain(file.stem().string() + " does not answer (" + file.string() + "): " + what);
  return silent.empty() ? ok : failed;
}

int complain_of_none(const std::string& which) {
  // A controller may have been started before that.
  if (const std::optional<Problem> wrong = wrong_with_monitor_folder())
    return complain("it is unknown whether a controller is running: " + wrong->text);
  return complain((which.empty() ? "no controller is running" : "no controller '" + which + "' is running") +
                  " in real time as this user (its socket would be in " + monitor_folder() +
                  "); `tessera run` starts one");
}

namespace {

struct OtherFolder {
  fs::path path;
  std::string environment;  ///< with which a command looks there
};

/// A controller of this user listens there, if its environment has XDG_RUNTIME_DIR as a login sets it, or not at all.
/// None, if this process has a folder of its own choice: then its controllers are kept apart on purpose.
std::vector<OtherFolder> other_folders() {
  const std::string user = std::to_string(geteuid()), login = "/run/user/" + user;
  std::vector<OtherFolder> folders{{login + "/tessera", "XDG_RUNTIME_DIR=" + login},
                                   {"/tmp/tessera-" + user, "-u XDG_RUNTIME_DIR"}};
  if (std::ranges::count(folders, fs::path(monitor_folder()), &OtherFolder::path) == 0) return {};
  std::erase_if(folders, [](const OtherFolder& one) {
    struct stat status {};
    return one.path == monitor_folder() || lstat(one.path.c_str(), &status) != 0 ||
           !S_ISDIR(status.st_mode) || status.st_uid != geteuid();
  });
  return folders;
}

}  // namespace

int complain_of_other_folders(const std::string& which) {
  int code = ok;
  for (const OtherFolder& folder : other_folders()) {
    std::string names;
    for (const fs::path& file : sockets_of(folder.path, which))
      if (project::ControlConnection::attempt(file).may_listen)
        names += (names.empty() ? "" : ", ") + file.stem().string();
    if (!names.empty())
      code = complain("NOT STOPPED, because their sockets are in " + folder.path.string() + ": " + names +
                      ". Type `env " + folder.environment + " tessera emergency-stop`, too");
  }
  return code;
}

namespace {

/// The words of a process of this user; empty: it has gone, or is another user's.
std::vector<std::string> words_of(const fs::path& process) {
  struct stat status {};
  std::vector<std::string> words;
  if (stat(process.c_str(), &status) != 0 || status.st_uid != geteuid()) return words;
  std::ifstream stream(process / "cmdline", std::ios::binary);
  for (std::string word; std::getline(stream, word, '\0');) words.push_back(word);
  return words;
}

}  // namespace

int complain_of_unreachable() {
  int code = ok;
  std::error_code problem;
  for (fs::directory_iterator entry("/proc", problem), end; !problem && entry != end;
       entry.increment(problem)) {
    const std::string number = entry->path().filename().string();
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::vector<std::string> words = words_of(entry->path());
    // `tessera run --no-monitor` has a controller, which is named.
    if (words.size() < 3 || words[1] != "run" || std::ranges::count(words, "--no-monitor") == 0 ||
        fs::path(words[0]).filename() == "tessera")
      continue;
    code = complain("NOT STOPPED, because it runs without a control socket (--no-monitor): process " +
                    number + " (" + words[0] + "). `kill " + number + "` ends it safely");
  }
  return code;
}

FoundControllers find_controllers(const std::string& which) {
  FoundControllers found = look_for_controllers(which);
  if (found.none()) complain_of_none(which);
  return found;
}

std::vector<SeenController> first_look(std::vector<RunningController> controllers) {
  const auto end = Clock::now() + std::chrono::seconds(2);
  std::vector<SeenController> seen;
  for (RunningController& one : controllers) {
    SeenController& looked_at = seen.emplace_back(SeenController{std::move(one), {}});
    looked_at.controller.be_patient_for(left_until(end));
    if (const Snapshot* snapshot = snapshot_in(looked_at.controller.coming_message()))
      looked_at.snapshot = *snapshot;
  }
  return seen;
}

std::optional<std::string> common_deployment(const std::vector<SeenController>& controllers) {
  std::optional<std::string> system;
  for (const SeenController& one : controllers) {
    if (!one.snapshot) continue;  // it hangs; its system is one of the others', or it is the only one
    if (!one.snapshot->process || (system && *system != one.snapshot->system)) return std::nullopt;
    system = one.snapshot->system;
  }
  const bool all = system && std::ranges::all_of(controllers, [&](const SeenController& one) {
                     return one.controller.name().starts_with(*system + ".");
                   });
  return all ? system : std::nullopt;
}

int complain_of_several(const std::vector<SeenController>& controllers) {
  std::string names;
  for (const SeenController& one : controllers) names += (names.empty() ? "" : ", ") + one.controller.name();
  return complain("several controllers are running (" + names +
                  "): name one, by its system, its process or its number");
}

}  // namespace tessera::cli
