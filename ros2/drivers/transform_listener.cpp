#include "ros2/drivers/transform_listener.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <tuple>
#include <utility>

#include "ros2/drivers/prepared.hpp"
#include "ros2/naming/names.hpp"
#include "ros2/tf/tf_message.hpp"
#include "ros2/tf/transform_value.hpp"

namespace tessera::ros2 {
namespace {

/// Between two readings of a slow receptor, many publishers may send.
constexpr int listened_messages = 1000;

const char* text_of(TransformBuffer::Refusal refusal) {
  using enum TransformBuffer::Refusal;
  switch (refusal) {
    case no_name:
      return "a frame has no name";
    case own_parent:
      return "the frame is its own parent";
    case not_finite:
      return "a number is not finite";
    case not_unit:
      return "its rotation is no unit quaternion";
    case bad_stamp:
      return "its stamp is no time";
    case too_many:
      return "there are too many frames";
    case none:
      break;
  }
  return "";
}

}  // namespace

EndpointSetup transform_endpoint(EndpointSetup endpoint, const std::string& topic, int depth) {
  endpoint.topic = topic;
  endpoint.dds_topic = dds_topic_name(topic);
  endpoint.dds_type = dds_type_name(tf_message_type);
  endpoint.qos = {.reliable = true, .transient_local = is_static_topic(topic), .depth = depth};
  return endpoint;
}

TransformListener::TransformListener(const EndpointSetup& endpoint)
    : moving_setup_(transform_endpoint(endpoint, endpoint.topic, listened_messages)),
      fixed_setup_(transform_endpoint(endpoint, static_topic_of(endpoint.topic), listened_messages)) {}

std::shared_ptr<TransformListener> TransformListener::of(const EndpointSetup& endpoint) {
  static std::mutex mutex;
  static std::map<std::tuple<std::string, std::string, Network>, std::weak_ptr<TransformListener>> known;
  const std::lock_guard lock(mutex);
  std::weak_ptr<TransformListener>& one = known[{endpoint.node, endpoint.topic, endpoint.network}];
  std::shared_ptr<TransformListener> shared = one.lock();
  if (shared == nullptr) one = shared = std::make_shared<TransformListener>(endpoint);
  return shared;
}

void TransformListener::open() {
  const std::lock_guard lock(mutex_);
  if (!moving_) {
    moving_.emplace(moving_setup_, /*writes=*/false);
    fixed_.emplace(fixed_setup_, /*writes=*/false);
    watch_.emplace(moving_setup_, /*writes=*/false, OtherSideWatch::Clock::now(),
                   moving_->participant().advised());
  }
  ++users_;
}

void TransformListener::close() {
  const std::lock_guard lock(mutex_);
  if (users_ == 0 || --users_ > 0) return;
  watch_.reset();
  fixed_.reset();
  moving_.reset();
  buffer_ = {};
}

void TransformListener::take() {
  if (!moving_) return;
  const auto take_all = [this](const Endpoint& endpoint, auto use) { endpoint.take(use, this); };
  take_all(*fixed_, [](void* self, const TakenBlob& blob) {
    static_cast<TransformListener*>(self)->take(/*fixed=*/true, blob);
  });
  take_all(*moving_, [](void* self, const TakenBlob& blob) {
    static_cast<TransformListener*>(self)->take(/*fixed=*/false, blob);
  });
  const bool anybody = moving_->has_other_side() || fixed_->has_other_side();
  if (const auto text = watch_->look(anybody, OtherSideWatch::Clock::now(), [this] {
        const bool misfits = moving_->tell_of_misfits();
        return fixed_->tell_of_misfits() || misfits;
      }))
    std::fprintf(stderr, "warning: %s\n", text->c_str());
}

void TransformListener::take(bool fixed, const TakenBlob& blob) {
  const auto transforms = read_tf_message(blob.message);
  if (!transforms) {
    warn(malformed_, fixed, "a message was dropped: it is no message of that type");
    return;
  }
  for (const StampedTransform& one : *transforms) take(fixed, one, blob.writer);
}

void TransformListener::take(bool fixed, const StampedTransform& one, std::uint64_t publisher) {
  const TransformBuffer::Taken taken = buffer_.take(one, fixed, publisher);
  if (taken.refusal != TransformBuffer::Refusal::none)
    warn(refused_, fixed,
         fmt::format("the transform of `{}` in `{}` was refused: {}", one.child, one.parent,
                     text_of(taken.refusal)));
  else if (taken.oddity != TransformBuffer::Oddity::none)
    tell_of(one, fixed, taken);
}

void TransformListener::tell_of(const StampedTransform& one, bool fixed,
                                const TransformBuffer::Taken& taken) {
  using enum TransformBuffer::Oddity;
  switch (taken.oddity) {
    case went_back:
      return warn(jumps_, fixed,
                  fmt::format("time has gone back by {:.3f} s, at `{}`: transforms of before are forgotten",
                              static_cast<double>(taken.back_ns) * 1e-9, one.child));
    case two_parents:
      return warn(parents_, fixed,
                  fmt::format("the frame `{}` has two parents, `{}` and `{}`; the last message counts",
                              one.child, taken.other, one.parent));
    case two_publishers:
      return warn(
          publishers_, fixed,
          fmt::format("two publishers give the transform of `{}` in `{}`, in turn; each message counts",
                      one.child, one.parent));
    case moves_and_not:
      return warn(kinds_, fixed,
                  fmt::format("the transform of `{}` comes on {} and on {}; the last message counts",
                              one.child, moving_setup_.topic, fixed_setup_.topic));
    case none:
      break;
  }
}

void TransformListener::warn(std::uint64_t& count, bool fixed, const std::string& text) const {
  if (is_told(++count))
    std::fprintf(stderr, "warning: %s: %s (%llu until now)\n",
                 (fixed ? fixed_setup_ : moving_setup_).topic.c_str(), text.c_str(),
                 static_cast<unsigned long long>(count));
}

}  // namespace tessera::ros2
