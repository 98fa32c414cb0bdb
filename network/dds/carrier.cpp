#include "network/dds/carrier.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <type_traits>

#include "network/dds/middleware_log.hpp"
#include "network/dds/received.hpp"
#include "network/dds/setup_error.hpp"
#include "network/dds/status/status_topic.hpp"

namespace tessera::dds {
namespace {

/// The limit keeps a flood of messages from holding up receive() for ever.
constexpr int most_at_once = 1000;

std::chrono::nanoseconds wall_time() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::system_clock::now().time_since_epoch());
}

Announcement announcement_in(const tessera_wire_Announcement& sample) {
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
  const tessera_wire_Alive sign = signs_.next(now.time_since_epoch(), wall_time());
  dds_write(endpoints_->alive_writer(), &sign);
}

void DdsCarrier::give_room(tessera_wire_Data& sample) {
  // The middleware cuts off a longer value, because it cannot enlarge this buffer. It forgets the buffer when
  // a writer has left and there is no value.
  sample.bytes._buffer = room_.data();
  sample.bytes._maximum = static_cast<std::uint32_t>(room_.size());
  sample.bytes._length = 0;
  sample.bytes._release = false;
}

void DdsCarrier::hear(const tessera_wire_Data& data, Listener& listener, Clock::time_point now) {
  presence_.heard(data.process, data.from_incarnation, now, listener);
  listener.heard(data.channel,
                 network::Data{{data.from_incarnation}, {data.to_incarnation}, {data.number}, data.recall},
                 network::Value{std::chrono::nanoseconds(data.stamp_ns), data.valid,
                                std::as_bytes(std::span(data.bytes._buffer, data.bytes._length))});
}

void DdsCarrier::hear(const tessera_wire_State& state, Listener& listener, Clock::time_point now) {
  presence_.heard(state.process, state.from_incarnation, now, listener);
  listener.heard(state.channel,
                 network::State{{state.from_incarnation}, {state.peer_incarnation}, {state.taken}});
}

void DdsCarrier::hear(const tessera_wire_Alive& alive, Listener& listener, Clock::time_point now) {
  presence_.heard(alive.process, alive.incarnation, now, listener);
  if (const auto signs = signs_.hear(alive, Clock::now().time_since_epoch(), wall_time()))
    listener.alive(alive.process, *signs);
}

template <class Sample>
bool DdsCarrier::is_good(const Sample& sample) {
  const Refusal refusal = check(sample, deployment_);
  if (refusal != Refusal::none) dropped_.add([&] { return description(refusal, sample, deployment_); });
  return refusal == Refusal::none;
}

template <class Sample, class Hear>
void DdsCarrier::take_from(dds_entity_t reader, const Hear& hear_one) {
  Sample sample{};
  void* pointer = &sample;
  dds_sample_info_t info{};
  for (int taken = 0; taken < most_at_once; ++taken) {
    if constexpr (std::is_same_v<Sample, tessera_wire_Data>) give_room(sample);
    if (dds_take(reader, &pointer, &info, 1, 1) != 1) return;
    hear_one(sample, info);
  }
}

void DdsCarrier::take_all(Listener& listener) {
  const Clock::time_point now = Clock::now();
  take_announcements(listener);
  take_from<tessera_wire_Alive>(endpoints_->alive(), [&](const auto& alive, const auto& info) {
    if (!is_good(alive)) return;
    if (info.instance_state != DDS_IST_ALIVE)
      presence_.left(alive.process, alive.incarnation, listener);
    else if (info.valid_data)
      hear(alive, listener, now);
    else  // the middleware reports a writer without a value
      presence_.heard(alive.process, alive.incarnation, now, listener);
  });
  const auto hear_valid = [&](const auto& sample, const auto& info) {
    if (info.valid_data && is_good(sample)) hear(sample, listener, now);
  };
  take_from<tessera_wire_State>(endpoints_->state(), hear_valid);
  take_from<tessera_wire_Data>(endpoints_->data(), hear_valid);
}

void DdsCarrier::take_announcements(Listener& listener) {
  void* sample = nullptr;
  dds_sample_info_t info{};
  for (int taken = 0;
       taken < most_at_once && dds_take(endpoints_->announcements(), &sample, &info, 1, 1) == 1; ++taken) {
    if (info.valid_data)
      if (const auto problem =
              announcements_.hear(announcement_in(*static_cast<const tessera_wire_Announcement*>(sample))))
        listener.complaint(*problem);
    dds_return_loan(endpoints_->announcements(), &sample, 1);
    sample = nullptr;
  }
}

}  // namespace tessera::dds
