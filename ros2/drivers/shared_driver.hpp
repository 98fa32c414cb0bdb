#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ros2/codec/written_mapping.hpp"
#include "ros2/dds/clock.hpp"
#include "ros2/drivers/prepared.hpp"
#include "ros2/drivers/service_ends.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::ros2 {

/// The longest time that the guardian process waits for an answer of a server.
inline constexpr Duration guardian_calls_within = std::chrono::seconds(4);

/// A driver of one side of a service or action, which it may share with another driver.
template <class Driver, class Side>
class SharedDriver : public Driver {
 public:
  SharedDriver(Prepared prepared, const Ros2Binding& binding)
      : prepared_(std::move(prepared)),
        side_(shared_side<Side>({prepared_.endpoint, binding.type, binding.role == "client", binding.timeout,
                                 is_action_type(binding.type) ? "action" : "service"})) {}

  [[nodiscard]] bool open() override {
    side_->open();
    if constexpr (requires(Side & side) { side.await_server(Duration::zero()); })
      if (prepared_.wait > Duration::zero() && !side_->await_server(prepared_.wait))
        throw std::runtime_error("there is no server of " + prepared_.endpoint.topic);
    return true;
  }
  void close() override { side_->close(); }

 protected:
  Prepared prepared_;
  std::shared_ptr<Side> side_;
};

/// Makes the driver of the side that the binding's role names. kind: "service" or "action". nullptr and `error`: the
/// binding is wrong.
template <class Driver, class ClientSide, class ServerSide>
std::unique_ptr<Driver> made_for_role(const Ros2Binding& binding, Direction direction,
                                      const std::string& kind, bool has_type, std::string& error) {
  try {
    if (binding.role != "client" && binding.role != "server")
      throw std::runtime_error("'" + binding.role + "' is the role of no " + kind);
    if (!has_type) throw std::runtime_error("'" + binding.type + "' is no " + kind);
    Prepared prepared = prepare(binding, direction);
    if (binding.role == "client") return std::make_unique<ClientSide>(std::move(prepared), binding);
    return std::make_unique<ServerSide>(std::move(prepared), binding);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

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
  /// Another own field of the value, such as `state_field`.
  [[nodiscard]] std::uint64_t own(const Prepared& prepared, std::size_t field) const {
    return prepared.translator.own_number(sink_.bytes(), field);
  }
  [[nodiscard]] const std::vector<std::byte>& message() const { return message_; }

 private:
  ValueSink sink_;
  std::uint64_t call_ = 0;
  std::vector<std::byte> message_;
};

}  // namespace tessera::ros2
