#include "server/analysis/file_watch.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <set>
#include <string>
#include <system_error>
#include <utility>

namespace tessera::server {

FileWatch::FileWatch(const std::filesystem::path& file, std::function<void()> changed)
    : changed_(std::move(changed)),
      events_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)),
      ended_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  add(file);
  thread_ = std::thread([this] { watch(); });
}

void FileWatch::add(const std::filesystem::path& file) {
  // Watches the folder, because editors replace the file and do not write into it; of a symbolic link, also
  // that of its target.
  std::error_code missing;
  for (const std::filesystem::path& one : {file, std::filesystem::canonical(file, missing)}) {
    if (one.empty()) continue;
    inotify_add_watch(events_, one.parent_path().c_str(),
                      IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_CREATE);
    const std::lock_guard lock(mutex_);
    names_.insert(one.filename());
  }
}

FileWatch::~FileWatch() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(ended_, &one, sizeof one);
  thread_.join();
  close(events_);
  close(ended_);
}

void FileWatch::watch() {
  for (;;) {
    std::array<pollfd, 2> sources{pollfd{.fd = events_, .events = POLLIN, .revents = 0},
                                  pollfd{.fd = ended_, .events = POLLIN, .revents = 0}};
    poll(sources.data(), sources.size(), -1);
    if (sources[1].revents != 0) return;
    if (concerns()) changed_();
  }
}

/// Reads all events that are there. Returns whether one is about a file of such a name.
bool FileWatch::concerns() {
  const std::lock_guard lock(mutex_);
  bool found = false;
  alignas(inotify_event) std::array<char, 4096> bytes{};
  for (ssize_t count = 0; (count = read(events_, bytes.data(), bytes.size())) > 0;)
    for (ssize_t at = 0; at < count;) {
      inotify_event event{};
      std::memcpy(&event, bytes.data() + at, sizeof event);
      found = found || (event.mask & IN_Q_OVERFLOW) != 0 ||
              (event.len > 0 && names_.contains(bytes.data() + at + sizeof event));
      at += static_cast<ssize_t>(sizeof event + event.len);
    }
  return found;
}

}  // namespace tessera::server
