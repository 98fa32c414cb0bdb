#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "ros2/dds/endpoint.hpp"
#include "ros2/dds/other_side.hpp"
#include "ros2/tf/transform_buffer.hpp"

namespace tessera::ros2 {

/// Hears the transforms on a topic such as /tf, and on the topic of fixed ones beside it. The receptors of a node share
/// one.
///
/// Threads: any.
class TransformListener {
 public:
  /// endpoint: of the topic of moving transforms.
  explicit TransformListener(const EndpointSetup& endpoint);
  /// The listener of that node for that topic.
  [[nodiscard]] static std::shared_ptr<TransformListener> of(const EndpointSetup& endpoint);

  /// For a second receptor, it is open already. Throws std::runtime_error.
  void open();
  void close();
  /// Takes what has come, and gives the buffer to `use`. Prints warnings about what came.
  template <class Use>
  auto look(Use use) {
    const std::lock_guard lock(mutex_);
    take();
    return use(static_cast<const TransformBuffer&>(buffer_));
  }

 private:
  void take();
  void take(bool fixed, const TakenBlob& blob);
  void take(bool fixed, const StampedTransform& one, std::uint64_t publisher);
  void tell_of(const StampedTransform& one, bool fixed, const TransformBuffer::Taken& taken);
  /// Counts, and prints the text the 1st, 10th, 100th time and so on.
  void warn(std::uint64_t& count, bool fixed, const std::string& text) const;

  const EndpointSetup moving_setup_, fixed_setup_;
  std::mutex mutex_;
  TransformBuffer buffer_;
  std::optional<Endpoint> moving_, fixed_;
  std::optional<OtherSideWatch> watch_;
  int users_ = 0;
  std::uint64_t malformed_ = 0, refused_ = 0, jumps_ = 0, parents_ = 0, publishers_ = 0, kinds_ = 0;
};

/// How an endpoint of such a topic is made: reliable, and transient local for fixed transforms.
[[nodiscard]] EndpointSetup transform_endpoint(EndpointSetup endpoint, const std::string& topic, int depth);

}  // namespace tessera::ros2
