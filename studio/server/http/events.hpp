#pragma once

#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace tessera::server {

/// Distributes events to all browsers. A publisher never waits for a browser: one that does not keep up is
/// disconnected. It connects again and asks for the current state.
///
/// Threads: any.
class Events {
 public:
  class Subscription {
   public:
    /// Waits for events, then a little for more, and returns the text of all of them. After ten seconds
    /// without an event it returns a comment, so that a dead connection is noticed. Empty: there will be no
    /// more events.
    [[nodiscard]] std::string next();

   private:
    friend class Events;
    explicit Subscription(Events& events) : events_(events) {}
    Events& events_;
    std::string waiting_;
    bool dropped_ = false;
  };

  static constexpr std::size_t most_subscribers = 32;
  static constexpr std::size_t most_waiting_bytes = std::size_t{8} << 20U;

  /// json: one line.
  void publish(std::string_view event, std::string_view json);
  /// Adds a subscription whose first event is `first`. nullptr: there are too many already.
  [[nodiscard]] std::shared_ptr<Subscription> subscribe(std::string_view first_event, std::string_view json);
  [[nodiscard]] bool has_subscribers() const;
  /// Ends every subscription. There will be no more.
  void close();

 private:
  void leave(Subscription* subscription);

  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::list<Subscription*> subscriptions_;
  bool closed_ = false;
};

}  // namespace tessera::server
