#include "network/dds/carrier.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "network/dds/middleware_log.hpp"
#include "network/dds/received.hpp"
#include "network/dds/setup_error.hpp"
#include "network/dds/status/status_topic.hpp"

namespace tessera::dds {
namespace {

/// The limit keeps a flood of messages from holding up receive() for ever.
constexpr int most_at_once = 1000;

network::Incarnation incarnation(std::uint64_t value) { return {value}; }
network::Number number(std::uint64_t value) { return {value}; }

ReceivedData fields(const tessera_wire_Data& sample) {
  return {.channel = sample.channel,
          .process = sample.process,
          .from = sample.from_incarnation,
          .to = sample.to_incarnation,
          .number = sample.number,
          .stamp_ns = sample.stamp_ns,
          .recall = sample.recall,
          .valid = sample.valid,
          .bytes = std::as_bytes(std::span(sample.bytes._buffer, sample.bytes._length))};
}

ReceivedState fields(const tessera_wire_State& sample) {
  return {.channel = sample.channel,
          .process = sample.process,
          .from = sample.from_incarnation,
          .peer = sample.peer_incarnation,
          .taken = sample.taken};
}

ReceivedAlive fields(const tessera_wire_Alive& sample) {
  return {.process = sample.process,
          .incarnation = sample.incarnation,
          .number = sample.number,
          .sent_ns = sample.sent_ns,
          .wall_ns = sample.wall_ns,
          .echo_process = sample.echo_process,
          .echo_incarnation = sample.echo_incarnation,
          .echo_ns = sample.echo_ns,
          .held_ns = sample.held_ns};
}

std::chrono::nanoseconds wall_time() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::system_clock::now().time_since_epoch());
}

Announcement fields(const tessera_wire_Announcement& sample) {
  return {.incarnation = sample.incarnation,
          .system = sample.system,
          .process_name = sample.process_name,
          .wire_version = sample.wire_version,
          .net_hash = sample.net_hash,
          .processes_hash = sample.processes_hash,
          .host = sample.host,
          .boot = sample.boot};
}

/// Notices whether a listener was called.
class Attentive final : public network::Carrier::Listener {
 public:
  explicit Attentive(network::Carrier::Listener& listener) : listener_(listener) {}
  void heard(ChannelNumber channel, const network::Data& data, const network::Value& value) override {
    told_ = true;
    listener_.heard(channel, data, value);
  }
  void heard(ChannelNumber channel, const network::State& state) override {
    told_ = true;
    listener_.heard(channel, state);
  }
  void reachable(ProcessNumber process, bool is_there) override {
    told_ = true;
    listener_.reachable(process, is_there);
  }
  // Does not count as news: no caller waits for a sign of life.
  void alive(ProcessNumber process, const network::SignsOfLife& signs) override {
    listener_.alive(process, signs);
  }
  void complaint(std::string_view text) override {
    told_ = true;
    listener_.complaint(text);
  }
  [[nodiscard]] bool told() const { return told_; }

 private:
  network::Carrier::Listener& listener_;
  bool told_ = false;
};

/// A sum that does not overflow.
Clock::time_point after(Clock::time_point now, std::chrono::nanoseconds time) {
  return time > Clock::time_point::max() - now ? Clock::time_point::max() : now + time;
}

}  // namespace

DdsCarrier::DdsCarrier(const network::CarrierSetup& setup, const AddressOf& address_of,
                       std::chrono::milliseconds search_interval)
    : deployment_(deployment_of(setup)),
      presence_(deployment_),
      announcements_(deployment_),
      signs_(deployment_),
      location_(locate(setup.interface, setup.peers, address_of)),
      search_(location_.unresolved_hosts(), address_of, search_interval),
      domain_(setup.domain),
      endpoints_(std::make_unique<Endpoints>(deployment_, domain_, location_)),
      // One byte more than the longest value, so that a longer one is noticed.
      room_(deployment_.longest_received_bytes() + 1) {}

void DdsCarrier::wake() {
  const std::lock_guard lock(replacing_);
  endpoints_->wake();
}

std::size_t DdsCarrier::watchers() {
  const std::lock_guard lock(sending_status_);
  return matched_readers(endpoints_->status_writer());
}

void DdsCarrier::send_status(network::StatusPart part, std::string_view text) {
  const std::lock_guard lock(sending_status_);
  write_status(endpoints_->status_writer(), {deployment_.process, deployment_.incarnation}, part, text);
}

void DdsCarrier::tell_of_unresolved(Listener& listener) {
  for (const Location::Unresolved& one : location_.unresolved)
    listener.complaint("peer " + one.host + " has no IPv4 address (" + one.why +
                       "): this process goes on without it, and asks again");
  location_.unresolved.clear();
}

/// The middleware takes peers only when its domain is made. So a second domain replaces the first. The other
/// processes see this process leave and return with the same incarnation; the protocol of channels repeats
/// the messages that were on the way.
void DdsCarrier::join_found(Listener& listener) {
  bool any = false;
  for (const PeerSearch::Found& found : search_.take_found()) try {
      any = add_peer(location_, found.host, found.address) || any;
      listener.complaint("peer " + found.host + " has an address now: " + found.address);
    } catch (const SetupError& problem) {
      listener.complaint(problem.what());
    }
  if (!any) return;
  try {
    auto wider = std::make_unique<Endpoints>(deployment_, domain_, location_);
    const std::scoped_lock lock(replacing_, sending_status_);
    endpoints_.swap(wider);
    endpoints_->wake();  // a wake of the first domain may be lost
    next_sign_of_life_ = Clock::time_point::min();
  } catch (const SetupError& problem) {
    listener.complaint(std::string("peers cannot be added: ") + problem.what());
  }
}

void DdsCarrier::send(ChannelNumber number, const network::Data& data, const network::Value& value) {
  const Channel* channel = deployment_.channel(number);
  assert(channel != nullptr && channel->sender == deployment_.process);
  if (!data.recall && value.bytes.size() > channel->longest_value_bytes)
    return unsent_.add([&] { return "on channel " + channel->name + ": a value longer than the channel's"; });
  tessera_wire_Data sample{};
  sample.channel = number;
  sample.process = deployment_.process;
  sample.from_incarnation = data.from.value;
  sample.to_incarnation = data.to.value;
  sample.number = data.number.value;
  sample.recall = data.recall;
  if (!data.recall) {
    sample.stamp_ns = value.stamp.count();
    sample.valid = value.valid;
    // The middleware only reads them, but its C type has no const.
    sample.bytes._buffer =
        const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(value.bytes.data()));
    sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(value.bytes.size());
  }
  count_unsent(dds_write(endpoints_->to(channel->receiver).data, &sample), *channel);
}

void DdsCarrier::send(ChannelNumber number, const network::State& state) {
  const Channel* channel = deployment_.channel(number);
  assert(channel != nullptr && channel->receiver == deployment_.process);
  const tessera_wire_State sample{.channel = number,
                                  .process = deployment_.process,
                                  .from_incarnation = state.from.value,
                                  .peer_incarnation = state.peer.value,
                                  .taken = state.taken.value};
  count_unsent(dds_write(endpoints_->to(channel->sender).state, &sample), *channel);
}

void DdsCarrier::count_unsent(dds_return_t result, const Channel& channel) {
  // A full network shows as a timeout; the protocol sends again.
  if (result == DDS_RETCODE_OK || result == DDS_RETCODE_TIMEOUT) return;
  unsent_.add([&] { return "on channel " + channel.name + ": " + dds_strretcode(result); });
}

void DdsCarrier::receive(Listener& told, std::chrono::nanoseconds longest) {
  const Clock::time_point end = after(Clock::now(), longest);
  Attentive listener(told);
  for (;;) {
    tell_of_unresolved(listener);
    join_found(listener);
    const bool woken = endpoints_->was_woken();
    take_all(listener);
    // After the messages that have arrived: they may have waited for long if receive() was not called.
    const Clock::time_point now = Clock::now();
    presence_.look(now, listener);
    dropped_.tell(now, listener);
    unsent_.tell(now, listener);
    if (const auto text = middleware_log_report(now)) listener.complaint(*text);
    give_sign_of_life(now);
    if (listener.told() || woken || now >= end) return;
    endpoints_->wait((std::min(end, next_event()) - now).count());
  }
}

Clock::time_point DdsCarrier::next_event() const {
  return std::min(next_sign_of_life_, presence_.next_look().value_or(Clock::time_point::max()));
}

void DdsCarrier::give_sign_of_life(Clock::time_point now) {
  if (now < next_sign_of_life_) return;
  next_sign_of_life_ = now + deployment_.sign_of_life_period();
  if (endpoints_->alive_writer() == 0) return;
  const ReceivedAlive sign = signs_.next(now.time_since_epoch(), wall_time());
  const tessera_wire_Alive sample{.process = sign.process,
                                  .incarnation = sign.incarnation,
                                  .number = sign.number,
                                  .sent_ns = sign.sent_ns,
                                  .wall_ns = sign.wall_ns,
                                  .echo_process = sign.echo_process,
                                  .echo_incarnation = sign.echo_incarnation,
                                  .echo_ns = sign.echo_ns,
                                  .held_ns = sign.held_ns};
  dds_write(endpoints_->alive_writer(), &sample);
}

void DdsCarrier::take_all(Listener& listener) {
  const Clock::time_point now = Clock::now();
  take_announcements(listener);
  take_alive(listener, now);
  take_states(listener, now);
  take_data(listener, now);
}

bool DdsCarrier::take(tessera_wire_Data& sample, dds_sample_info_t& info) {
  // The middleware cuts off a longer value, because it cannot enlarge this buffer. It forgets the buffer when
  // a writer has left and there is no value.
  sample.bytes._buffer = room_.data();
  sample.bytes._maximum = static_cast<std::uint32_t>(room_.size());
  sample.bytes._length = 0;
  sample.bytes._release = false;
  void* pointer = &sample;
  return dds_take(endpoints_->data(), &pointer, &info, 1, 1) == 1;
}

void DdsCarrier::take_data(Listener& listener, Clock::time_point now) {
  tessera_wire_Data sample{};
  dds_sample_info_t info{};
  for (int taken = 0; taken < most_at_once && take(sample, info); ++taken)
    if (info.valid_data) hear(sample, listener, now);
}

void DdsCarrier::hear(const tessera_wire_Data& sample, Listener& listener, Clock::time_point now) {
  const ReceivedData data = fields(sample);
  const Refusal refusal = check(data, deployment_);
  if (refusal != Refusal::none) return dropped_.add([&] { return description(refusal, data, deployment_); });
  presence_.heard(data.process, data.from, now, listener);
  listener.heard(
      data.channel,
      network::Data{incarnation(data.from), incarnation(data.to), number(data.number), data.recall},
      network::Value{std::chrono::nanoseconds(data.stamp_ns), data.valid, data.bytes});
}

void DdsCarrier::take_states(Listener& listener, Clock::time_point now) {
  tessera_wire_State sample{};
  void* pointer = &sample;
  dds_sample_info_t info{};
  for (int taken = 0; taken < most_at_once && dds_take(endpoints_->state(), &pointer, &info, 1, 1) == 1;
       ++taken)
    if (info.valid_data) hear(sample, listener, now);
}

void DdsCarrier::hear(const tessera_wire_State& sample, Listener& listener, Clock::time_point now) {
  const ReceivedState state = fields(sample);
  const Refusal refusal = check(state, deployment_);
  if (refusal != Refusal::none) return dropped_.add([&] { return description(refusal, state, deployment_); });
  presence_.heard(state.process, state.from, now, listener);
  listener.heard(state.channel,
                 network::State{incarnation(state.from), incarnation(state.peer), number(state.taken)});
}

void DdsCarrier::take_alive(Listener& listener, Clock::time_point now) {
  tessera_wire_Alive sample{};
  void* pointer = &sample;
  dds_sample_info_t info{};
  for (int taken = 0; taken < most_at_once && dds_take(endpoints_->alive(), &pointer, &info, 1, 1) == 1;
       ++taken) {
    const ReceivedAlive alive = fields(sample);
    const Refusal refusal = check(alive, deployment_);
    if (refusal != Refusal::none)
      dropped_.add([&] { return description(refusal, alive, deployment_); });
    else if (info.instance_state == DDS_IST_ALIVE)
      hear(alive, info.valid_data, listener, now);
    else
      presence_.left(alive.process, alive.incarnation, listener);
  }
}

void DdsCarrier::hear(const ReceivedAlive& alive, bool whole, Listener& listener, Clock::time_point now) {
  presence_.heard(alive.process, alive.incarnation, now, listener);
  if (!whole) return;  // the middleware reports a writer without a value
  if (const auto signs = signs_.hear(alive, Clock::now().time_since_epoch(), wall_time()))
    listener.alive(alive.process, *signs);
}

void DdsCarrier::take_announcements(Listener& listener) {
  void* sample = nullptr;
  dds_sample_info_t info{};
  for (int taken = 0;
       taken < most_at_once && dds_take(endpoints_->announcements(), &sample, &info, 1, 1) == 1; ++taken) {
    if (info.valid_data)
      if (const auto problem =
              announcements_.hear(fields(*static_cast<const tessera_wire_Announcement*>(sample))))
        listener.complaint(*problem);
    dds_return_loan(endpoints_->announcements(), &sample, 1);
    sample = nullptr;
  }
}

}  // namespace tessera::dds
