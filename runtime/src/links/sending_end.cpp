#include "links/sending_end.hpp"

namespace tessera {
namespace {

[[nodiscard]] network::Sending sending_of(const LinkedChannel& channel) {
  if (channel.exchanged) return network::Sending::exchange;
  return channel.sender_blocks ? network::Sending::blocking : network::Sending::non_blocking;
}

}  // namespace

SendingEnd::SendingEnd(const LinkedChannel& channel, SharedChannel& word, const ValueEncoding& encoding,
                       network::Incarnation incarnation, Waker& service)
    : NetworkEnd(channel, true, service),
      word_(word),
      encoding_(encoding),
      outbox_(encoding.most),
      sender_(sending_of(channel), incarnation) {}

// ------------------------------------------------------------------------------------------ subsystem

void SendingEnd::write(const void* value, Time now, bool valid) {
  Outbox::Box& box = outbox_.back();
  box.number = begun_.load(std::memory_order_relaxed) + 1;
  box.stamp = now;
  box.valid = valid;
  box.bytes.clear();
  encoding_.put(value, box.bytes);
  // Relaxed: the compare-and-swap of t2 releases it together with the word.
  begun_.store(box.number, std::memory_order_relaxed);
}

std::uint32_t SendingEnd::fired(Firing firing, Time now, RecordingLane* lane) {
  const std::uint64_t number = begun_.load(std::memory_order_relaxed);
  const auto low = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  if (firing.elapsed) {
    given_up_.store(number, std::memory_order_release);
    tell();
    return firing.taken == 0 ? 0 : low(number);  // `timeout` touches no place of the channel
  }
  if (channel().exchanged && firing.produced == 0) return low(number + 1);  // the value about to be written
  if ((firing.taken & channel().empty) != 0) {                              // it was taken
    record_peer({taken_by_.load(std::memory_order_relaxed)}, now, lane);
    return low(number);
  }
  outbox_.publish();
  tell();
  return low(number);
}

// ------------------------------------------------------------------------------------------ service

void SendingEnd::serve(Time now, LinkServices& services) {
  if (take_news()) {
    take_value(now, services);
    give_up_if_told(now, services);
  }
  if (due_ > now) return;
  const network::Sender::Effects effects = sender_.repeat();
  repetition_.again();
  send(effects, now, services);
}

void SendingEnd::take_value(Time now, LinkServices& services) {
  if (!outbox_.take()) return;
  const network::Number number{outbox_.front().number};
  // Its time was over before the service saw it: the value before it was given up, too.
  const bool too_late = given_up_.load(std::memory_order_acquire) >= number.value;
  if (sender_.waiting()) {
    const network::Sender::Effects effects = sender_.time_is_up();
    repetition_.start(true);
    if (too_late) send(effects, now, services);
  }
  if (too_late) return;
  const network::Sender::Effects effects = sender_.write(number);
  repetition_.start(false);
  send(effects, now, services);
}

void SendingEnd::give_up_if_told(Time now, LinkServices& services) {
  if (!sender_.waiting() || given_up_.load(std::memory_order_acquire) < sender_.number().value) return;
  const network::Sender::Effects effects = sender_.time_is_up();
  repetition_.start(true);
  send(effects, now, services);
}

void SendingEnd::hear(const network::State& state, Time now, LinkServices& services) {
  set_disconnected(false);
  const network::Sender::Effects effects = sender_.hear(state);
  if (effects.superseded && !superseded_) {
    superseded_ = true;
    services.complain(channel(),
                      "the receiver follows a later start of this process: it was started a second time, "
                      "here or on another machine, or the clock was set back before this start; it will "
                      "never listen",
                      true);
  }
  if (effects.taken) acknowledge(state.from);
  // A receiver that announces itself again and again must not delay the repetition: it may lack exactly that
  // message.
  if (!effects.send && sender_.repeats()) return;
  if (effects.send) repetition_.start(effects.send->recall);
  send(effects, now, services);
}

void SendingEnd::acknowledge(network::Incarnation by) {
  const std::uint64_t number = sender_.number().value;
  const auto still = [&] { return begun_.load(std::memory_order_relaxed) == number; };
  taken_by_.store(by.value, std::memory_order_relaxed);  // released by the swap
  for (const std::uint16_t on_the_way : {channel().sent, channel().more})
    if (on_the_way != 0 && word_.fire_if(Side::receive, on_the_way, channel().idle, still) != 0) return;
}

void SendingEnd::send(const network::Sender::Effects& effects, Time now, LinkServices& services) {
  if (effects.send) {
    const Outbox::Box& box = outbox_.front();
    services.send(channel(), *effects.send, {box.stamp.time_since_epoch(), box.valid, box.bytes.bytes()});
  }
  schedule(now);
}

void SendingEnd::schedule(Time now) {
  set_sending(sender_.pending(), now);
  if (!sender_.repeats()) repetition_.stop();
  const auto interval = repetition_.interval();
  due_ = interval ? now + *interval : Time::max();
}

}  // namespace tessera
