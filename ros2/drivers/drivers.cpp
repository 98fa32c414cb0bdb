#include "ros2/drivers/drivers.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <map>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "ros2/dds/clock.hpp"
#include "ros2/dds/other_side.hpp"
#include "ros2/drivers/action_drivers.hpp"
#include "ros2/drivers/prepared.hpp"
#include "ros2/drivers/service_drivers.hpp"
#include "ros2/drivers/transform_drivers.hpp"
#include "ros2/tf/taken_stamps.hpp"
#include "ros2/tf/transform_value.hpp"

namespace tessera::ros2 {
namespace {

constexpr Duration longest_receipt = std::chrono::milliseconds(500);
constexpr Duration speaks_no_more_after = std::chrono::seconds(1);
constexpr Duration guardian_finds_within = std::chrono::seconds(4);

void await_other_side(const Endpoint& endpoint, const Prepared& prepared, const char* other) {
  if (prepared.wait > Duration::zero() && !endpoint.await_other_side(prepared.wait))
    throw std::runtime_error("there is no " + std::string(other) + " of " + prepared.endpoint.topic);
}

/// The endpoint of a topic, with a watch for a missing other side.
class WatchedEndpoint {
 public:
  WatchedEndpoint(const EndpointSetup& setup, bool writes)
      : endpoint_(setup, writes),
        watch_(setup, writes, OtherSideWatch::Clock::now(), endpoint_.participant().advised()) {}
  [[nodiscard]] Endpoint* operator->() { return &endpoint_; }
  [[nodiscard]] const Endpoint& operator*() const { return endpoint_; }
  /// Prints a pending message. The call takes a microsecond, so every read and write may make it.
  void watch() {
    if (const auto text = watch_.look(endpoint_.has_other_side(), OtherSideWatch::Clock::now(),
                                      [this] { return endpoint_.tell_of_misfits(); }))
      std::fprintf(stderr, "warning: %s\n", text->c_str());
  }

 private:
  Endpoint endpoint_;
  OtherSideWatch watch_;
};

/// The publishers that have sent a message within the last second. One that was killed is thus no longer counted
/// long before DDS notices its end.
class Speakers {
 public:
  using Clock = std::chrono::steady_clock;
  void note(dds_instance_handle_t writer, Clock::time_point now) { heard_[writer] = now; }
  [[nodiscard]] std::size_t count(Clock::time_point now) {
    std::erase_if(heard_, [&](const auto& one) { return now - one.second > speaks_no_more_after; });
    return heard_.size();
  }

 private:
  std::map<dds_instance_handle_t, Clock::time_point> heard_;
};

/// "'ranges' has 360 elements, and the buffer takes 8"
std::string reason(Translator::Outcome outcome, const Translator::Misfit& misfit) {
  if (outcome == Translator::Outcome::other_names)
    return misfit.came == 0 ? fmt::format("it has no '{}', which `names` lists", misfit.field)
                            : fmt::format("it has the name '{}' twice", misfit.field);
  if (outcome != Translator::Outcome::other_length) return "it is no message of that type";
  const std::string field = misfit.field.empty() ? "it" : "'" + misfit.field + "'";
  return fmt::format("{} has {} {}, and the buffer takes {}", field, misfit.came,
                     misfit.is_text ? "bytes" : "elements", misfit.room);
}

class Subscriber final : public RealReceptor {
 public:
  explicit Subscriber(Prepared prepared)
      : prepared_(std::move(prepared)),
        has_stamp_(begins_with_header(*prepared_.message)),
        taken_(TakenStamp::of(prepared_.endpoint.path)) {}

  [[nodiscard]] bool open() override {
    endpoint_.emplace(prepared_.endpoint, /*writes=*/false);
    await_other_side(**endpoint_, prepared_, "publisher");
    return true;
  }
  void close() override { endpoint_.reset(); }

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    fresh_ = false;
    endpoint_->watch();
    (*endpoint_)
        ->take([](void* self, const TakenBlob& blob) { static_cast<Subscriber*>(self)->note(blob); }, this);
    if (prepared_.one_publisher) refuse_several();
    if (!fresh_ || !prepared_.encoding->take(value.data(), newest_)) return false;
    if (stamp_) taken_->set(*stamp_);
    return true;
  }

 private:
  /// A message that was taken beside those of another publisher is gone, so that it cannot count later.
  void refuse_several() {
    const std::size_t speakers = speakers_.count(Speakers::Clock::now());
    if (speakers > 1)
      throw std::runtime_error(fmt::format("{} programs publish {}, and `publishers` allows one", speakers,
                                           prepared_.endpoint.topic));
  }

  void note(const TakenBlob& blob) {
    if (prepared_.one_publisher) speakers_.note(blob.writer, Speakers::Clock::now());
    Translator::Misfit misfit;
    const Translator::Outcome outcome = prepared_.translator.decode(blob.message, newest_, {}, &misfit);
    if (outcome == Translator::Outcome::good) {
      fresh_ = true;
      if (has_stamp_) stamp_ = stamp_of_header(blob.message);
    } else if (is_told(++dropped_))
      tell(outcome, misfit);
  }

  void tell(Translator::Outcome outcome, const Translator::Misfit& misfit) const {
    const std::string why = reason(outcome, misfit);
    std::fprintf(stderr, "warning: %s: a message of %s was dropped (%llu until now): %s\n",
                 prepared_.endpoint.path.c_str(), prepared_.endpoint.topic.c_str(),
                 static_cast<unsigned long long>(dropped_), why.c_str());
  }

  Prepared prepared_;
  std::optional<WatchedEndpoint> endpoint_;
  bool has_stamp_;
  std::shared_ptr<TakenStamp> taken_;
  std::optional<Stamp> stamp_;  ///< of the newest message
  std::vector<std::byte> newest_;
  Speakers speakers_;
  bool fresh_ = false;
  std::uint64_t dropped_ = 0;
};

class Publisher final : public RealEffector {
 public:
  explicit Publisher(Prepared prepared)
      : prepared_(std::move(prepared)), sink_(prepared_.encoding->most), maker_(getpid()) {
    prepared_.endpoint.sole_writer = true;
  }

  [[nodiscard]] bool open() override {
    endpoint_.emplace(prepared_.endpoint, /*writes=*/true);
    await_other_side(**endpoint_, prepared_, "subscriber");
    return true;
  }
  void close() override {
    // A best-effort writer gets no receipts. Missing subscribers are no fault here.
    static_cast<void>((*endpoint_)->await_receipt(longest_receipt));
    endpoint_.reset();
  }

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    sink_.clear();
    prepared_.encoding->put(value.data(), sink_);
    if (!prepared_.translator.encode(sink_.bytes(), stamp_now(), message_)) return false;
    if (is_guardian()) return write_until_received();
    endpoint_->watch();
    warn_of_others();
    return (*endpoint_)->write(message_);
  }

 private:
  /// A device obeys every publisher of its commands, also one that was forgotten.
  void warn_of_others() {
    for (const OtherWriters::Writer& other : (*endpoint_)->new_other_writers()) {
      if (!is_told(++others_)) continue;
      const std::string& topic = prepared_.endpoint.topic;
      std::fprintf(stderr,
                   "warning: %s: %s publishes %s, too (%llu until now; type %s, participant %s): subscribers "
                   "obey both in turn; `ros2 topic info -v %s` names its node\n",
                   prepared_.endpoint.path.c_str(),
                   other.own_process ? "another driver of this controller" : "another program", topic.c_str(),
                   static_cast<unsigned long long>(others_), other.type.c_str(), other.participant.c_str(),
                   topic.c_str());
    }
  }

  /// A subscriber receives no sample that was written before it has found the writer, even if the writer has
  /// found it already. So the command is sent several times.
  [[nodiscard]] bool write_until_received() {
    constexpr int times = 4;
    if (!(*endpoint_)->await_other_side(guardian_finds_within)) return false;
    bool received = true;
    for (int time = 0; time < times; ++time) {
      if (time > 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
      received = (*endpoint_)->write(message_) && (*endpoint_)->await_receipt(longest_receipt);
    }
    return received;
  }

  /// The guardian makes its drivers early, and opens them in a process that it forks for that. That process
  /// reports "taken" only for samples that a subscriber has received.
  [[nodiscard]] bool is_guardian() const { return getpid() != maker_; }

  Prepared prepared_;
  std::optional<WatchedEndpoint> endpoint_;
  ValueSink sink_;
  std::vector<std::byte> message_;
  std::uint64_t others_ = 0;
  pid_t maker_;
};

template <class Driver>
std::unique_ptr<Driver> made(const Ros2Binding& binding, Direction direction, std::string& error) {
  try {
    return std::make_unique<Driver>(prepare(binding, direction));
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<RealReceptor> make_receptor(const Ros2Binding& binding, std::string& error) {
  if (is_action_type(binding.type)) return make_action_receptor(binding, error);
  if (!binding.role.empty()) return make_service_receptor(binding, error);
  if (!binding.frame.empty()) return make_transform_receptor(binding, error);
  return made<Subscriber>(binding, Direction::receive, error);
}

std::unique_ptr<RealEffector> make_effector(const Ros2Binding& binding, std::string& error) {
  if (is_action_type(binding.type)) return make_action_effector(binding, error);
  if (!binding.role.empty()) return make_service_effector(binding, error);
  if (!binding.frame.empty()) return make_transform_effector(binding, error);
  return made<Publisher>(binding, Direction::send, error);
}

}  // namespace tessera::ros2
