#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "ros2/dds/endpoint.hpp"

namespace tessera::ros2 {

/// The longest time that the end of a run waits until the other side has received the last message.
inline constexpr Duration longest_goodbye = std::chrono::milliseconds(500);

/// A client or server of a service. The receptor and the effector of an agent that name the same service and
/// the same role share one.
struct ServiceSetup {
  EndpointSetup endpoint;  ///< its topic is the name of the service
  std::string type;        ///< "std_srvs/srv/SetBool"
  bool is_client = false;
  Duration timeout{};
};

/// The two endpoints of a client or server, as rmw_cyclonedds_cpp makes them: their user data identifies them
/// ("clientid=...;", "serviceid=...;").
///
/// Other implementations of ROS 2 use the same topics and types, but send no header in the message. Their
/// bytes, read in our form, would be wrong values, and the reverse. The user data tells them apart.
///
/// Threads: one at a time.
class ServiceEnds {
 public:
  /// Throws std::runtime_error.
  explicit ServiceEnds(const ServiceSetup& setup);

  [[nodiscard]] bool write(std::span<const std::byte> message);
  /// Whether all matched readers have received everything within this time.
  [[nodiscard]] bool await_receipt(Duration timeout) const { return writer_->await_receipt(timeout); }
  struct Taken {
    std::vector<std::byte> message;
    dds_instance_handle_t writer = 0;
  };
  /// The messages since the last call, the oldest first.
  [[nodiscard]] std::vector<Taken> take() const;
  [[nodiscard]] std::uint64_t identity() const { return writer_->identity(); }

  /// For a client: the number of servers that receive a request and can reply to us.
  struct Servers {
    std::size_t ready = 0;
    bool foreign = false;  ///< some server would misread a request
  };
  [[nodiscard]] Servers servers() const;
  /// For a server: the number of other servers that were found since the last call.
  [[nodiscard]] std::size_t new_other_servers() { return writer_->new_other_writers().size(); }
  /// For a server: the client with that writer, which may have left; nullopt: it is no client of this kind.
  [[nodiscard]] std::optional<std::string> client_of(dds_instance_handle_t writer) const;
  /// Whether that client still exists.
  [[nodiscard]] bool is_there(dds_instance_handle_t writer) const;
  /// Whether that client receives a reply.
  [[nodiscard]] bool hears(const std::string& client) const;

 private:
  std::optional<Endpoint> writer_, reader_;
};

/// The common part of a client and a server: the drivers of a service share one.
///
/// Threads: any.
class SharedService {
 public:
  /// Zero keeps the present timeout.
  void use_timeout(Duration timeout);
  /// Opens the service; for the second driver of it, it is open already. Throws std::runtime_error.
  void open();

 protected:
  SharedService(const ServiceSetup& setup, Duration timeout) : timeout_(timeout), setup_(setup) {}
  /// Whether the driver that closes the service is the last one. Precondition: the mutex is locked.
  [[nodiscard]] bool is_last_to_close() { return users_ > 0 && --users_ == 0 && ends_; }
  /// Prints a warning the first times.
  void warn(std::uint64_t& count, const char* text) const;

  std::mutex mutex_;
  Duration timeout_;
  std::optional<ServiceEnds> ends_;

 private:
  const ServiceSetup setup_;
  int users_ = 0;
};

/// The object that the drivers of that service and role share in an agent of this process.
template <class Service>
[[nodiscard]] std::shared_ptr<Service> shared_service(const ServiceSetup& setup) {
  static std::mutex mutex;
  static std::map<std::tuple<std::string, std::string, Network>, std::weak_ptr<Service>> known;
  const std::lock_guard lock(mutex);
  const EndpointSetup& endpoint = setup.endpoint;
  std::weak_ptr<Service>& one =
      known[{endpoint.path.substr(0, endpoint.path.find('.')), endpoint.topic, endpoint.network}];
  std::shared_ptr<Service> shared = one.lock();
  if (shared == nullptr) one = shared = std::make_shared<Service>(setup);
  shared->use_timeout(setup.timeout);
  return shared;
}

}  // namespace tessera::ros2
