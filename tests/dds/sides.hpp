#pragma once

#include <chrono>
#include <cstring>
#include <optional>
#include <vector>

#include "network/carrier.hpp"
#include "network/receiver.hpp"
#include "network/repetition.hpp"
#include "network/sender.hpp"

namespace tessera::test {

/// The sender's side of a channel over a carrier, as a controller uses it. Values are counts.
class SendingSide final : public network::Carrier::Listener {
 public:
  SendingSide(network::Carrier& carrier, network::ChannelNumber channel, network::Incarnation me)
      : carrier_(carrier), channel_(channel), sender_(network::Sending::blocking, me) {}

  void write(std::uint64_t count) {
    count_ = count;
    apply(sender_.write());
    repetition_.start(false);
    last_ = Clock::now();
  }
  [[nodiscard]] bool waiting() const { return sender_.waiting(); }

  void step() {
    using namespace std::chrono_literals;
    std::chrono::nanoseconds longest = 20ms;
    if (const auto interval = repetition_.interval(); interval && sender_.repeats()) {
      const auto left = last_ + *interval - Clock::now();
      if (left <= 0ns) {
        apply(sender_.repeat());
        repetition_.again();
        ++repetitions;
        last_ = Clock::now();
      }
      longest = std::clamp<std::chrono::nanoseconds>(left, 0ns, longest);
    }
    carrier_.receive(*this, longest);
  }

  void heard(network::ChannelNumber, const network::Data&, const network::Value&) override { ++strange; }
  void heard(network::ChannelNumber channel, const network::State& state) override {
    if (channel != channel_) return;
    apply(sender_.hear(state));
    if (!sender_.repeats()) repetition_.stop();
  }
  void reachable(network::ProcessNumber, bool) override {}
  void complaint(std::string_view) override { ++strange; }

  int strange = 0, repetitions = 0;

 private:
  using Clock = std::chrono::steady_clock;
  void apply(const network::Sender::Effects& effects) {
    if (effects.send)
      carrier_.send(channel_, *effects.send, {{}, true, std::as_bytes(std::span(&count_, 1))});
  }

  network::Carrier& carrier_;
  network::ChannelNumber channel_;
  network::Sender sender_;
  network::Repetition repetition_;
  Clock::time_point last_;
  std::uint64_t count_ = 0;
};

class ReceivingSide final : public network::Carrier::Listener {
 public:
  ReceivingSide(network::Carrier& carrier, network::ChannelNumber channel, network::Incarnation me)
      : carrier_(carrier), channel_(channel), receiver_(network::Receiving::once, me) {}

  void step() {
    using namespace std::chrono_literals;
    if (receiver_.repeats() && Clock::now() - last_ > 20ms) {
      apply(receiver_.repeat());
      last_ = Clock::now();
    }
    carrier_.receive(*this, 20ms);
  }
  /// Takes the value in the slot.
  [[nodiscard]] std::optional<std::uint64_t> read() {
    if (!receiver_.full()) return std::nullopt;
    receiver_.begin_read();
    const std::uint64_t value = slot_;
    apply(receiver_.end_read());
    return value;
  }

  void heard(network::ChannelNumber channel, const network::Data& data,
             const network::Value& value) override {
    if (channel != channel_) return;
    const auto effects = receiver_.hear(data);
    if (effects.malformed || value.bytes.size() != sizeof slot_) ++strange;
    if (effects.keep) std::memcpy(&slot_, value.bytes.data(), sizeof slot_);
    apply(effects);
  }
  void heard(network::ChannelNumber, const network::State&) override { ++strange; }
  void reachable(network::ProcessNumber, bool is_there) override { sees_sender_ = is_there; }
  void complaint(std::string_view) override { ++strange; }
  [[nodiscard]] bool sees_sender() const { return sees_sender_; }

  int strange = 0;

 private:
  using Clock = std::chrono::steady_clock;
  bool sees_sender_ = false;
  void apply(const network::Receiver::Effects& effects) {
    if (effects.answer) carrier_.send(channel_, *effects.answer);
  }

  network::Carrier& carrier_;
  network::ChannelNumber channel_;
  network::Receiver receiver_;
  Clock::time_point last_;
  std::uint64_t slot_ = 0;
};

}  // namespace tessera::test
