#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "ros2/dds/blob.hpp"
#include "ros2/dds/domain.hpp"
#include "ros2/dds/other_writers.hpp"
#include "ros2/naming/names.hpp"
#include "tessera/time.hpp"

namespace tessera::ros2 {

/// The parameters of an endpoint of a topic.
struct EndpointSetup {
  std::string path;                 ///< path of the driver, for messages
  std::string topic;                ///< "/cmd_vel"
  std::string dds_topic, dds_type;  ///< as DDS names them
  std::string user_data{};          ///< the text about the endpoint that the other side receives
  std::string node;                 ///< its full name: "/robot", "/left/robot"
  Qos qos;
  Network network;
  bool sole_writer = false;  ///< whether a writer looks for others of its topic
  /// A reader calls it when a message has come, in a thread of DDS. It must not block, and not use the endpoint.
  std::function<void()> on_message{};
};

/// A writer or reader of a ROS 2 topic. If the quality of service of the other side is incompatible with
/// ours, the next read or write prints a warning with the values of both sides, once for each difference.
///
/// Threads: one at a time.
class Endpoint {
 public:
  /// Throws std::runtime_error.
  Endpoint(const EndpointSetup& setup, bool writes);
  ~Endpoint();
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;

  /// Whether an endpoint of the other side is matched now.
  [[nodiscard]] bool has_other_side() const;
  /// Whether the other side was found within this time.
  [[nodiscard]] bool await_other_side(Duration timeout) const;
  /// For a writer. false: DDS refused.
  [[nodiscard]] bool write(std::span<const std::byte> message);
  /// For a reliable writer: whether all matched readers have received everything within this time.
  [[nodiscard]] bool await_receipt(Duration timeout) const;
  /// For a reader: gives the messages that came since the last call, the oldest first.
  void take(void (*use)(void* context, const TakenBlob& blob), void* context) const;

  /// A matched endpoint of the other side. DDS does not report one that has left meanwhile.
  struct Other {
    dds_instance_handle_t handle = 0;
    std::string user_data{};
    Guid guid{};
  };
  [[nodiscard]] std::vector<Other> others() const;
  /// For a reader: the user data of a writer that it has found. A message may be read after its writer has
  /// left. nullopt: it was never found.
  [[nodiscard]] std::optional<std::string> user_data_of(dds_instance_handle_t writer) const;
  /// For a sole writer: the other writers of its topic that were found since the last call.
  [[nodiscard]] std::vector<OtherWriters::Writer> new_other_writers();
  /// From now on, a writer of this participant is not another one.
  void take_for_ours(const Guid& writer);
  /// A number that no other writer or reader has.
  [[nodiscard]] std::uint64_t identity() const;
  [[nodiscard]] Guid guid() const;
  /// Prints why endpoints of the other side cannot be matched, as far as it was not printed yet. Whether there
  /// is such an endpoint.
  bool tell_of_misfits() const;
  [[nodiscard]] const Participant& participant() const { return *participant_; }

 private:
  /// The state that listeners use; its address stays the same.
  struct ListenerState {
    std::string path, topic, dds_topic, dds_type;
    bool remembers;  ///< whether it keeps the writers that were found
    std::function<void()> on_message;
    std::atomic<bool> misfit{false};  ///< an incompatible endpoint was found that nothing was printed about
    std::mutex mutex{};
    std::map<dds_instance_handle_t, std::string> found{};
    std::set<std::string> told{};  ///< what was printed about misfits
  };
  static void remember(dds_entity_t reader, dds_instance_handle_t writer, ListenerState& state);
  void look_for_other_writers(const EndpointSetup& setup);
  void tell_if_misfit() const {
    if (state_->misfit.exchange(false)) static_cast<void>(tell_of_misfits());
  }

  std::shared_ptr<Participant> participant_;
  std::unique_ptr<ListenerState> state_;
  BlobTopic topic_;
  dds_entity_t entity_ = 0;
  std::optional<OtherWriters> other_writers_;
  bool writes_;
  std::size_t depth_;
};

}  // namespace tessera::ros2
