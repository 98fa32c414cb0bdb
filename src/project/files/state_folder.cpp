#include "project/files/state_folder.hpp"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "project/files/file_names.hpp"
#include "project/files/files.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

bool is_writable(const fs::path& folder) { return access(folder.c_str(), W_OK | X_OK) == 0; }

/// false, too, if another user has made the folder or parts of it.
bool own_folder_is_writable(const fs::path& project) {
  const fs::path own = own_folder(project);
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(own, ignored))) return is_writable(project);
  if (!is_writable(own)) return false;
  for (const char* part : {"generated", "build", "build/release", "build/debug", "programs", "runs"})
    if (fs::exists(own / part, ignored) && !is_writable(own / part)) return false;
  return true;
}

std::string value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::string() : value;
}

}  // namespace

fs::path own_folder(const fs::path& project) { return project / file_names::state_folder; }

std::optional<fs::path> user_folder() {
  if (const std::string given = value_of("TESSERA_STATE_DIR"); !given.empty()) return fs::absolute(given);
  if (const std::string service = value_of("STATE_DIRECTORY"); !service.empty())
    return fs::path(service.substr(0, service.find(':')));
  if (const std::string xdg = value_of("XDG_STATE_HOME"); !xdg.empty()) return fs::path(xdg) / "tessera";
  if (const std::string home = value_of("HOME"); !home.empty())
    return fs::path(home) / ".local/state/tessera";
  return std::nullopt;
}

bool is_kept_by_user(const fs::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 && status.st_uid == geteuid() &&
         (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

void keep_for_user(const fs::path& file, std::string_view text) {
  fs::create_directories(file.parent_path());
  // Whatever the umask allows: others must not put files there.
  fs::permissions(file.parent_path(), fs::perms::owner_all);
  write_file(file, text);
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
}

fs::path state_folder(const fs::path& project) {
  if (value_of("TESSERA_STATE_DIR").empty() && own_folder_is_writable(project)) return own_folder(project);
  const std::optional<fs::path> folder = user_folder();
  if (!folder)
    throw std::runtime_error(
        fmt::format("{} cannot be written to, and there is no other place for what Tessera makes: set "
                    "TESSERA_STATE_DIR, or use --state DIR",
                    project.string()));
  return *folder / fmt::format("{}-{}", project.filename().string(), hash_of(project.string()).substr(0, 8));
}

}  // namespace tessera::project
