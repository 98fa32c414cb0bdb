#include "ros2/dds/clock.hpp"

#include <time.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <utility>
#include <vector>

#include "ros2/codec/cdr.hpp"
#include "ros2/dds/endpoint.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::int64_t no_simulated_time = -1;
std::atomic<std::int64_t> simulated_ns{no_simulated_time};

Stamp stamp_of(std::int64_t ns) {
  constexpr std::int64_t second = 1'000'000'000;
  return {static_cast<std::int32_t>(ns / second), static_cast<std::uint32_t>(ns % second)};
}

class Publication final : public Ros2Clock {
 public:
  explicit Publication(const EndpointSetup& setup) : endpoint_(setup, /*writes=*/true) {}
  ~Publication() override { simulated_ns = no_simulated_time; }
  Publication(const Publication&) = delete;
  Publication& operator=(const Publication&) = delete;

  void set(Duration since_start) override { simulated_ns = since_start.count(); }

  /// rosgraph_msgs/msg/Clock.
  void publish(Duration since_start) override {
    const Stamp stamp = stamp_of(since_start.count());
    CdrWriter writer(message_);
    writer.number(&stamp.sec, sizeof stamp.sec);
    writer.number(&stamp.nanosec, sizeof stamp.nanosec);
    writer.finish();
    static_cast<void>(endpoint_.write(message_));  // the next one comes soon
  }

 private:
  Endpoint endpoint_;
  std::vector<std::byte> message_;
};

}  // namespace

std::unique_ptr<Ros2Clock> make_clock(const std::string& interface, std::string& error) {
  try {
    EndpointSetup setup;
    setup.path = "the simulated clock";
    setup.topic = "/clock";
    setup.dds_topic = dds_topic_name(setup.topic);
    setup.dds_type = dds_type_name("rosgraph_msgs/msg/Clock");
    setup.node = "/tessera_clock";
    setup.qos = Qos{.depth = 1};
    setup.network = {domain_of_environment(), interface, ""};
    return std::make_unique<Publication>(setup);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

Stamp stamp_now() {
  if (const std::int64_t simulated = simulated_ns; simulated != no_simulated_time) return stamp_of(simulated);
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return {static_cast<std::int32_t>(time.tv_sec), static_cast<std::uint32_t>(time.tv_nsec)};
}

}  // namespace tessera::ros2
