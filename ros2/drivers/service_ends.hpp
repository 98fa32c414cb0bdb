#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "ros2/codec/request_header.hpp"
#include "ros2/codec/seen_requests.hpp"
#include "ros2/dds/endpoint.hpp"
#include "ros2/dds/fast_library.hpp"

namespace tessera::ros2 {

/// The warning about a request whose asker cannot be told from its datagram.
inline constexpr const char* foreign_request =
    "a request was dropped: its client is not one of rmw_cyclonedds_cpp or rmw_fastrtps_cpp, see \"Which ROS "
    "2\" in "
    "docs/use/ros2.md";

/// The longest time that the end of a run waits until the other side has received the last message.
inline constexpr Duration longest_goodbye = std::chrono::milliseconds(500);

/// A client or server of a service or action. The receptor and the effector of an agent that name the same service and
/// the same role share one.
struct ServiceSetup {
  EndpointSetup endpoint;  ///< its topic is the name of the service or action
  std::string type;        ///< "std_srvs/srv/SetBool"
  bool is_client = false;
  Duration timeout{};
  const char* kind = "service";  ///< for messages: "service", "action"
  bool one_at_a_time = true;     ///< whether a new request of a client takes the place of the one before it
};
/// DDS takes a process that was killed for alive until its lease ends (10 s in Cyclone DDS, 20 s in Fast DDS).
inline constexpr const char* several_servers =
    "several servers are known: each that is alive executes this, and the first answer counts; one that was "
    "killed is forgotten after 20 s";
/// Counts an event and prints a warning the 1st, 10th, 100th time and so on.
void warn_of(const ServiceSetup& setup, std::uint64_t& count, const char* text);

/// The two endpoints of a client or server, as rmw_cyclonedds_cpp makes them: their user data identifies them
/// ("clientid=...;", "serviceid=...;").
///
/// The other side may run rmw_fastrtps_cpp instead, which uses the same topics and types, but puts the identity
/// of a request beside the message, not before it. A message in the form of the other would be wrong values.
/// So each side is recognised: by the user data; else by a GUID of Fast DDS (servers), or by the identity beside
/// the request (clients). Nothing is sent to an endpoint of neither kind, or to servers of both kinds.
/// With the library for Fast DDS, the messages to and from such sides go by Fast DDS. Requests may come both ways.
///
/// Threads: one at a time.
class ServiceEnds {
 public:
  /// Throws std::runtime_error.
  explicit ServiceEnds(const ServiceSetup& setup);

  /// Whether all matched readers have received everything within this time.
  [[nodiscard]] bool await_receipt(Duration timeout);

  /// For a client: sends a request, with encapsulation and without a header. Gives its number, which its reply
  /// has, too. nullopt: DDS refused.
  [[nodiscard]] std::optional<std::int64_t> send_request(std::vector<std::byte> request);
  struct Reply {
    std::int64_t number = 0;  ///< of its request
    std::vector<std::byte> message{};
  };
  struct Replies {
    std::vector<Reply> ours{};  ///< the oldest first; those to other clients are left out
    std::size_t strange = 0;    ///< without an identity
  };
  /// For a client: what came since the last call.
  [[nodiscard]] Replies take_replies();

  /// The origin of a request.
  struct Asker {
    RequestHeader header{};
    std::string client{};
    dds_instance_handle_t writer = 0;       ///< 0: the request came by Fast DDS
    std::optional<RelatedIdentity> fast{};  ///< for a client of rmw_fastrtps_cpp, instead of the first two
  };
  struct Request {
    Asker asker{};
    std::vector<std::byte> message{};
  };
  struct Requests {
    std::vector<Request> all{};  ///< the oldest first
    std::size_t foreign = 0;     ///< of clients of another kind, or without an identity
  };
  /// For a server: what came since the last call.
  [[nodiscard]] Requests take_requests();
  enum class Sending : std::uint8_t {
    sent,
    not_yet,    ///< the client exists, and does not hear us yet
    gone,       ///< the client has left
    refused,    ///< by DDS
    impossible  ///< there is no library for that kind of client
  };
  /// For a server: sends a reply, with encapsulation and without a header, if the client hears it.
  [[nodiscard]] Sending send_reply(const Asker& asker, std::vector<std::byte> reply);

  /// For a client: the number of servers that receive a request and can reply to us.
  struct Servers {
    std::size_t ready = 0;
    bool foreign = false;  ///< some server would misread a request
    bool fast = false;     ///< those that are ready run rmw_fastrtps_cpp
  };
  [[nodiscard]] Servers servers();
  /// For a server: the number of other servers that were found since the last call.
  [[nodiscard]] std::size_t new_other_servers();

 private:
  struct Taken {
    std::vector<std::byte> message;
    dds_instance_handle_t writer = 0;
    std::optional<BesideMessage> beside{};
  };
  /// The messages since the last call, the oldest first.
  [[nodiscard]] std::vector<Taken> take() const;
  /// The client with that writer, which may have left; nullopt: it is no client of this kind.
  [[nodiscard]] std::optional<std::string> client_of(dds_instance_handle_t writer) const;
  /// The servers as Cyclone DDS finds them.
  [[nodiscard]] Servers found_servers() const;
  /// Whether that client still exists.
  [[nodiscard]] bool is_there(const Asker& asker);
  /// Whether that client receives a reply.
  [[nodiscard]] bool hears(const std::string& client) const;

  /// Begins to load the library as soon as a client seems to run rmw_fastrtps_cpp: the client has to find its
  /// writer before it can be answered.
  void look_for_fast_clients();
  /// Begins to load the library for clients of rmw_fastrtps_cpp. Whether that has failed; a warning says so.
  [[nodiscard]] bool cannot_answer_fast_clients();
  [[nodiscard]] Sending send_fast_reply(const Asker& asker, const std::vector<std::byte>& reply);

  std::optional<Endpoint> writer_, reader_;
  std::int64_t newest_request_ =
      0;  ///< of those by Cyclone DDS: also the sequence number of its datagram, as a writer of DDS counts
  std::string path_;
  FastSetup fast_setup_;
  FastLibrary fast_library_;
  SeenRequests seen_;
  bool fast_known_ = false, fast_begun_ = false;
  std::chrono::steady_clock::time_point next_look_{};
  std::uint64_t unanswerable_ = 0;
};

/// One side of a service or action, which its drivers share. Ends: its endpoints, made of a ServiceSetup.
///
/// Threads: any.
template <class Ends>
class Shared {
 public:
  /// Zero keeps the present timeout.
  void use_timeout(Duration timeout) {
    const std::lock_guard lock(mutex_);
    if (timeout > Duration::zero()) timeout_ = timeout;
  }
  /// Opens it; for the second driver, it is open already. Throws std::runtime_error.
  void open() {
    const std::lock_guard lock(mutex_);
    if (!ends_) {
      ServiceSetup setup = setup_;
      setup.timeout = timeout_;
      ends_.emplace(setup);
    }
    ++users_;
  }

 protected:
  Shared(const ServiceSetup& setup, Duration timeout) : timeout_(timeout), setup_(setup) {}
  /// Whether the driver that closes it is the last one. Precondition: the mutex is locked.
  [[nodiscard]] bool is_last_to_close() { return users_ > 0 && --users_ == 0 && ends_; }
  /// Prints a warning the first times.
  void warn(std::uint64_t& count, const char* text) const { warn_of(setup_, count, text); }

  std::mutex mutex_;
  Duration timeout_;
  std::optional<Ends> ends_;

 private:
  const ServiceSetup setup_;
  int users_ = 0;
};
using SharedService = Shared<ServiceEnds>;

/// The object that the drivers of that service or action and role share in an agent of this process.
template <class Service>
[[nodiscard]] std::shared_ptr<Service> shared_side(const ServiceSetup& setup) {
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
