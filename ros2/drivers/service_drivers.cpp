#include "ros2/drivers/service_drivers.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "ros2/drivers/client.hpp"
#include "ros2/drivers/prepared.hpp"
#include "ros2/drivers/server.hpp"
#include "ros2/drivers/shared_driver.hpp"

namespace tessera::ros2 {
namespace {

class ReplyReceptor final : public SharedDriver<RealReceptor, ServiceClient> {
 public:
  ReplyReceptor(Prepared prepared, const Ros2Binding& binding) : SharedDriver(std::move(prepared), binding) {
    side_->keep_results();
  }

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    while (auto result = side_->take_result()) {
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

class RequestEffector final : public SharedDriver<RealEffector, ServiceClient> {
 public:
  RequestEffector(Prepared prepared, const Ros2Binding& binding)
      : SharedDriver(std::move(prepared), binding), outgoing_(prepared_), maker_(getpid()) {}

  [[nodiscard]] bool open() override {
    return is_guardian() || SharedDriver::open();  // most safe commands of a guardian make no call
  }

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    if (!outgoing_.make(prepared_, value)) return false;
    if (!is_guardian()) return side_->call(outgoing_.call(), outgoing_.message());
    if (outgoing_.call() == 0) return true;
    side_->open();
    return side_->call_and_wait(outgoing_.call(), outgoing_.message(), guardian_calls_within);
  }

 private:
  /// The guardian makes its drivers early, and opens them in a process that it forks for that. That process
  /// reports "taken" only for a call that was answered.
  [[nodiscard]] bool is_guardian() const { return getpid() != maker_; }

  OutgoingMessage outgoing_;
  pid_t maker_;
};

class RequestReceptor final : public SharedDriver<RealReceptor, ServiceServer> {
 public:
  using SharedDriver::SharedDriver;

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    while (const auto request = side_->next_request()) {
      const std::array own{request->number};
      if (prepared_.translator.decode(request->message, value_, own) == Translator::Outcome::good)
        return prepared_.encoding->take(value.data(), value_);
      side_->drop(request->number);
    }
    return false;
  }

 private:
  std::vector<std::byte> value_;
};

class ReplyEffector final : public SharedDriver<RealEffector, ServiceServer> {
 public:
  ReplyEffector(Prepared prepared, const Ros2Binding& binding)
      : SharedDriver(std::move(prepared), binding), outgoing_(prepared_) {}

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    return outgoing_.make(prepared_, value) && side_->reply(outgoing_.call(), outgoing_.message());
  }

 private:
  OutgoingMessage outgoing_;
};

}  // namespace

std::unique_ptr<RealReceptor> make_service_receptor(const Ros2Binding& binding, std::string& error) {
  return made_for_role<RealReceptor, ReplyReceptor, RequestReceptor>(
      binding, Direction::receive, "service", full_service_name(binding.type).has_value(), error);
}

std::unique_ptr<RealEffector> make_service_effector(const Ros2Binding& binding, std::string& error) {
  return made_for_role<RealEffector, RequestEffector, ReplyEffector>(
      binding, Direction::send, "service", full_service_name(binding.type).has_value(), error);
}

}  // namespace tessera::ros2
