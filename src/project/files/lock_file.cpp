#include "project/files/lock_file.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <thread>
#include <utility>

#include "project/files/files.hpp"
#include "project/process/process.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

std::optional<LockFile> LockFile::try_take(const fs::path& file, Mode mode) {
  std::error_code problem;
  fs::create_directories(file.parent_path(), problem);
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0)
    throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), std::strerror(errno)));
  LockFile lock(descriptor);
  while (flock(descriptor, (mode == Mode::shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno == EWOULDBLOCK) return std::nullopt;
    throw std::runtime_error(fmt::format("cannot lock {}: {}", file.string(), std::strerror(errno)));
  }
  return lock;
}

LockFile::LockFile(LockFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

LockFile& LockFile::operator=(LockFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

LockFile::~LockFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void LockFile::write(const std::string& text) const {
  const bool written = ftruncate(descriptor_, 0) == 0 &&
                       pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  static_cast<void>(written);  // the text is only information
}

void LockFile::goes_to_children() const { fcntl(descriptor_, F_SETFD, 0); }

namespace {

/// "process 4711 (tessera simulate rover) since 12:03:04"
std::string this_process() {
  const std::string raw = content_of("/proc/self/cmdline");
  Command command;
  for (std::size_t start = 0; start < raw.size();) {
    const std::size_t end = std::min(raw.find('\0', start), raw.size());
    command.push_back(raw.substr(start, end - start));
    start = end + 1;
  }
  if (!command.empty()) command[0] = fs::path(command[0]).filename().string();
  constexpr std::size_t longest = 200;
  std::string line = shell_line(command).substr(0, longest);
  std::ranges::replace_if(
      line, [](char one) { return static_cast<unsigned char>(one) < 0x20; }, ' ');
  return fmt::format("process {} ({}) since {:%H:%M:%S}", getpid(), line, fmt::localtime(std::time(nullptr)));
}

}  // namespace

std::optional<LockFile> take_build_lock(const fs::path& state, Listener& listener,
                                        const std::atomic<bool>* stop) {
  constexpr auto pause = std::chrono::milliseconds(20);
  const fs::path file = state / "build.lock";
  Step step(listener, "waiting for another build");
  for (bool told = false; stop == nullptr || !*stop; std::this_thread::sleep_for(pause)) {
    if (std::optional<LockFile> lock = LockFile::try_take(file, LockFile::Mode::exclusive)) {
      lock->write(this_process());
      return lock;
    }
    const std::string holder = content_of(file);
    step.progress(holder);
    if (told || step.seconds() < 1) continue;
    told = true;
    listener.say(fmt::format("this project is being built by {}; waiting for it\n",
                             holder.empty() ? "another process" : holder));
  }
  return std::nullopt;
}

}  // namespace tessera::project
