#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ros2/codec/request_header.hpp"
#include "ros2/dds/service_ends.hpp"

namespace tessera::ros2 {

/// One request after the other: the next one is given when the last one was answered, or its time is up. So
/// no request is lost in a buffer that a newer one overwrites.
///
/// Threads: any.
class ServiceServer {
 public:
  explicit ServiceServer(const ServiceSetup& setup) : setup_(setup) {}
  /// Zero changes nothing.
  void use_timeout(Duration timeout);

  /// The second driver opens what the first has opened. Throws std::runtime_error.
  void open();
  /// When the last driver closes it, it waits up to half a second until the client has got the last reply.
  void close();

  struct Request {
    std::uint64_t number = 0;  ///< 1, 2, 3 ...
    std::vector<std::byte> message{};
  };
  /// nullopt: none has come, or one is being answered.
  [[nodiscard]] std::optional<Request> next_request();
  /// The request is not one of the type of the service: it gets no reply.
  void drop(std::uint64_t number);
  /// A reply to the request of that number. 0, and a number whose request was answered, do nothing.
  /// false: DDS refused.
  [[nodiscard]] bool reply(std::uint64_t number, std::vector<std::byte> message);

 private:
  using Instant = std::chrono::steady_clock::time_point;
  struct Waiting {
    RequestHeader header{};
    std::string client{};
    dds_instance_handle_t writer = 0;
    Instant until{};
    std::vector<std::byte> message{};
  };
  void take_requests();
  void progress();
  void send_reply();
  void warn(std::uint64_t& count, const char* text) const;

  const ServiceSetup setup_;
  std::mutex mutex_;
  Duration timeout_ = std::chrono::seconds(10);
  std::optional<ServiceEnds> ends_;
  int users_ = 0;
  bool refused_ = false;
  std::deque<Waiting> waiting_;
  std::optional<Waiting> current_;
  std::vector<std::byte> reply_;  ///< to the current request; empty: there is none yet
  std::uint64_t number_ = 0;      ///< of the newest request that was given
  std::uint64_t told_ = 0;
  std::uint64_t foreign_ = 0, strange_ = 0, crowded_ = 0, unanswered_ = 0, unheard_ = 0, useless_ = 0;
};

}  // namespace tessera::ros2
