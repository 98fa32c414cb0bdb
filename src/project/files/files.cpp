#include "project/files/files.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tessera/net_hash.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& file, int problem) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), std::strerror(problem)));
}

}  // namespace

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();  // in blocks: programs are hashed, too
  return std::move(text).str();
}

void write_file(const fs::path& file, std::string_view text) {
  static std::atomic<unsigned> number{0};
  std::error_code problem;
  const fs::path target = fs::is_symlink(file, problem) ? fs::weakly_canonical(file, problem) : file;
  fs::create_directories(target.parent_path(), problem);
  if (problem) fail(file, problem.value());
  struct stat status {};
  const bool exists = stat(target.c_str(), &status) == 0;
  const fs::path beside =
      target.parent_path() / fmt::format(".{}.{}.{}", target.filename().string(), getpid(), ++number);
  unlink(beside.c_str());  // left by an earlier process with the same id
  const int descriptor = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(file, errno);
  int wrong = write_all(descriptor, text) ? 0 : errno;
  if (wrong == 0 && exists && fchmod(descriptor, status.st_mode & 07777U) != 0) wrong = errno;
  if (close(descriptor) != 0 && wrong == 0) wrong = errno;
  if (wrong == 0 && rename(beside.c_str(), target.c_str()) != 0) wrong = errno;
  if (wrong == 0) return;
  unlink(beside.c_str());
  fail(file, wrong);
}

namespace {

/// Returns an error number; 0: all bytes are copied.
int copy_bytes(int from, int to) {
  std::array<char, std::size_t{1} << 16U> block;
  for (;;) {
    const ssize_t count = ::read(from, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) return 0;
    if (!write_all(to, {block.data(), static_cast<std::size_t>(count)})) return errno;
  }
}

}  // namespace

// std::filesystem::copy_file reports a full disk as an "Input/output error".
void copy_whole(const fs::path& from, const fs::path& to) {
  const int source = open(from.c_str(), O_RDONLY | O_CLOEXEC);
  if (source < 0)
    throw std::runtime_error(fmt::format("cannot read {}: {}", from.string(), std::strerror(errno)));
  struct stat status {};
  int wrong = fstat(source, &status) == 0 ? 0 : errno;
  if (wrong == 0 && unlink(to.c_str()) != 0 && errno != ENOENT) wrong = errno;
  const int target =
      wrong != 0 ? -1 : open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, status.st_mode & 07777U);
  if (wrong == 0 && target < 0) wrong = errno;
  if (target >= 0) {
    wrong = copy_bytes(source, target);
    if (wrong == 0 && fchmod(target, status.st_mode & 07777U) != 0) wrong = errno;
    if (close(target) != 0 && wrong == 0) wrong = errno;
    if (wrong != 0) unlink(to.c_str());
  }
  close(source);
  if (wrong != 0) fail(to, wrong);
}

std::string hash_of(std::string_view text) {
  NetHash hash;
  hash.place(text, 0);
  return hash.hex();
}

bool is_inside(const fs::path& folder, const fs::path& relative) {
  if (relative.empty() || relative.is_absolute()) return false;
  fs::path at = folder;
  for (const fs::path& part : relative) {
    if (part == "..") return false;
    at /= part;
    std::error_code ignored;
    if (fs::symlink_status(at, ignored).type() == fs::file_type::symlink) return false;
  }
  return true;
}

bool contains(const fs::path& folder, const fs::path& path) {
  const fs::path inner = fs::weakly_canonical(fs::absolute(path)), outer = fs::weakly_canonical(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace tessera::project
