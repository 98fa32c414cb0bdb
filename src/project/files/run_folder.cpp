#include "project/files/run_folder.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <optional>
#include <regex>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "project/files/file_names.hpp"
#include "project/files/files.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

constexpr const char* lock_name = "in_use.lock";
constexpr std::uint64_t most_runs = 100, most_bytes = 4'000'000'000;

std::uint64_t limit_of(const char* variable, std::uint64_t usual) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return usual;
  const std::uint64_t limit = parse_size(value, variable);
  return limit == 0 ? UINT64_MAX : limit;
}

/// Whether Tessera or its controllers write a file with that name into the folder of a run.
bool is_ours(const std::string& name) {
  static const std::regex ours(
      R"(recording(\.\d+)?\.tsr|recording\.tsr\.notes\.json|[0-9a-f]{16}\.glb|inputs\.tsr|path\.csv|(summary|simulation|deployment)\.json|process-.+\.(tsr|json|txt)|controller|death\.txt|in_use\.lock)");
  return std::regex_match(name, ours);
}

struct OldRun {
  fs::path folder;
  timespec changed{};
  std::uint64_t bytes = 0;
};

/// The folders that have names of runs, the oldest first.
std::vector<OldRun> runs_in(const fs::path& folder) {
  static const std::regex name_of_a_run(R"(\d{8}-\d{6}-([a-z_]+-)?\d+)");
  std::vector<OldRun> runs;
  std::error_code problem;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    struct stat status {};
    if (lstat(entry->path().c_str(), &status) != 0 || !S_ISDIR(status.st_mode) ||
        !std::regex_match(entry->path().filename().string(), name_of_a_run))
      continue;
    OldRun run{entry->path(), status.st_mtim, 0};
    std::error_code gone;
    for (fs::directory_iterator file(run.folder, gone), last; !gone && file != last; file.increment(gone)) {
      struct stat size {};
      if (lstat(file->path().c_str(), &size) == 0 && S_ISREG(size.st_mode))
        // a file with several links counts in part for each
        run.bytes += static_cast<std::uint64_t>(size.st_size) / size.st_nlink;
    }
    runs.push_back(std::move(run));
  }
  std::ranges::sort(runs, [](const OldRun& one, const OldRun& other) {
    return std::tuple(one.changed.tv_sec, one.changed.tv_nsec, one.folder) <
           std::tuple(other.changed.tv_sec, other.changed.tv_nsec, other.folder);
  });
  return runs;
}

void remove_files(const fs::path& folder) {
  std::error_code problem;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  for (const fs::path& file : files)
    if (is_ours(file.filename().string())) fs::remove(file, problem);
  fs::remove(folder, problem);  // only if nothing is left in it
}

/// false: the folder is in use, or contains a file `keep`.
bool remove_run(const fs::path& folder) {
  std::error_code problem;
  if (fs::exists(fs::symlink_status(folder / "keep", problem))) return false;
  const std::optional<LockFile> lock = LockFile::try_take(folder / lock_name, LockFile::Mode::exclusive);
  if (!lock) return false;
  remove_files(folder);
  return true;
}

/// The run to which `last` points, "runs/20261122-091530-simulate-1"; empty: none.
fs::path shown_in(const fs::path& state) {
  std::error_code problem;
  const fs::path shown = fs::read_symlink(state / "last", problem);
  return problem ? fs::path() : shown;
}

/// Keeps the newest runs. The newest one stays even if it exceeds the limit by itself. The run to
/// which `last` points stays, too.
void remove_old(const fs::path& state, Listener& listener) {
  const fs::path folder = state / "runs", shown = shown_in(state).filename();
  const std::uint64_t runs_limit = limit_of("TESSERA_KEEP_RUNS", most_runs);
  const std::uint64_t bytes_limit = limit_of("TESSERA_KEEP_RUNS_SIZE", most_bytes);
  std::vector<OldRun> runs = runs_in(folder);
  std::uint64_t bytes = 0, count = runs.size();
  for (const OldRun& run : runs) bytes += run.bytes;
  for (std::size_t index = 0; index + 1 < runs.size(); ++index) {
    if (count < runs_limit && bytes <= bytes_limit) return;  // one more is about to begin
    try {
      if (runs[index].folder.filename() == shown || !remove_run(runs[index].folder)) continue;
    } catch (const std::exception& error) {
      listener.warn(fmt::format("an old run cannot be removed: {}", error.what()));
      return;
    }
    --count;
    bytes -= runs[index].bytes;
  }
}

/// A name that no run has now, and none has had in this second: the numbers go on.
fs::path new_name(const fs::path& runs, const std::string& mode) {
  const std::string start = fmt::format("{:%Y%m%d-%H%M%S}-{}-", fmt::localtime(std::time(nullptr)), mode);
  std::uint64_t highest = 0;
  std::error_code problem;
  for (fs::directory_iterator entry(runs, problem), end; !problem && entry != end; entry.increment(problem)) {
    const std::string name = entry->path().filename().string();
    std::uint64_t number = 0;
    if (!name.starts_with(start)) continue;
    std::from_chars(name.data() + start.size(), name.data() + name.size(), number);
    highest = std::max(highest, number);
  }
  return runs / (start + std::to_string(highest + 1));
}

fs::path make_folder(const fs::path& folder) {
  fs::create_directories(folder.parent_path());
  if (mkdir(folder.c_str(), 0777) == 0) return folder;
  throw std::runtime_error(fmt::format("cannot make {}: {}", folder.string(), std::strerror(errno)));
}

/// Earlier versions had one folder `last`, which every run overwrote.
void move_old_last(const fs::path& state) {
  std::error_code problem;
  const fs::path last = state / "last";
  if (fs::symlink_status(last, problem).type() != fs::file_type::directory) return;
  const fs::path folder = make_folder(new_name(state / "runs", "earlier"));
  if (rename(last.c_str(), folder.c_str()) != 0)
    throw std::runtime_error(fmt::format("cannot move {}: {}", last.string(), std::strerror(errno)));
}

void point_last_to(const fs::path& state, const fs::path& folder) {
  const fs::path last = state / "last";
  if (fs::exists(fs::symlink_status(last)) && !fs::is_symlink(last))
    throw std::runtime_error(last.string() + " is in the way: Tessera keeps a link there; move it away");
  const fs::path beside = state / fmt::format(".last.{}.{}", getpid(), folder.filename().string());
  std::error_code problem;
  fs::remove(beside, problem);
  fs::create_symlink(fs::path("runs") / folder.filename(), beside, problem);
  if (!problem) fs::rename(beside, last, problem);
  if (problem) throw std::runtime_error(fmt::format("cannot write {}: {}", last.string(), problem.message()));
}

/// The run to which `last` pointed before, for a run that has not begun; empty: there is none.
fs::path shown_instead(const fs::path& state, const fs::path& before) {
  std::error_code problem;
  if (!before.empty() && fs::is_directory(state / before, problem)) return state / before;
  std::vector<OldRun> runs = runs_in(state / "runs");
  std::erase_if(runs,
                [&](const OldRun& run) { return !fs::exists(run.folder / file_names::recording, problem); });
  return runs.empty() ? fs::path() : runs.back().folder;
}

LockFile lock_of(const fs::path& folder) {
  std::optional<LockFile> lock = LockFile::try_take(folder / lock_name, LockFile::Mode::shared);
  if (!lock) throw std::runtime_error(folder.string() + " is in use");
  return std::move(*lock);
}

/// A lock for removing old runs and adding the new one. No process holds it for long.
LockFile runs_lock(const fs::path& state) {
  for (;;) {
    if (auto lock = LockFile::try_take(state / "runs.lock", LockFile::Mode::exclusive))
      return std::move(*lock);
    usleep(1000);
  }
}

fs::path begin(const fs::path& state, const std::string& mode, Listener& listener) {
  move_old_last(state);
  const fs::path folder = new_name(state / "runs", mode);  // not the name of a run that is being removed
  remove_old(state, listener);
  return make_folder(folder);
}

}  // namespace

RunFolder::RunFolder(const fs::path& state, const std::string& mode, Shown shown, Listener& listener)
    : RunFolder(state, mode, shown, listener, runs_lock(state)) {}

RunFolder::RunFolder(const fs::path& state, const std::string& mode, Shown shown, Listener& listener,
                     const LockFile& /*held*/)
    : path_(begin(state, mode, listener)), before_(shown_in(state)), in_use_(lock_of(path_)) {
  if (shown == Shown::as_last) point_last_to(state, path_);
}

void RunFolder::withdraw() const {
  const fs::path state = path_.parent_path().parent_path();
  const LockFile held = runs_lock(state);
  const bool is_shown = shown_in(state).filename() == path_.filename();
  remove_files(path_);
  if (!is_shown) return;
  if (const fs::path instead = shown_instead(state, before_); !instead.empty())
    point_last_to(state, instead);
  else
    fs::remove(state / "last");
}

fs::path RunFolder::own_copy_of(const fs::path& program) const {
  const fs::path own = path_ / "controller";
  std::error_code problem;
  fs::create_hard_link(program, own, problem);
  if (problem) copy_whole(program, own);  // another disk, or another user's file
  return own;
}

std::uint64_t parse_size(const std::string& text, const std::string& what) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(end, text.data() + text.size());
  const std::uint64_t scale = unit.empty() || unit == "B" ? 1
                              : unit == "kB"              ? 1'000
                              : unit == "MB"              ? 1'000'000
                              : unit == "GB"              ? 1'000'000'000
                                                          : 0;
  if (error != std::errc() || scale == 0 || number > UINT64_MAX / scale)
    throw std::runtime_error(fmt::format("{}: '{}' is no size, such as 500MB", what, text));
  return number * scale;
}

}  // namespace tessera::project
