#include "ros2/drivers/action_drivers.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "ros2/actions/messages.hpp"
#include "ros2/drivers/action_client.hpp"
#include "ros2/drivers/action_server.hpp"
#include "ros2/drivers/shared_driver.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::ros2 {
namespace {

/// Orders goals, and cancels them.
class GoalEffector final : public SharedDriver<RealEffector, ActionClient> {
 public:
  GoalEffector(Prepared prepared, const Ros2Binding& binding)
      : SharedDriver(std::move(prepared), binding),
        outgoing_(prepared_),
        maker_(getpid()),
        own_names_(names_of(maker_)),
        names_of_parent_(names_of(getppid())) {
    side_->use_names(own_names_);
  }

  [[nodiscard]] bool open() override {
    if (!is_guardian()) return SharedDriver::open();
    side_->open();
    return true;
  }

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    if (!outgoing_.make(prepared_, value)) return false;
    if (is_guardian()) return side_->cancel_goals_of(names_of_parent_, guardian_calls_within);
    return side_->order(outgoing_.call(), outgoing_.own(prepared_, cancel_field) != 0, outgoing_.message());
  }

 private:
  /// The guardian makes its drivers early, and opens them in a process that it forks for that. It is a child of
  /// the controller, whose goals it knows by their names. That process reports "taken" only if the server works
  /// for none of them any more.
  [[nodiscard]] bool is_guardian() const { return getpid() != maker_; }
  [[nodiscard]] GoalPrefix names_of(pid_t process) const {
    const EndpointSetup& endpoint = prepared_.endpoint;
    return goal_prefix(process, endpoint.path + " " + endpoint.topic);
  }

  OutgoingMessage outgoing_;
  pid_t maker_;
  GoalPrefix own_names_, names_of_parent_;
};

/// Gives what becomes of the goals.
class ProgressReceptor final : public SharedDriver<RealReceptor, ActionClient> {
 public:
  ProgressReceptor(Prepared prepared, const Ros2Binding& binding)
      : SharedDriver(std::move(prepared), binding), type_(prepared_.message) {
    side_->keep_events();
  }

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    auto event = side_->take_event();
    if (!event) return false;
    if (!is_read(*event)) {
      warn_of_misfit();
      event->feedback.clear();
      if (!is_read(*event)) {  // so it is the result
        event->result.clear();
        event->state = GoalState::gone;
        if (!is_read(*event)) value_ = prepared_.translator.empty_value(own_of(*event));
      }
    }
    return prepared_.encoding->take(value.data(), value_);
  }

 private:
  static std::array<std::uint64_t, 2> own_of(const GoalLife::Event& event) {
    return {event.call, static_cast<std::uint64_t>(event.state)};
  }
  [[nodiscard]] bool is_read(const GoalLife::Event& event) {
    const auto joined = type_.join(event.feedback, event.result);
    return joined && prepared_.translator.decode(*joined, value_, own_of(event)) == Translator::Outcome::good;
  }
  void warn_of_misfit() {
    if (is_told(++misfits_))
      std::fprintf(stderr,
                   "warning: %s: feedback or a result of %s was dropped (%llu until now): it does not fit "
                   "the buffer, or "
                   "the server has another definition of the action, as other distributions of ROS 2 do; see "
                   "\"Messages\" in docs/use/ros2.md\n",
                   prepared_.endpoint.path.c_str(), prepared_.endpoint.topic.c_str(),
                   static_cast<unsigned long long>(misfits_));
  }

  ProgressType type_;
  std::vector<std::byte> value_;
  std::uint64_t misfits_ = 0;
};

/// Gives the goals of clients.
class GoalReceptor final : public SharedDriver<RealReceptor, ActionServer> {
 public:
  GoalReceptor(Prepared prepared, const Ros2Binding& binding) : SharedDriver(std::move(prepared), binding) {
    if (!prepared_.translator.has_own(cancel_field)) side_->refuse_cancels();
  }

  [[nodiscard]] bool read(std::span<std::byte> value) override {
    while (const auto event = side_->next_event()) {
      const std::array own{event->number, static_cast<std::uint64_t>(event->cancel)};
      if (prepared_.translator.decode(event->goal, value_, own) == Translator::Outcome::good)
        return prepared_.encoding->take(value.data(), value_);
      side_->refuse(event->number);
    }
    return false;
  }

 private:
  std::vector<std::byte> value_;
};

/// Says what becomes of them.
class ProgressEffector final : public SharedDriver<RealEffector, ActionServer> {
 public:
  ProgressEffector(Prepared prepared, const Ros2Binding& binding)
      : SharedDriver(std::move(prepared), binding), outgoing_(prepared_), type_(prepared_.message) {
    side_->use_empty_result(type_.empty_result(0));
  }

  [[nodiscard]] bool write(std::span<const std::byte> value) override {
    if (!outgoing_.make(prepared_, value)) return false;
    const auto state = static_cast<std::uint8_t>(outgoing_.own(prepared_, state_field));
    const auto parts = type_.split(outgoing_.message(), static_cast<std::int8_t>(state));
    return parts &&
           side_->say(outgoing_.call(), static_cast<GoalState>(state), parts->feedback, parts->result);
  }

 private:
  OutgoingMessage outgoing_;
  ProgressType type_;
};

}  // namespace

std::unique_ptr<RealReceptor> make_action_receptor(const Ros2Binding& binding, std::string& error) {
  return made_for_role<RealReceptor, ProgressReceptor, GoalReceptor>(
      binding, Direction::receive, "action", full_action_name(binding.type).has_value(), error);
}

std::unique_ptr<RealEffector> make_action_effector(const Ros2Binding& binding, std::string& error) {
  return made_for_role<RealEffector, GoalEffector, ProgressEffector>(
      binding, Direction::send, "action", full_action_name(binding.type).has_value(), error);
}

}  // namespace tessera::ros2
