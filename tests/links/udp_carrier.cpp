// A carrier over datagrams on loopback, for tests: it loses one message in seven, and repeats one in eleven.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "network/carrier.hpp"

namespace {

using namespace tessera::network;

constexpr std::uint64_t lost = 7, repeated = 11;

struct Header {
  ChannelNumber channel;
  ProcessNumber from;
  bool is_state;
  Data data;
  State state;
  std::int64_t stamp_ns;
  bool valid;
};

class UdpCarrier final : public Carrier {
 public:
  explicit UdpCarrier(const CarrierSetup& setup)
      : setup_(setup),
        channels_(setup.channels.begin(), setup.channels.end()),
        port_(static_cast<std::uint16_t>(std::atoi(std::getenv("TEST_LINKS_PORT")))),
        socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)),
        woken_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    const sockaddr_in own = address(setup.process);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) std::abort();
  }
  ~UdpCarrier() override {
    close(socket_);
    close(woken_);
  }

  void send(ChannelNumber channel, const Data& data, const Value& value) override {
    send({channel, setup_.process, false, data, {}, value.stamp.count(), value.valid}, value.bytes);
  }
  void send(ChannelNumber channel, const State& state) override {
    send({channel, setup_.process, true, {}, state, 0, false}, {});
  }
  void receive(Listener& listener, std::chrono::nanoseconds longest) override {
    std::array<pollfd, 2> sources{pollfd{socket_, POLLIN, 0}, pollfd{woken_, POLLIN, 0}};
    const timespec limit{longest.count() / 1'000'000'000, longest.count() % 1'000'000'000};
    ppoll(sources.data(), sources.size(), &limit, nullptr);
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t taken = read(woken_, &count, sizeof count);
    std::array<std::byte, 2048> bytes;
    for (ssize_t got = 0; (got = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0;)
      hand_over(listener, std::span(bytes).first(static_cast<std::size_t>(got)));
  }
  void wake() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(woken_, &one, sizeof one);
  }

 private:
  [[nodiscard]] sockaddr_in address(ProcessNumber process) const {
    sockaddr_in made{};
    made.sin_family = AF_INET;
    made.sin_port = htons(static_cast<std::uint16_t>(port_ + process));
    made.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return made;
  }
  void send(const Header& header, std::span<const std::byte> value) {
    ++sent_;
    if (sent_ % lost == 0) return;
    for (const ChannelSetup& channel : channels_) {
      if (channel.number != header.channel) continue;
      std::vector<std::byte> bytes(sizeof header + value.size());
      std::memcpy(bytes.data(), &header, sizeof header);
      if (!value.empty())  // a state has none
        std::memcpy(bytes.data() + sizeof header, value.data(), value.size());
      const sockaddr_in to = address(header.is_state ? channel.sender : channel.receiver);
      for (int copies = sent_ % repeated == 0 ? 2 : 1; copies > 0; --copies)
        sendto(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to),
               sizeof to);
    }
  }
  static void hand_over(Listener& listener, std::span<const std::byte> bytes) {
    Header header;
    std::memcpy(&header, bytes.data(), sizeof header);
    listener.reachable(header.from, true);
    if (header.is_state)
      listener.heard(header.channel, header.state);
    else
      listener.heard(header.channel, header.data,
                     {std::chrono::nanoseconds(header.stamp_ns), header.valid, bytes.subspan(sizeof header)});
  }

  CarrierSetup setup_;
  std::vector<ChannelSetup> channels_;
  std::uint16_t port_;
  int socket_, woken_;
  std::uint64_t sent_ = 0;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) tessera::network::Carrier* tessera_open_carrier_4(
    const tessera::network::CarrierSetup& setup, char* error, std::size_t size) {
  if (std::getenv("TEST_LINKS_PORT") == nullptr) {
    std::snprintf(error, size, "the test has given no port");
    return nullptr;
  }
  return new UdpCarrier(setup);
}
