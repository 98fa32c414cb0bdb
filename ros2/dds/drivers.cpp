#include "ros2/dds/drivers.hpp"

#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "ros2/codec/plan.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/dds/endpoint.hpp"
#include "ros2/definitions/resolver.hpp"

namespace tessera::ros2 {
namespace {

constexpr Duration longest_receipt = std::chrono::milliseconds(500);
constexpr Duration guardian_finds_within = std::chrono::seconds(4);

/// What receptors and effectors have in common. Throws std::runtime_error: the binding is wrong.
struct Prepared {
  Plan plan;
  EndpointSetup endpoint;
  const ValueEncoding* encoding;
  Duration wait;
};

template <class T>
T given(std::optional<T> value, const std::string& error) {
  if (!value) throw std::runtime_error(error);
  return *std::move(value);
}

Plan plan_of(const Ros2Binding& binding, Direction direction) {
  if (binding.encoding == nullptr)
    throw std::runtime_error("its real buffer has a type without a fixed form");
  std::vector<Mistake> mistakes;
  const auto message = resolve(binding.type, DefinitionBundle(binding.type, binding.definition), mistakes);
  if (message == nullptr)
    throw std::runtime_error(mistakes.empty() ? "no definition of " + binding.type
                                              : mistakes.front().shown());
  const auto value = parse_value_type(binding.encoding->type());
  if (!value) throw std::runtime_error("its real buffer has a type that no message has");
  std::vector<MappingProblem> problems;
  auto plan = Plan::make(message, *value, written_mapping(binding.fields, binding.names, binding.frame_id),
                         direction, problems);
  return given(std::move(plan), problems.empty() ? "no mapping" : problems.front().text);
}

Prepared prepare(const Ros2Binding& binding, Direction direction) {
  std::string error;
  Prepared prepared{plan_of(binding, direction), {}, binding.encoding, binding.wait};
  EndpointSetup& endpoint = prepared.endpoint;
  endpoint.path = binding.path;
  endpoint.type = binding.type;
  endpoint.topic = full_topic_name(binding.topic, error);
  if (endpoint.topic.empty()) throw std::runtime_error(error);
  endpoint.qos = given(parse_qos(binding.qos, error), error);
  endpoint.node =
      binding.node.empty() ? node_name_of(binding.path.substr(0, binding.path.find('.'))) : binding.node;
  if (!is_node_name(endpoint.node)) throw std::runtime_error("'" + endpoint.node + "' is no name of a node");
  endpoint.network = {binding.domain ? *binding.domain : domain_of_environment(), binding.interface,
                      binding.peers};
  static_cast<void>(configuration_of(endpoint.network));  // so that mistakes are found before anything opens
  return prepared;
}

/// Whether the n-th of a kind of event is told.
bool is_told(std::uint64_t count) {
  while (count % 10 == 0 && count > 0) count /= 10;
  return count == 1;
}

void await_other_side(const Endpoint& endpoint, const Prepared& prepared, const char* other) {
  if (prepared.wait > Duration::zero() && !endpoint.await_other_side(prepared.wait))
    throw std::runtime_error("there is no " + std::string(other) + " of " + prepared.endpoint.topic);
}

class Subscriber final : public RealReceptor {
 public:
  explicit Subscriber(Prepared prepared) : prepared_(std::move(prepared)) {}

  [[nodiscard]] bool open() override {
    endpoint_.emplace(prepared_.endpoint, /*writes=*/false);
    await_other_side(*endpoint_, prepared_, "publisher");
    return true;
  }
  void close() override { endpoint_.reset(); }

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    fresh_ = false;
    endpoint_->take(
        [](void* self, std::span<const std::byte> message) { static_cast<Subscriber*>(self)->note(message); },
        this);
    return fresh_ && prepared_.encoding->take(value.data(), newest_);
  }

 private:
  void note(std::span<const std::byte> message) {
    const Plan::Outcome outcome = prepared_.plan.decode(message, newest_);
    if (outcome == Plan::Outcome::good)
      fresh_ = true;
    else if (is_told(++dropped_))
      tell(outcome);
  }

  void tell(Plan::Outcome outcome) const {
    const char* const why =
        outcome == Plan::Outcome::other_length  ? "an array or text has another length than the buffer"
        : outcome == Plan::Outcome::other_names ? "the names are not those of the specification"
                                                : "it is no message of that type";
    std::fprintf(stderr, "warning: %s: a message of %s was dropped (%llu until now): %s\n",
                 prepared_.endpoint.path.c_str(), prepared_.endpoint.topic.c_str(),
                 static_cast<unsigned long long>(dropped_), why);
  }

  Prepared prepared_;
  std::optional<Endpoint> endpoint_;
  std::vector<std::byte> newest_;
  bool fresh_ = false;
  std::uint64_t dropped_ = 0;
};

Stamp now() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return {static_cast<std::int32_t>(time.tv_sec), static_cast<std::uint32_t>(time.tv_nsec)};
}

class Publisher final : public RealEffector {
 public:
  explicit Publisher(Prepared prepared)
      : prepared_(std::move(prepared)), sink_(prepared_.encoding->most), maker_(getpid()) {}

  [[nodiscard]] bool open() override {
    endpoint_.emplace(prepared_.endpoint, /*writes=*/true);
    await_other_side(*endpoint_, prepared_, "subscriber");
    return true;
  }
  void close() override {
    // A best-effort writer expects no receipts. Subscribers may be gone as well, which is no fault here.
    static_cast<void>(endpoint_->await_receipt(longest_receipt));
    endpoint_.reset();
  }

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    sink_.clear();
    prepared_.encoding->put(value.data(), sink_);
    if (!prepared_.plan.encode(sink_.bytes(), now(), message_)) return false;
    return is_guardian() ? write_until_received() : endpoint_->write(message_);
  }

 private:
  /// A subscriber gets nothing that was written before it has found the writer, though the writer may have
  /// found it already. So the command is sent several times.
  [[nodiscard]] bool write_until_received() {
    constexpr int times = 4;
    if (!endpoint_->await_other_side(guardian_finds_within)) return false;
    bool received = true;
    for (int time = 0; time < times; ++time) {
      if (time > 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
      received = endpoint_->write(message_) && endpoint_->await_receipt(longest_receipt);
    }
    return received;
  }

  /// The guardian makes its drivers early, and opens them in a process that it forks for that. This process
  /// says "taken" only of what somebody has got.
  [[nodiscard]] bool is_guardian() const { return getpid() != maker_; }

  Prepared prepared_;
  std::optional<Endpoint> endpoint_;
  ValueSink sink_;
  std::vector<std::byte> message_;
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
  return made<Subscriber>(binding, Direction::receive, error);
}

std::unique_ptr<RealEffector> make_effector(const Ros2Binding& binding, std::string& error) {
  return made<Publisher>(binding, Direction::send, error);
}

}  // namespace tessera::ros2
