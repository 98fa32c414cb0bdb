#include "system/patient_output.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <limits.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace tessera {

PatientOutput::PatientOutput(int shared) : shared_(shared) {
  struct stat status {};
  if (fstat(shared, &status) != 0) return;
  socket_ = S_ISSOCK(status.st_mode);
  file_ = S_ISREG(status.st_mode);
  if (!S_ISCHR(status.st_mode) && !S_ISFIFO(status.st_mode)) return;
  own_ = open(fmt::format("/proc/self/fd/{}", shared).c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

PatientOutput::~PatientOutput() {
  if (own_ >= 0) close(own_);
}

PatientOutput::Result PatientOutput::write(std::string_view& bytes) {
  std::size_t size = bytes.size();
  if (own_ < 0 && !socket_ && !file_) {  // poll may report room although a longer write would wait
    pollfd room{.fd = shared_, .events = POLLOUT, .revents = 0};
    if (poll(&room, 1, 0) == 0) return Result::some;
    size = std::min<std::size_t>(size, PIPE_BUF);
  }
  const ssize_t written = socket_ ? send(shared_, bytes.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL)
                                  : ::write(own_ >= 0 ? own_ : shared_, bytes.data(), size);
  if (written < 0) return errno == EAGAIN || errno == EINTR ? Result::some : Result::gone;
  bytes.remove_prefix(static_cast<std::size_t>(written));
  return bytes.empty() ? Result::all : Result::some;
}

void PatientOutput::await_room(int milliseconds) const {
  pollfd room{.fd = own_ >= 0 ? own_ : shared_, .events = POLLOUT, .revents = 0};
  poll(&room, 1, milliseconds);
}

}  // namespace tessera
