#include "server/analysis/spec_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "project/files/files.hpp"

namespace tessera::server {

namespace {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool valid() const { return number_ >= 0; }

 private:
  int number_;
};

std::string reason() { return std::strerror(errno); }

SpecFile::Content unreadable(std::string why) { return {{}, {}, std::move(why)}; }

SpecFile::Content missing() { return {{}, revision_of({}), std::strerror(ENOENT)}; }

/// Why it must not be replaced by a text that is told as JSON: there, the bytes look different. nullopt: it may.
std::optional<std::string> not_shown(const SpecFile::Content& content) {
  if (content.revision.empty()) return content.error;
  const std::optional<std::size_t> byte = diagnostics::first_invalid_byte(content.text);
  if (!byte) return std::nullopt;
  const auto line =
      1 + std::count(content.text.begin(), content.text.begin() + static_cast<std::ptrdiff_t>(*byte), '\n');
  return fmt::format("a byte in line {} is not UTF-8, and would be lost; save it in the encoding UTF-8 first",
                     line);
}

}  // namespace

std::string revision_of(std::string_view text) { return project::hash_of(text); }

SpecFile::SpecFile(std::filesystem::path file)
    : path_(std::move(file)),
      name_(path_.filename().string()),
      folder_(open(path_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_ < 0) throw std::runtime_error(fmt::format("{}: {}", path_.parent_path().string(), reason()));
}

SpecFile::~SpecFile() { close(folder_); }

SpecFile::Content SpecFile::read() const {
  const Descriptor file(openat(folder_, name_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
  if (!file.valid() && errno == ENOENT) return missing();
  if (!file.valid())
    return unreadable(errno == ELOOP ? "it is a symbolic link now, which is not followed" : reason());
  struct stat status {};
  if (fstat(file.get(), &status) != 0) return unreadable(reason());
  if (!S_ISREG(status.st_mode)) return unreadable("it is no file");
  Content content;
  std::array<char, 65536> piece{};
  for (;;) {
    const ssize_t count = ::read(file.get(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return unreadable(reason());
    if (count == 0) break;
    content.text.append(piece.data(), static_cast<std::size_t>(count));
    if (content.text.size() > largest) return unreadable("it is larger than 8 MB");
  }
  content.revision = revision_of(content.text);
  return content;
}

SpecFile::Outcome SpecFile::write_shown(std::string_view text, std::string_view revision) {
  if (std::optional<std::string> why = not_shown(read()))
    return {Written::failed, unreadable(std::move(*why))};
  return write(text, revision);
}

SpecFile::Outcome SpecFile::write(std::string_view text, std::string_view revision) {
  const std::lock_guard lock(writing_);
  const auto failed = [&](std::string why) { return Outcome{Written::failed, unreadable(std::move(why))}; };
  Content now = read();
  if (now.revision.empty()) return failed(std::move(now.error));
  if (now.revision != revision) return {Written::conflict, std::move(now)};
  struct stat status {};
  const mode_t mode =
      fstatat(folder_, name_.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 ? status.st_mode & 0777U : 0644;
  if (S_ISLNK(status.st_mode)) return failed("it is a symbolic link now, which is not followed");
  const std::string beside = fmt::format(".{}.{}", name_, getpid());
  unlinkat(folder_, beside.c_str(), 0);  // left by an earlier process with the same id
  {
    const Descriptor file(
        openat(folder_, beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
    if (!file.valid()) return failed(reason());
    if (!project::write_all(file.get(), text) || fsync(file.get()) != 0) {
      std::string why = reason();
      unlinkat(folder_, beside.c_str(), 0);
      return failed(std::move(why));
    }
  }
  if (Content last = read(); last.revision != revision) {  // another editor was faster
    unlinkat(folder_, beside.c_str(), 0);
    return {Written::conflict, std::move(last)};
  }
  if (renameat(folder_, beside.c_str(), folder_, name_.c_str()) != 0) return failed(reason());
  return {Written::yes, {std::string(text), revision_of(text), {}}};
}

}  // namespace tessera::server
