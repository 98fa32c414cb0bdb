#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "ros2/drivers/service_ends.hpp"

namespace tessera::ros2 {

/// Serves one request after the other: it gives the next one when the last was answered or has timed out. So
/// a newer request never overwrites an older one in a buffer.
///
/// Threads: any.
class ServiceServer : public SharedService {
 public:
  explicit ServiceServer(const ServiceSetup& setup) : SharedService(setup, std::chrono::seconds(10)) {}

  /// The close of the last driver waits that long until the client has received the last reply.
  void close(Duration goodbye = longest_goodbye);

  struct Request {
    std::uint64_t number = 0;  ///< 1, 2, 3 ...
    std::vector<std::byte> message{};
  };
  /// nullopt: none has arrived, or one is being answered.
  [[nodiscard]] std::optional<Request> next_request();
  /// The request does not have the type of the service: it gets no reply.
  void drop(std::uint64_t number);
  /// A reply to the request of that number. 0, and a number whose request was answered, do nothing.
  /// false: DDS refused.
  [[nodiscard]] bool reply(std::uint64_t number, std::vector<std::byte> message);

 private:
  using Instant = std::chrono::steady_clock::time_point;
  struct Waiting {
    ServiceEnds::Asker asker{};
    Instant until{};
    std::vector<std::byte> message{};
  };
  void take_requests();
  void progress();
  void send_reply();

  bool refused_ = false;
  std::deque<Waiting> waiting_;
  std::optional<Waiting> current_;
  std::vector<std::byte> reply_;  ///< to the current request; empty: there is none yet
  std::uint64_t number_ = 0;      ///< number of the newest request that was given
  std::uint64_t told_ = 0;
  std::uint64_t foreign_ = 0, strange_ = 0, crowded_ = 0, unanswered_ = 0, unheard_ = 0, useless_ = 0,
                several_ = 0, unanswerable_ = 0;
};

}  // namespace tessera::ros2
