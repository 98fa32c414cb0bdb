#include "bag/live_bag.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace tessera::bag {
namespace {

constexpr std::size_t read_at_once = 1U << 20U;
constexpr std::chrono::milliseconds chunk_period{1000}, look_period{50};

}  // namespace

LiveBag::LiveBag(const std::string& recording, std::string file, Background background, std::string library)
    : recording_(recording, GrowingRecording::From::oldest),
      file_(std::move(file)),
      background_(std::move(background)),
      library_(std::move(library)),
      descriptor_(::open(file_.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0)
    throw std::runtime_error(fmt::format("cannot write {}: {}", file_, std::strerror(errno)));
  // Signals are for the thread that waits for the run.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { follow(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

LiveBag::~LiveBag() {
  stops_ = true;
  if (thread_.joinable()) thread_.join();
  if (descriptor_ >= 0) close(descriptor_);
}

void LiveBag::follow() {
  auto due = std::chrono::steady_clock::now() + chunk_period;
  while (!stops_) {
    std::this_thread::sleep_for(look_period);
    while (read_on()) {
    }
    if (std::chrono::steady_clock::now() < due) continue;
    due = std::chrono::steady_clock::now() + chunk_period;
    write_chunk();
  }
}

/// false: there is no more now.
bool LiveBag::read_on() {
  const GrowingRecording::Piece piece = recording_.next(read_at_once);
  if (piece.bytes.empty()) return false;
  if (piece.begins) {
    if (reader_ != nullptr) lost_ += reader_->recording().lost;
    reader_ = std::make_unique<RecordingReader>();
  }
  if (reader_ == nullptr) return false;
  reader_->feed(piece.bytes);
  if (!reader_->has_header()) return piece.more;
  if (writer_ == nullptr) writer_ = std::make_unique<BagWriter>(reader_->recording(), background_, library_);
  for (const Recording::Entry& entry : reader_->recording().entries) {
    last_ns_ = std::max(last_ns_, entry.event.time_ns);
    writer_->add(entry);
  }
  reader_->recording().entries.clear();
  write(writer_->take());
  return piece.more;
}

void LiveBag::write_chunk() {
  if (writer_ == nullptr) return;
  writer_->close_chunk();
  write(writer_->take());
  written_ns_ = last_ns_;
}

void LiveBag::write(const std::string& bytes) {
  if (!problem_.empty()) return;
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      problem_ = fmt::format("cannot write {}: {}; it holds the run up to {:.3f} s", file_,
                             std::strerror(count == 0 ? ENOSPC : errno),
                             std::chrono::duration<double>(std::chrono::nanoseconds(written_ns_)).count());
      std::fputs(fmt::format("warning: {}, and the run goes on\n", problem_).c_str(), stderr);
      static_cast<void>(!ftruncate(descriptor_, size_));
      return;
    }
    done += static_cast<std::size_t>(count);
  }
  size_ += static_cast<std::int64_t>(bytes.size());
}

std::string LiveBag::finish() {
  stops_ = true;
  thread_.join();
  while (read_on()) {
  }
  if (writer_ == nullptr) {
    ::unlink(file_.c_str());
    return "the run left no recording, so there is no bag";
  }
  write_chunk();
  if (reader_->has_ended()) writer_->end(lost_ + reader_->recording().lost);
  writer_->finish();
  write(writer_->take());
  if (close(std::exchange(descriptor_, -1)) != 0 && problem_.empty())
    problem_ = fmt::format("cannot write {}: {}", file_, std::strerror(errno));
  return problem_;
}

}  // namespace tessera::bag
