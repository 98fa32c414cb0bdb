#include "project/build/programs.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "project/files/files.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// A linker makes a new file; if it has not run, the file is unchanged.
std::string identity_of(const fs::path& program) {
  struct stat status {};
  if (stat(program.c_str(), &status) != 0)
    throw std::runtime_error(fmt::format("cannot read {}: {}", program.string(), std::strerror(errno)));
  return hash_of(fmt::format("{} {} {} {}", status.st_ino, status.st_size, status.st_mtim.tv_sec,
                             status.st_mtim.tv_nsec))
      .substr(0, 12);
}

/// A run holds a hard link to its program, so the number of links tells whether it is used.
void remove_unused(const fs::path& folder) {
  constexpr auto patience = std::chrono::hours(1);
  std::error_code problem;
  std::map<std::string, fs::path> newest;
  const auto kind_of = [](const fs::path& file) {
    const std::string name = file.filename().string();
    return name.substr(0, name.rfind('-'));
  };
  std::vector<fs::path> all;
  for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    if (entry->symlink_status(problem).type() != fs::file_type::regular ||
        entry->path().extension() == ".built")
      continue;
    all.push_back(entry->path());
    fs::path& best = newest[kind_of(entry->path())];
    if (best.empty() || fs::last_write_time(best, problem) < fs::last_write_time(entry->path(), problem))
      best = entry->path();
  }
  for (const fs::path& program : all) {
    const bool is_old = fs::last_write_time(program, problem) < fs::file_time_type::clock::now() - patience;
    if (is_old && newest[kind_of(program)] != program && fs::hard_link_count(program, problem) == 1)
      fs::remove(program, problem);
  }
}

}  // namespace

fs::path keep_program(const fs::path& state, const fs::path& built, const std::string& kind) {
  const fs::path folder = state / "programs";
  const fs::path kept = folder / fmt::format("{}-{}", kind, identity_of(built));
  std::error_code problem;
  if (!fs::exists(kept)) {
    fs::create_directories(folder);
    fs::path beside = kept;
    beside += fmt::format(".{}", getpid());
    copy_whole(built, beside);
    fs::rename(beside, kept);
  }
  utimensat(AT_FDCWD, kept.c_str(), nullptr, 0);  // used now
  remove_unused(folder);
  return kept;
}

}  // namespace tessera::project
