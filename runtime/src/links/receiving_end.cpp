#include "links/receiving_end.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tessera {
namespace {

/// After this time, it checks again whether the slot is free. A copy of a value takes no longer.
constexpr Duration until_free = std::chrono::microseconds(200);

}  // namespace

ReceivingEnd::ReceivingEnd(const LinkedChannel& channel, SharedChannel& word, const ValueEncoding& encoding,
                           std::size_t value_bytes, const ValueType* type, network::Incarnation incarnation,
                           Waker& service)
    : NetworkEnd(channel, false, service),
      word_(word),
      encoding_(encoding),
      type_(type),
      receiver_(channel.exchanged ? network::Receiving::exchange : network::Receiving::once, incarnation) {
  decoded_.bytes.resize(value_bytes);
  if (type_ != nullptr) type_->construct(decoded_.bytes.data());
  held_.bytes.reserve(encoding.most);
  repetition_.start(false);
}

ReceivingEnd::~ReceivingEnd() {
  if (type_ != nullptr) type_->destroy(decoded_.bytes.data());
}

// ------------------------------------------------------------------------------------------ subsystem

std::uint32_t ReceivingEnd::fired(Firing firing, Time now, RecordingLane* lane) {
  if (firing.elapsed || (firing.taken != 0 && firing.produced != 0)) return 0;  // there was no value
  if (firing.produced == 0) {
    reading_ = static_cast<std::uint32_t>(number_);
    record_peer(from_, now, lane);
  } else if (!channel().exchanged) {
    tell();  // the value was taken
  }
  return reading_;
}

// ------------------------------------------------------------------------------------------ service

void ReceivingEnd::serve(Time now, LinkServices& services) {
  static_cast<void>(take_news());
  finish_read(services);
  take_held(now, services);
  if (announce_ <= now) announce(now, services);
}

/// Announces this receiver until a sender is heard.
void ReceivingEnd::announce(Time now, LinkServices& services) {
  answer(receiver_.repeat(), services);
  const auto interval = repetition_.interval();
  repetition_.again();
  announce_ = receiver_.repeats() && interval ? now + *interval : Time::max();
}

void ReceivingEnd::hear(const network::Data& data, const network::Value& value, Time stamp, Time now,
                        LinkServices& services) {
  set_disconnected(false);
  if (!seize(services)) return hold(data, value, stamp, now);
  accept(data, value, stamp, services);
  release();
}

/// Precondition: the token of the slot has been taken.
void ReceivingEnd::accept(const network::Data& data, const network::Value& value, Time stamp,
                          LinkServices& services) {
  if (!data.recall && !encoding_.take(decoded_.bytes.data(), value.bytes)) {
    if (!std::exchange(undecodable_, true))
      services.complain(channel(),
                        "a value has come that is none of its type: was the sender made of another "
                        "specification?",
                        false);
    return;
  }
  const network::Receiver::Effects effects = receiver_.hear(data);
  if (effects.keep) keep(data, value.valid, stamp);
  answer(effects, services);
  if (!receiver_.repeats()) announce_ = Time::max();
}

/// The newest message counts: a value contains the older ones, and so does a recall.
void ReceivingEnd::hold(const network::Data& data, const network::Value& value, Time stamp, Time now) {
  const auto age = [](const network::Data& one) { return std::tuple(one.from, one.number, one.recall); };
  if (held_.any && age(data) < age(held_.data)) return;
  held_.any = true;
  held_.data = data;
  held_.stamp = stamp;
  held_.valid = value.valid;
  held_.bytes.assign(value.bytes.begin(), value.bytes.end());
  look_ = now + until_free;
}

void ReceivingEnd::take_held(Time now, LinkServices& services) {
  if (!held_.any) return;
  look_ = now + until_free;
  if (!seize(services)) return;
  held_.any = false;
  accept(held_.data, {held_.stamp.time_since_epoch(), held_.valid, held_.bytes}, held_.stamp, services);
  release();
}

/// Only the service gives `full`, and only a read makes `empty` of it.
void ReceivingEnd::finish_read(LinkServices& services) {
  if (channel().exchanged || !receiver_.full() || (word_.marking() & channel().empty) == 0) return;
  end_read(services);
}

void ReceivingEnd::end_read(LinkServices& services) {
  receiver_.begin_read();
  answer(receiver_.end_read(), services);
}

/// The token shows what has happened: a read may have ended since the last check.
bool ReceivingEnd::seize(LinkServices& services) {
  const auto always = [] { return true; };
  for (const std::uint16_t token : {channel().own_memory, channel().empty, channel().full}) {
    if (token == 0 || word_.fire_if(Side::send, token, 0, always) == 0) continue;
    if (token == channel().empty && receiver_.full()) end_read(services);
    return true;
  }
  return false;
}

void ReceivingEnd::release() {
  const std::uint16_t token = channel().exchanged ? channel().own_memory
                              : receiver_.full()  ? channel().full
                                                  : channel().empty;
  static_cast<void>(word_.fire_if(Side::send, 0, token, [] { return true; }));
}

void ReceivingEnd::keep(const network::Data& data, bool valid, Time stamp) {
  SharedChannel::Memory& memory = word_.memory();
  if (type_ == nullptr)
    std::memcpy(memory.bytes.data(), decoded_.bytes.data(), decoded_.bytes.size());
  else
    type_->assign(memory.bytes.data(), decoded_.bytes.data());
  memory.stamp = stamp;
  memory.valid = valid;
  memory.sequence = word_.next_sequence();
  number_ = data.number.value;
  from_ = data.from;
}

void ReceivingEnd::answer(const network::Receiver::Effects& effects, LinkServices& services) {
  if (effects.answer) services.send(channel(), *effects.answer);
}

}  // namespace tessera
