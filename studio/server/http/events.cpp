#include "server/http/events.hpp"

#include <chrono>
#include <utility>

namespace tessera::server {

namespace {

constexpr auto batch = std::chrono::milliseconds(25);
constexpr auto silence = std::chrono::seconds(10);

std::string message(std::string_view event, std::string_view json) {
  std::string text("event: ");
  text.append(event).append("\ndata: ").append(json).append("\n\n");
  return text;
}

}  // namespace

std::string Events::Subscription::next() {
  std::unique_lock lock(events_.mutex_);
  const auto over = [this] { return events_.closed_ || dropped_; };
  if (!events_.news_.wait_for(lock, silence, [&] { return over() || !waiting_.empty(); })) return ":\n\n";
  events_.news_.wait_for(lock, batch, over);
  if (over()) return {};
  return std::exchange(waiting_, {});
}

void Events::publish(std::string_view event, std::string_view json) {
  const std::string text = message(event, json);
  {
    const std::lock_guard lock(mutex_);
    for (Subscription* one : subscriptions_) {
      one->dropped_ = one->dropped_ || one->waiting_.size() + text.size() > most_waiting_bytes;
      if (!one->dropped_) one->waiting_ += text;
    }
  }
  news_.notify_all();
}

std::shared_ptr<Events::Subscription> Events::subscribe(std::string_view first_event, std::string_view json) {
  const std::lock_guard lock(mutex_);
  if (closed_ || subscriptions_.size() >= most_subscribers) return nullptr;
  std::shared_ptr<Subscription> made(new Subscription(*this), [this](Subscription* subscription) {
    leave(subscription);
    delete subscription;
  });
  made->waiting_ = message(first_event, json);
  subscriptions_.push_back(made.get());
  return made;
}

bool Events::has_subscribers() const {
  const std::lock_guard lock(mutex_);
  return !subscriptions_.empty();
}

void Events::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  news_.notify_all();
}

void Events::leave(Subscription* subscription) {
  const std::lock_guard lock(mutex_);
  subscriptions_.remove(subscription);
}

}  // namespace tessera::server
