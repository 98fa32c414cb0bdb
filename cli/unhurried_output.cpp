#include "cli/unhurried_output.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace tessera::cli {

UnhurriedOutput::UnhurriedOutput(int descriptor, Complain complain)
    : descriptor_(descriptor), complain_(std::move(complain)) {
  // Its writes may raise signals that end or stop a process; signals of other origin go to other threads.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::thread([this] { write_all(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

UnhurriedOutput::~UnhurriedOutput() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void UnhurriedOutput::write(std::string text) {
  {
    const std::lock_guard lock(mutex_);
    if (bytes_ + text.size() > most_waiting) {
      ++left_out_;
      return;
    }
    bytes_ += text.size();
    waiting_.push_back(std::move(text));
  }
  changed_.notify_all();
}

void UnhurriedOutput::settle(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  if (!stuck_) stuck_ = !changed_.wait_for(lock, longest, [&] { return waiting_.empty() && !writing_; });
}

void UnhurriedOutput::write_all() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    std::string text = std::move(waiting_.front());
    waiting_.pop_front();
    writing_ = true;
    if (left_out_ > 0 && waiting_.empty())
      text += fmt::format("tessera: {} lines left out here: the output was blocked\n",
                          std::exchange(left_out_, 0));
    lock.unlock();
    write_one(text);
    lock.lock();
    bytes_ -= std::min(bytes_, text.size());
    if (waiting_.empty()) bytes_ = 0;
    writing_ = false;
    stuck_ = stuck_ && !waiting_.empty();
    changed_.notify_all();
  }
}

/// A piece that cannot be written is lost; a later one may find space on the disk again.
void UnhurriedOutput::write_one(const std::string& text) {
  int error = 0;
  for (std::string_view left = text; !left.empty() && error == 0;) {
    const ssize_t count = ::write(descriptor_, left.data(), left.size());
    if (count >= 0) left.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && errno == EAGAIN) {  // another program has made it non-blocking
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    } else if (count < 0 && errno != EINTR) {
      error = errno;
    }
  }
  if (error != 0 && error != error_ && complain_) complain_(std::strerror(error));
  error_ = error;
}

}  // namespace tessera::cli
