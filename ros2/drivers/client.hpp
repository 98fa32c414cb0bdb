#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "ros2/drivers/service_ends.hpp"

namespace tessera::ros2 {

/// The outcome of a call: the field `outcome` of the receptor's buffer (docs/use/ros2.md).
enum class CallOutcome : std::uint8_t {
  answered = 1,
  no_server = 2,   ///< the request was not sent: no server could receive it before the timeout
  no_reply = 3,    ///< it was sent, and no reply came before the timeout
  replaced = 4,    ///< a newer call has begun; the server may execute both
  unreadable = 5,  ///< the reply does not fit the buffer
};

/// Makes one call at a time. Each call has a number that is not 0; a number other than the last one begins a
/// call. A call is sent once, because a server may execute a repeated request twice.
///
/// Threads: any.
class ServiceClient : public SharedService {
 public:
  explicit ServiceClient(const ServiceSetup& setup) : SharedService(setup, std::chrono::seconds(2)) {}

  /// The close of the last driver waits up to half a second until the server has received the last request.
  void close();
  /// Whether a server is found within this time.
  [[nodiscard]] bool await_server(Duration timeout);

  /// request: with encapsulation, without a header. false: DDS refused.
  [[nodiscard]] bool call(std::uint64_t number, std::vector<std::byte> request);
  /// The same for a process that is about to end: whether a reply came within this time.
  [[nodiscard]] bool call_and_wait(std::uint64_t number, const std::vector<std::byte>& request,
                                   Duration timeout);

  struct Result {
    std::uint64_t number = 0;
    CallOutcome outcome = CallOutcome::answered;
    std::vector<std::byte> reply{};
  };
  /// From this call on, results are kept for `take_result`.
  void keep_results();
  /// The oldest result that was not taken yet. Each call has one result.
  [[nodiscard]] std::optional<Result> take_result();

 private:
  struct Pending {
    std::uint64_t number = 0;
    std::int64_t sequence = 0;
    std::vector<std::byte> request{};
    std::chrono::steady_clock::time_point until{};
    bool sent = false;
    bool told = false;  ///< whether a warning said why it is not sent
  };
  void progress();
  void take_replies();
  void try_to_send();
  void finish(CallOutcome outcome, std::vector<std::byte> reply = {});

  bool keeps_results_ = false, refused_ = false;
  std::uint64_t last_ = 0;
  std::optional<Pending> pending_;
  std::deque<Result> results_;
  std::optional<CallOutcome> newest_;
  std::uint64_t strange_ = 0, stray_ = 0, foreign_ = 0, several_ = 0, unserved_ = 0, unanswered_ = 0,
                lost_ = 0;
};

}  // namespace tessera::ros2
