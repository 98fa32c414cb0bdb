#include "ros2/dds/service_drivers.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "ros2/codec/written_mapping.hpp"
#include "ros2/dds/client.hpp"
#include "ros2/dds/clock.hpp"
#include "ros2/dds/prepared.hpp"
#include "ros2/dds/server.hpp"

namespace tessera::ros2 {
namespace {

constexpr Duration guardian_calls_within = std::chrono::seconds(4);

ServiceSetup setup_of(const Prepared& prepared, const Ros2Binding& binding) {
  return {prepared.endpoint, binding.type, binding.role == "client", binding.timeout};
}

/// A driver of a client or server, which it may share with another driver.
template <class Driver, class Service>
class ServiceDriver : public Driver {
 public:
  ServiceDriver(Prepared prepared, const Ros2Binding& binding)
      : prepared_(std::move(prepared)), service_(shared_service<Service>(setup_of(prepared_, binding))) {}

  [[nodiscard]] bool open() override {
    service_->open();
    if constexpr (std::is_same_v<Service, ServiceClient>)
      if (prepared_.wait > Duration::zero() && !service_->await_server(prepared_.wait))
        throw std::runtime_error("there is no server of " + prepared_.endpoint.topic);
    return true;
  }
  void close() override { service_->close(); }

 protected:
  Prepared prepared_;
  std::shared_ptr<Service> service_;
};

class ReplyReceptor final : public ServiceDriver<RealReceptor, ServiceClient> {
 public:
  ReplyReceptor(Prepared prepared, const Ros2Binding& binding) : ServiceDriver(std::move(prepared), binding) {
    service_->keep_results();
  }

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    while (auto result = service_->take_result()) {
      if (result->outcome == CallOutcome::answered && !is_read(*result)) {
        result->outcome = CallOutcome::unreadable;
        if (is_told(++unreadable_))
          std::fprintf(stderr,
                       "warning: %s: a reply of %s was dropped (%llu until now): it is none of that type, or "
                       "does not fit the buffer\n",
                       prepared_.endpoint.path.c_str(), prepared_.endpoint.topic.c_str(),
                       static_cast<unsigned long long>(unreadable_));
      }
      if (result->outcome != CallOutcome::answered) {
        if (!prepared_.translator.has_own(outcome_field)) continue;
        value_ = prepared_.translator.empty_value(own_of(*result));
      }
      return prepared_.encoding->take(value.data(), value_);
    }
    return false;
  }

 private:
  static std::array<std::uint64_t, 2> own_of(const ServiceClient::Result& result) {
    return {result.number, static_cast<std::uint64_t>(result.outcome)};
  }
  [[nodiscard]] bool is_read(const ServiceClient::Result& result) {
    return prepared_.translator.decode(result.reply, value_, own_of(result)) == Translator::Outcome::good;
  }

  std::vector<std::byte> value_;
  std::uint64_t unreadable_ = 0;
};

/// The value of an effector, as bytes and as a message.
class OutgoingMessage {
 public:
  explicit OutgoingMessage(const Prepared& prepared) : sink_(prepared.encoding->most) {}

  /// false: the value does not have its type.
  [[nodiscard]] bool make(const Prepared& prepared, std::span<const std::byte> value) {
    sink_.clear();
    prepared.encoding->put(value.data(), sink_);
    call_ = prepared.translator.own_number(sink_.bytes(), call_field);
    return prepared.translator.encode(sink_.bytes(), stamp_now(), message_);
  }
  [[nodiscard]] std::uint64_t call() const { return call_; }
  [[nodiscard]] const std::vector<std::byte>& message() const { return message_; }

 private:
  ValueSink sink_;
  std::uint64_t call_ = 0;
  std::vector<std::byte> message_;
};

class RequestEffector final : public ServiceDriver<RealEffector, ServiceClient> {
 public:
  RequestEffector(Prepared prepared, const Ros2Binding& binding)
      : ServiceDriver(std::move(prepared), binding), outgoing_(prepared_), maker_(getpid()) {}

  [[nodiscard]] bool open() override {
    return is_guardian() || ServiceDriver::open();  // most safe commands of a guardian make no call
  }

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    if (!outgoing_.make(prepared_, value)) return false;
    if (!is_guardian()) return service_->call(outgoing_.call(), outgoing_.message());
    if (outgoing_.call() == 0) return true;
    service_->open();
    return service_->call_and_wait(outgoing_.call(), outgoing_.message(), guardian_calls_within);
  }

 private:
  /// The guardian makes its drivers early, and opens them in a process that it forks for that. That process
  /// reports "taken" only for a call that was answered.
  [[nodiscard]] bool is_guardian() const { return getpid() != maker_; }

  OutgoingMessage outgoing_;
  pid_t maker_;
};

class RequestReceptor final : public ServiceDriver<RealReceptor, ServiceServer> {
 public:
  using ServiceDriver::ServiceDriver;

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    while (const auto request = service_->next_request()) {
      const std::array own{request->number};
      if (prepared_.translator.decode(request->message, value_, own) == Translator::Outcome::good)
        return prepared_.encoding->take(value.data(), value_);
      service_->drop(request->number);
    }
    return false;
  }

 private:
  std::vector<std::byte> value_;
};

class ReplyEffector final : public ServiceDriver<RealEffector, ServiceServer> {
 public:
  ReplyEffector(Prepared prepared, const Ros2Binding& binding)
      : ServiceDriver(std::move(prepared), binding), outgoing_(prepared_) {}

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    return outgoing_.make(prepared_, value) && service_->reply(outgoing_.call(), outgoing_.message());
  }

 private:
  OutgoingMessage outgoing_;
};

template <class Driver, class ClientSide, class ServerSide>
std::unique_ptr<Driver> made_for_service(const Ros2Binding& binding, Direction direction,
                                         std::string& error) {
  try {
    if (binding.role != "client" && binding.role != "server")
      throw std::runtime_error("'" + binding.role + "' is no role of a service");
    if (!full_service_name(binding.type)) throw std::runtime_error("'" + binding.type + "' is no service");
    Prepared prepared = prepare(binding, direction);
    if (binding.role == "client") return std::make_unique<ClientSide>(std::move(prepared), binding);
    return std::make_unique<ServerSide>(std::move(prepared), binding);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<RealReceptor> make_service_receptor(const Ros2Binding& binding, std::string& error) {
  return made_for_service<RealReceptor, ReplyReceptor, RequestReceptor>(binding, Direction::receive, error);
}

std::unique_ptr<RealEffector> make_service_effector(const Ros2Binding& binding, std::string& error) {
  return made_for_service<RealEffector, RequestEffector, ReplyEffector>(binding, Direction::send, error);
}

}  // namespace tessera::ros2
