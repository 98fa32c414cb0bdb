#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "network/dds/announcements.hpp"
#include "network/dds/dropped.hpp"
#include "network/dds/presence.hpp"
#include "network/dds/received.hpp"
#include "network/dds/signs_of_life.hpp"
#include "tests/dds/crossing.hpp"

/// Whatever the fields of messages are, they are dropped with a text that can be shown, or fit the deployment.
/// The first byte of each message says of which kind it is, the rest are its fields.
namespace {

using namespace tessera;
using test::Crossing;

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] bool any() const { return size_ > 0; }
  template <class T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof value, size_);
    std::memcpy(&value, data_, count);
    skip(count);
    return value;
  }
  std::span<const std::byte> take_some() {
    const std::size_t count = std::min<std::size_t>(take<std::uint8_t>(), size_);
    const std::span some(reinterpret_cast<const std::byte*>(data_), count);
    skip(count);
    return some;
  }
  std::string take_text() {
    const auto some = take_some();
    return {reinterpret_cast<const char*>(some.data()), some.size()};
  }
  /// Mostly small numbers, which mean something.
  std::uint32_t take_index() {
    const auto first = take<std::uint8_t>();
    return first < 200 ? first % 9 : take<std::uint32_t>();
  }

 private:
  void skip(std::size_t count) {
    data_ += count;
    size_ -= count;
  }
  const std::uint8_t* data_;
  std::size_t size_;
};

void require(bool holds) {
  if (!holds) std::abort();
}

/// Fails at any text that is not safe for a terminal.
struct Reader final : network::Carrier::Listener {
  void heard(network::ChannelNumber, const network::Data&, const network::Value&) override {}
  void heard(network::ChannelNumber, const network::State&) override {}
  void reachable(network::ProcessNumber process, bool) override { require(process < 3); }
  void complaint(std::string_view text) override {
    for (const char letter : text) require(static_cast<unsigned char>(letter) >= 0x20 && letter != 0x7f);
    require(text.size() < 1000);
  }
};

struct Station {
  explicit Station(const dds::Deployment& its_deployment)
      : deployment(its_deployment),
        presence(its_deployment),
        signs(its_deployment),
        announcements(its_deployment) {}

  void hear_data(Bytes& bytes) {
    tessera_wire_Data data{};
    data.channel = bytes.take_index();
    data.process = bytes.take_index();
    data.from_incarnation = bytes.take<std::uint64_t>();
    data.to_incarnation = bytes.take<std::uint64_t>();
    data.number = bytes.take<std::uint64_t>();
    data.stamp_ns = bytes.take<std::int64_t>();
    data.recall = bytes.take<std::uint8_t>() % 2 == 1;
    const std::span<const std::byte> value = bytes.take_some();
    data.bytes._length = static_cast<std::uint32_t>(value.size());
    const dds::Refusal refusal = dds::check(data, deployment);
    if (refusal != dds::Refusal::none) return drop(refusal, data);
    const dds::Channel& channel = deployment.channels.at(data.channel);
    require(channel.receiver == deployment.process && channel.sender == data.process);
    require(data.from_incarnation != 0 && data.number != 0 &&
            data.bytes._length <= channel.longest_value_bytes);
    presence.heard(data.process, data.from_incarnation, now, reader);
  }
  void hear_state(Bytes& bytes) {
    tessera_wire_State state{};
    state.channel = bytes.take_index();
    state.process = bytes.take_index();
    state.from_incarnation = bytes.take<std::uint64_t>();
    state.peer_incarnation = bytes.take<std::uint64_t>();
    state.taken = bytes.take<std::uint64_t>();
    const dds::Refusal refusal = dds::check(state, deployment);
    if (refusal != dds::Refusal::none) return drop(refusal, state);
    const dds::Channel& channel = deployment.channels.at(state.channel);
    require(channel.sender == deployment.process && channel.receiver == state.process &&
            state.from_incarnation != 0);
    presence.heard(state.process, state.from_incarnation, now, reader);
  }
  void hear_alive(Bytes& bytes, bool leaves) {
    tessera_wire_Alive alive{};
    alive.process = bytes.take_index();
    alive.incarnation = bytes.take<std::uint64_t>();
    const dds::Refusal refusal = dds::check(alive, deployment);
    if (refusal != dds::Refusal::none) return drop(refusal, alive);
    if (leaves) return presence.left(alive.process, alive.incarnation, reader);
    presence.heard(alive.process, alive.incarnation, now, reader);
    alive.number = bytes.take<std::uint64_t>();
    alive.sent_ns = bytes.take<std::int64_t>();
    alive.wall_ns = bytes.take<std::int64_t>();
    alive.echo_process = deployment.process;
    alive.echo_incarnation = deployment.incarnation;
    alive.echo_ns = bytes.take<std::int64_t>();
    alive.held_ns = bytes.take<std::int64_t>();
    const auto heard = signs.hear(alive, now.time_since_epoch(), now.time_since_epoch());
    if (heard) require(heard->expected > 0 && heard->expected <= 64 && heard->lost < heard->expected);
    if (heard && heard->clock) require(heard->clock->uncertainty.count() >= 0);
    static_cast<void>(signs.next(now.time_since_epoch(), now.time_since_epoch()));
  }
  void hear_announcement(Bytes& bytes) {
    dds::Announcement other = dds::announcement_of(deployment);
    const auto which = bytes.take<std::uint8_t>();
    if ((which & 1) != 0) other.wire_version = bytes.take<std::uint32_t>();
    if ((which & 2) != 0) other.net_hash = bytes.take_text();
    if ((which & 4) != 0) other.processes_hash = bytes.take_text();
    if ((which & 8) != 0) other.process_name = bytes.take_text();
    if ((which & 16) != 0) other.host = bytes.take_text();
    if ((which & 32) != 0) other.system = bytes.take_text();
    if ((which & 64) != 0) other.incarnation = bytes.take<std::uint64_t>();
    if (const auto problem = announcements.hear(other)) reader.complaint(*problem);
    require(!announcements.hear(other));
  }
  template <class Message>
  void drop(dds::Refusal refusal, const Message& message) {
    dropped.add([&] { return dds::description(refusal, message, deployment); });
    dropped.tell(now, reader);
  }

  const dds::Deployment& deployment;
  dds::Presence presence;
  dds::SignsOfLife signs;
  dds::Announcements announcements;
  dds::Dropped dropped{"dropped"};
  Reader reader;
  dds::Clock::time_point now{};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const Crossing crossing;
  static const std::array<dds::Deployment, 3> deployments{dds::deployment_of(crossing.setup(0, 10)),
                                                          dds::deployment_of(crossing.setup(1, 10)),
                                                          dds::deployment_of(crossing.setup(2, 10))};
  Station station(deployments.at(data[0] % 3));
  Bytes bytes(data + 1, size - 1);
  while (bytes.any()) {
    const auto kind = bytes.take<std::uint8_t>();
    station.now += std::chrono::milliseconds(kind);
    station.presence.look(station.now, station.reader);
    if (kind % 5 == 0) station.hear_data(bytes);
    if (kind % 5 == 1) station.hear_state(bytes);
    if (kind % 5 == 2) station.hear_alive(bytes, false);
    if (kind % 5 == 3) station.hear_alive(bytes, true);
    if (kind % 5 == 4) station.hear_announcement(bytes);
  }
  return 0;
}
