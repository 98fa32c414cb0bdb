#include "project/build/user_sources.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "project/files/file_names.hpp"
#include "project/files/files.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_sources = 1000;
constexpr std::uintmax_t largest_source = 1 << 20;

bool is_plain_file(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(fs::symlink_status(file, ignored));
}

bool is_absent(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() == fs::file_type::not_found;
}

void add_code(const fs::path& folder, std::vector<fs::path>& files) {
  std::error_code problem;
  if (fs::is_symlink(fs::symlink_status(folder, problem))) return;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, problem), end;
  while (!problem && at != end && files.size() < most_sources) {
    std::error_code ignored;
    if (at->is_directory(ignored) && at->path().filename().string().starts_with('.'))
      at.disable_recursion_pending();
    if (is_plain_file(at->path()) && is_code(at->path()) && at->file_size(ignored) <= largest_source)
      files.push_back(at->path());
    at.increment(problem);
  }
}

/// While it exists, no other change of the project's files is made by this class, in any process.
class ChangeLock {
 public:
  /// A file system without such locks is used without.
  explicit ChangeLock(const fs::path& project)
      : descriptor_(open(project.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    while (descriptor_ >= 0 && flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) continue;
  }
  ~ChangeLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  ChangeLock(const ChangeLock&) = delete;
  ChangeLock& operator=(const ChangeLock&) = delete;

 private:
  int descriptor_;
};

/// Why the file is not what the change was made of; nullopt: it is.
std::optional<std::string> changed(const Replacement& one) {
  if (is_absent(one.file)) {
    if (one.before.empty()) return std::nullopt;
    return one.file.string() + " is gone";
  }
  if (!is_plain_file(one.file))
    return one.file.string() + " is a symbolic link or no file, and is not written";
  if (content_of(one.file) != one.before) return one.file.string() + " was changed by another program";
  return std::nullopt;
}

/// New texts beside the files, which are gone with this object unless they have taken their places.
class Prepared {
 public:
  ~Prepared() {
    std::error_code ignored;
    for (const fs::path& file : beside_) fs::remove(file, ignored);
  }
  Prepared() = default;
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  void add(const Replacement& one) {
    fs::path beside = one.file.parent_path() /
                      ("." + one.file.filename().string() + "." + std::to_string(getpid()) + ".new");
    beside_.push_back(beside);
    write_file(beside, one.after);
    std::error_code ignored;
    const fs::perms mode =
        is_absent(one.file) ? fs::perms(0644) : fs::status(one.file, ignored).permissions();
    fs::permissions(beside, mode, ignored);
  }

  /// Gives the text of `one` its place, which is the number `at` of those added.
  void take(const Replacement& one, std::size_t at) { fs::rename(beside_[at], one.file); }

 private:
  std::vector<fs::path> beside_;
};

/// Gives files their texts from before. fresh: whether each was absent.
void restore(const std::vector<Replacement>& files, const std::vector<bool>& fresh) {
  for (std::size_t at = 0; at < fresh.size(); ++at) {
    std::error_code ignored;
    if (fresh[at])
      fs::remove(files[at].file, ignored);
    else
      write_file(files[at].file, files[at].before);
  }
}

}  // namespace

bool is_code(const fs::path& file) {
  constexpr std::array<std::string_view, 7> endings{".cpp", ".cc", ".cxx", ".hpp", ".hh", ".hxx", ".h"};
  return std::ranges::count(endings, file.extension().string()) > 0;
}

std::vector<fs::path> user_sources(const fs::path& project) {
  if (project.empty()) return {};
  std::vector<fs::path> files;
  add_code(project / "src", files);
  add_code(project / "test", files);
  const fs::path parameters = project / file_names::parameters;
  if (is_plain_file(parameters)) files.push_back(parameters);
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> files_with_names(const fs::path& project) {
  std::vector<fs::path> files = user_sources(project);
  const fs::path layout = project / file_names::layout;
  if (!project.empty() && is_plain_file(layout)) files.insert(files.begin(), layout);
  return files;
}

std::optional<std::string> replace_together(const fs::path& project, const std::vector<Replacement>& all) {
  const ChangeLock lock(project);
  std::vector<Replacement> files;
  std::vector<bool> fresh;  // of those that have their new text
  try {
    for (const Replacement& one : all) {
      if (std::optional<std::string> problem = changed(one)) return problem;
      if (one.after != one.before || is_absent(one.file)) files.push_back(one);
    }
    Prepared prepared;
    for (const Replacement& one : files) prepared.add(one);
    for (const Replacement& one : files) {
      std::optional<std::string> problem = changed(one);
      if (problem) {
        restore(files, fresh);
        return problem;
      }
      const bool absent = is_absent(one.file);
      prepared.take(one, fresh.size());
      fresh.push_back(absent);
    }
  } catch (const std::exception& failure) {
    std::string problem = failure.what();
    try {
      restore(files, fresh);
    } catch (const std::exception& second) {
      problem += std::string("; and a file has its new text already, since ") + second.what();
    }
    return problem;
  }
  return std::nullopt;
}

}  // namespace tessera::project
