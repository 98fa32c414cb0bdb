#include "ros2/drivers/transform_drivers.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "ros2/codec/written_mapping.hpp"
#include "ros2/dds/clock.hpp"
#include "ros2/drivers/prepared.hpp"
#include "ros2/drivers/transform_listener.hpp"
#include "ros2/tf/missing_transform.hpp"
#include "ros2/tf/taken_stamps.hpp"
#include "ros2/tf/tf_message.hpp"
#include "ros2/tf/transform_value.hpp"

namespace tessera::ros2 {
namespace {

/// As tf2_ros broadcasts.
constexpr int broadcast_moving_depth = 100, broadcast_fixed_depth = 1;
constexpr Duration longest_broadcast_receipt = std::chrono::milliseconds(500);
constexpr Duration guardian_finds_listener_within = std::chrono::seconds(4);

constexpr std::int64_t ns_of_a_second = 1'000'000'000;

Stamp stamp_of_ns(std::int64_t ns) {
  return {static_cast<std::int32_t>(ns / ns_of_a_second), static_cast<std::uint32_t>(ns % ns_of_a_second)};
}
std::int64_t ns_of(const Stamp& stamp) { return stamp.sec * ns_of_a_second + stamp.nanosec; }

class TransformReceptor final : public RealReceptor {
 public:
  TransformReceptor(Prepared prepared, const Ros2Binding& binding)
      : prepared_(std::move(prepared)),
        frame_(binding.frame),
        in_(binding.in),
        at_(binding.at),
        stamps_(at_.empty() ? nullptr : TakenStamp::of(beside(binding.path, at_))),
        listener_(TransformListener::of(prepared_.endpoint)) {}

  [[nodiscard]] bool open() override {
    listener_->open();
    const std::string& topic = prepared_.endpoint.topic;
    missing_.emplace(frame_, in_, at_, topic + " and " + static_topic_of(topic),
                     MissingTransform::Clock::now());
    await_transform();
    return true;
  }
  void close() override { listener_->close(); }

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    return listener_->look([&](const TransformBuffer& buffer) {
      const TransformBuffer::Answer answer = stamps_ == nullptr ? buffer.latest(frame_, in_) : wanted(buffer);
      if (const auto text = missing_->look(answer, MissingTransform::Clock::now(), buffer))
        std::fprintf(stderr, "warning: %s: %s\n", prepared_.endpoint.path.c_str(), text->c_str());
      return answer.outcome == TransformBuffer::Answer::Outcome::found && is_wanted(answer, buffer) &&
             prepared_.translator.decode(transform_message(answer.transform, stamp_of_ns(answer.stamp_ns)),
                                         value_) == Translator::Outcome::good &&
             prepared_.encoding->take(value.data(), value_);
    });
  }

 private:
  /// "robot.eyes.scan" for "robot.eyes.pose" and "scan".
  static std::string beside(const std::string& path, const std::string& buffer) {
    return path.substr(0, path.rfind('.') + 1) + buffer;
  }

  /// The transform at the newest stamp of the other buffer at which there is one. A message often comes before the
  /// transforms of its time.
  TransformBuffer::Answer wanted(const TransformBuffer& buffer) {
    constexpr std::size_t most_stamps = 100;
    const TakenStamp::Numbered newest = stamps_->newest();
    if (newest.number != stamp_number_) pending_.push_back(ns_of(newest.stamp));
    stamp_number_ = newest.number;
    if (pending_.size() > most_stamps) pending_.pop_front();
    at_stamp_ = false;
    if (pending_.empty()) return buffer.latest(frame_, in_);
    for (std::size_t index = pending_.size(); index-- > 0;) {
      const TransformBuffer::Answer answer = buffer.at(frame_, in_, pending_[index]);
      if (answer.outcome != TransformBuffer::Answer::Outcome::found) continue;
      pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(index) + 1);
      at_stamp_ = true;
      return answer;
    }
    return buffer.at(frame_, in_, pending_.back());
  }

  [[nodiscard]] bool is_wanted(const TransformBuffer::Answer& answer, const TransformBuffer& buffer) {
    return stamps_ == nullptr ? is_new(answer, buffer) : at_stamp_;
  }

  void await_transform() {
    constexpr auto between_looks_for_it = std::chrono::milliseconds(5);
    if (prepared_.wait == Duration::zero()) return;
    const auto until = std::chrono::steady_clock::now() + prepared_.wait;
    const auto is_there = [&](const TransformBuffer& buffer) {
      return buffer.latest(frame_, in_).outcome == TransformBuffer::Answer::Outcome::found;
    };
    while (!listener_->look(is_there)) {
      if (std::chrono::steady_clock::now() >= until)
        throw std::runtime_error("there is no transform of " + frame_ + " in " + in_);
      std::this_thread::sleep_for(between_looks_for_it);
    }
  }

  /// Whether it is of a newer time, or of another one after time has jumped back, or has changed at all times.
  [[nodiscard]] bool is_new(const TransformBuffer::Answer& answer, const TransformBuffer& buffer) {
    const Given now{answer.fixed, answer.stamp_ns, buffer.jumps(), answer.fixed ? buffer.fixed_changes() : 0};
    const bool is = !last_ || now.fixed != last_->fixed || now.jumps != last_->jumps ||
                    now.stamp_ns > last_->stamp_ns || now.fixed_changes != last_->fixed_changes;
    if (is) last_ = now;
    return is;
  }

  struct Given {
    bool fixed = false;
    std::int64_t stamp_ns = 0;
    std::uint64_t jumps = 0, fixed_changes = 0;
  };
  Prepared prepared_;
  std::string frame_, in_, at_;
  std::shared_ptr<TakenStamp> stamps_;  ///< with `at`
  std::uint64_t stamp_number_ = 0;
  std::deque<std::int64_t> pending_;  ///< stamps without a transform until now
  bool at_stamp_ = false;             ///< whether the last answer is at one of them
  std::shared_ptr<TransformListener> listener_;
  std::optional<MissingTransform> missing_;
  std::optional<Given> last_;
  std::vector<std::byte> value_;
};

class TransformEffector final : public RealEffector {
 public:
  TransformEffector(Prepared prepared, const Ros2Binding& binding, bool gives_stamp)
      : prepared_(std::move(prepared)),
        fixed_(is_static_topic(prepared_.endpoint.topic)),
        gives_stamp_(gives_stamp),
        sink_(prepared_.encoding->most),
        maker_(getpid()) {
    sent_.parent = binding.in;
    sent_.child = binding.frame;
  }

  /// A guardian seldom has anything to broadcast.
  [[nodiscard]] bool open() override {
    if (is_guardian()) return true;
    open_endpoint();
    if (prepared_.wait > Duration::zero() && !endpoint_->await_other_side(prepared_.wait))
      throw std::runtime_error("there is no subscriber of " + prepared_.endpoint.topic);
    return true;
  }
  void close() override {
    if (endpoint_ && was_sent_) static_cast<void>(endpoint_->await_receipt(longest_broadcast_receipt));
    endpoint_.reset();
  }

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    sink_.clear();
    prepared_.encoding->put(value.data(), sink_);
    const Translator& translator = prepared_.translator;
    if (translator.has_own(known_field) && translator.own_number(sink_.bytes(), known_field) == 0)
      return true;
    if (!translator.encode(sink_.bytes(), stamp_now(), message_)) return false;
    const auto given = read_transform_message(message_);
    if (!given) return false;
    if (squared_length(given->transform.rotation) == 0) return true;  // which is none
    if (!is_finite(given->transform)) throw std::runtime_error("a number of the transform is not finite");
    if (!is_unit(given->transform.rotation))
      throw std::runtime_error("the rotation of the transform is no unit quaternion");
    return broadcast(given->transform, gives_stamp_ ? given->stamp : stamp_now());
  }

 private:
  void open_endpoint() {
    endpoint_.emplace(transform_endpoint(prepared_.endpoint, prepared_.endpoint.topic,
                                         fixed_ ? broadcast_fixed_depth : broadcast_moving_depth),
                      /*writes=*/true);
  }

  /// A fixed transform is sent when it changes, and a moving one never twice with the same stamp.
  [[nodiscard]] bool broadcast(const Transform& transform, const Stamp& stamp) {
    const bool same_time = stamp.sec == sent_.stamp.sec && stamp.nanosec == sent_.stamp.nanosec;
    if (was_sent_ && transform == given_ && (fixed_ || same_time)) return true;
    given_ = transform;
    sent_.stamp = stamp;
    sent_.transform = {transform.translation, normalized(transform.rotation)};
    if (is_guardian()) return broadcast_last();
    was_sent_ = endpoint_->write(tf_message({&sent_, 1}));
    return was_sent_;
  }

  /// The safe command of a system that has died.
  [[nodiscard]] bool broadcast_last() {
    if (!endpoint_) open_endpoint();
    was_sent_ = endpoint_->await_other_side(guardian_finds_listener_within) &&
                endpoint_->write(tf_message({&sent_, 1})) &&
                endpoint_->await_receipt(longest_broadcast_receipt);
    return was_sent_;
  }

  /// The guardian makes its drivers early, and opens them in a process that it forks for that.
  [[nodiscard]] bool is_guardian() const { return getpid() != maker_; }

  Prepared prepared_;
  bool fixed_, gives_stamp_, was_sent_ = false;
  ValueSink sink_;
  pid_t maker_;
  std::optional<Endpoint> endpoint_;
  std::vector<std::byte> message_;
  Transform given_{};
  StampedTransform sent_;
};

void check_transform(const Ros2Binding& binding) {
  if (binding.frame.empty() || binding.in.empty() || binding.frame == binding.in)
    throw std::runtime_error("a transform needs two frames");
}

}  // namespace

std::unique_ptr<RealReceptor> make_transform_receptor(const Ros2Binding& binding, std::string& error) {
  try {
    check_transform(binding);
    return std::make_unique<TransformReceptor>(prepare(binding, Direction::receive), binding);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

std::unique_ptr<RealEffector> make_transform_effector(const Ros2Binding& binding, std::string& error) {
  try {
    check_transform(binding);
    const Mapping mapping = written_mapping(binding.fields, binding.names, binding.frame_id);
    return std::make_unique<TransformEffector>(prepare(binding, Direction::send), binding,
                                               gives_stamp(mapping));
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

}  // namespace tessera::ros2
