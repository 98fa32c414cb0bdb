#pragma once

#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace tessera::server {

/// What happens, on its way to all browsers. Nobody who publishes ever waits for one that listens: a browser
/// that does not keep up is dropped, connects again and asks for what is now.
///
/// Threads: any.
class Events {
 public:
  class Subscription {
   public:
    /// Waits for events, then a little for more; the text of all of them. Nothing happens for ten seconds: a
    /// comment, so that a connection that is dead is noticed. Empty: no more events come.
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
  /// The first event of the new one is `first`. nullptr: there are too many already.
  [[nodiscard]] std::shared_ptr<Subscription> subscribe(std::string_view first_event, std::string_view json);
  [[nodiscard]] bool has_subscribers() const;
  /// Every subscription ends; there will be no more.
  void close();

 private:
  void leave(Subscription* subscription);

  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::list<Subscription*> subscriptions_;
  bool closed_ = false;
};

}  // namespace tessera::server
