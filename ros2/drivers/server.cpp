#include "ros2/drivers/server.hpp"

#include <utility>

namespace tessera::ros2 {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_waiting = 64;

}  // namespace

void ServiceServer::close(Duration goodbye) {
  const std::lock_guard lock(mutex_);
  if (!is_last_to_close()) return;
  progress();
  if (goodbye > Duration::zero()) static_cast<void>(ends_->await_receipt(goodbye));
  current_.reset();
  reply_.clear();
  waiting_.clear();
  ends_.reset();
}

std::optional<ServiceServer::Request> ServiceServer::next_request() {
  const std::lock_guard lock(mutex_);
  progress();
  while (!current_ && !waiting_.empty()) {
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    if (Clock::now() >= current_->until) {
      warn(unanswered_, "a request was dropped: its time is up, and it has no reply");
      current_.reset();
      continue;
    }
    return Request{++number_, current_->message};
  }
  return std::nullopt;
}

void ServiceServer::drop(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  if (current_ && number == number_) current_.reset();
  warn(strange_, "a request was dropped: it is none of that type, or does not fit the buffer");
}

bool ServiceServer::reply(std::uint64_t number, std::vector<std::byte> message) {
  const std::lock_guard lock(mutex_);
  refused_ = false;
  if (number != 0 && current_ && number == number_ && reply_.empty()) {
    reply_ = std::move(message);
  } else if (number != 0 && number != told_) {  // an effector may write the same reply several times
    warn(useless_, "a reply was dropped: its call is over, or there was none of that number");
  }
  if (number != 0) told_ = number;
  progress();
  return !refused_;
}

/// Precondition of this and the following: the mutex is locked.
void ServiceServer::progress() {
  if (!ends_) return;
  for (std::size_t others = ends_->new_other_servers(); others > 0; --others)
    warn(several_, "another server executes the requests, too, and clients take the first reply");
  take_requests();
  if (current_ && !reply_.empty()) send_reply();
  if (!current_ || Clock::now() < current_->until) return;
  if (reply_.empty())
    warn(unanswered_, "a request was dropped: its time is up, and it has no reply");
  else
    warn(unheard_, "a reply was dropped: its client cannot be reached");
  current_.reset();
  reply_.clear();
}

void ServiceServer::take_requests() {
  ServiceEnds::Requests requests = ends_->take_requests();
  for (; requests.foreign > 0; --requests.foreign) warn(foreign_, foreign_request);
  for (ServiceEnds::Request& one : requests.all) {
    if (waiting_.size() >= most_waiting)
      warn(crowded_, "a request was dropped: too many wait");
    else
      waiting_.push_back(Waiting{std::move(one.asker), Clock::now() + timeout_, std::move(one.message)});
  }
}

void ServiceServer::send_reply() {
  const ServiceEnds::Sending sending = ends_->send_reply(current_->asker, reply_);
  if (sending == ServiceEnds::Sending::not_yet) return;
  refused_ = sending == ServiceEnds::Sending::refused;
  if (sending == ServiceEnds::Sending::impossible)
    warn(unanswerable_, "a reply was dropped: the library libtessera_ros2_fast.so cannot be used");
  if (sending == ServiceEnds::Sending::gone) warn(unheard_, "a reply was dropped: its client has gone");
  current_.reset();
  reply_.clear();
}

}  // namespace tessera::ros2
