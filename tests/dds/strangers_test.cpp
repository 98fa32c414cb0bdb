#include <dds/dds.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "network/dds/carrier.hpp"
#include "network/dds/closed_sockets.hpp"
#include "network/dds/settings.hpp"
#include "tests/dds/crossing.hpp"
#include "tests/dds/heard.hpp"

/// Messages that no carrier sends, and networks that a carrier keeps away from.
namespace tessera::test {
namespace {

using dds::DdsCarrier;

/// The messages that a hostile program in the same domain can write.
struct Stranger {
  explicit Stranger(const Crossing& crossing)
      : deployment(dds::deployment_of(crossing.setup(Crossing::office, 10))),
        endpoints(deployment, crossing.domain, dds::locate("lo", {})) {}
  void write(const tessera_wire_Data& sample) const { dds_write(endpoints.to(Crossing::cart).data, &sample); }
  void write(const tessera_wire_State& sample) const {
    dds_write(endpoints.to(Crossing::cart).state, &sample);
  }
  void write(const tessera_wire_Alive& sample) const { dds_write(endpoints.alive_writer(), &sample); }
  dds::Deployment deployment;
  dds::Endpoints endpoints;
};

TEST(Strangers, MalformedMessagesAreDroppedAndCounted) {
  const Crossing crossing;
  DdsCarrier carrier(crossing.setup(Crossing::cart, 20));
  Station cart(carrier);
  const Stranger stranger(crossing);
  tessera_wire_Data data{};
  data.channel = Crossing::goal;
  data.process = Crossing::office;
  data.from_incarnation = 10;
  std::vector<std::uint8_t> bytes(4 * Crossing::large);
  data.bytes._buffer = bytes.data();
  const auto write_with = [&](std::uint64_t number, std::uint32_t size) {
    data.number = number;
    data.bytes._length = data.bytes._maximum = size;
    stranger.write(data);
  };
  ASSERT_TRUE(receive_until(
      [&] {
        write_with(0, 8);
        return cart.heard.has_complaint("the value has the number 0");
      },
      cart));
  ASSERT_TRUE(receive_until(
      [&] {
        write_with(1, Crossing::small + 1);
        return cart.heard.has_complaint("the value is longer");
      },
      cart));
  cart.heard.complaints.clear();
  ASSERT_TRUE(receive_until(  // longer than the reader's buffer
      [&] {
        write_with(1, static_cast<std::uint32_t>(bytes.size()));
        return cart.heard.has_complaint("the value is longer");
      },
      cart));
  ASSERT_TRUE(receive_until(
      [&] {
        stranger.write(tessera_wire_State{.channel = Crossing::position,
                                          .process = Crossing::other_cart,
                                          .from_incarnation = 1,
                                          .peer_incarnation = 0,
                                          .taken = 0});
        return cart.heard.has_complaint("the channel does not begin or end there");
      },
      cart));
  ASSERT_TRUE(receive_until(
      [&] {
        stranger.write(tessera_wire_Alive{.process = 4'000'000'000U, .incarnation = 7});
        return cart.heard.has_complaint("a sign of life of process 4000000000");
      },
      cart));
  EXPECT_TRUE(cart.heard.messages.empty());
  EXPECT_TRUE(cart.heard.states.empty());
  EXPECT_TRUE(cart.heard.changes.empty());
  // The carrier goes on.
  ASSERT_TRUE(receive_until(
      [&] {
        write_with(1, Crossing::small);
        return !cart.heard.messages.empty();
      },
      cart));
}

TEST(Strangers, PacketsThatMakeNoSenseAreCountedAndDoNotFillTheOutput) {
  const Crossing crossing;
  DdsCarrier carrier(crossing.setup(Crossing::cart, 20));
  Station cart(carrier);
  // A message of RTPS with a DATA that is too short.
  std::string packet("RTPS\2\1\1\x10", 8);
  packet += std::string(12, 'x') + std::string("\x15\5\4\0abcd", 8);
  const int client = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  testing::internal::CaptureStderr();
  EXPECT_TRUE(receive_until(
      [&] {
        for (int port = 0; port < 2 * 10; ++port) {
          address.sin_port = htons(static_cast<std::uint16_t>(dds::first_port(crossing.domain) + port));
          sendto(client, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                 sizeof address);
        }
        return cart.heard.has_complaint(" times), the last time: malformed packet received");
      },
      cart));
  close(client);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// Bound to loopback, or closed by a filter to all that does not come from there.
bool is_closed(int file, const sockaddr_in& address) {
  if (ntohl(address.sin_addr.s_addr) == INADDR_LOOPBACK) return true;
  socklen_t instructions = 0;
  return getsockopt(file, SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions) == 0 && instructions > 0;
}

TEST(Strangers, ASocketWithTheDescriptorOfAFileThatWasOpenBeforeHearsLoopbackOnlyToo) {
  const Crossing crossing;
  for (const bool file_is_socket : {true, false}) {
    const int file = file_is_socket ? socket(AF_INET, SOCK_STREAM, 0) : open("/dev/null", O_RDONLY);
    const dds::OpenSockets before = dds::open_sockets();
    close(file);
    const int receiver = socket(AF_INET, SOCK_DGRAM, 0);
    ASSERT_EQ(receiver, file);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    address.sin_port = htons(static_cast<std::uint16_t>(dds::first_port(crossing.domain)));
    ASSERT_EQ(bind(receiver, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    dds::close_sockets_to_other_interfaces(before, crossing.domain, dds::locate("lo", {}));
    EXPECT_TRUE(is_closed(receiver, address));
    close(receiver);
  }
}

TEST(Strangers, SocketsHearLoopbackOnlyWhateverTheEnvironmentSays) {
  setenv("CYCLONEDDS_URI",
         "<CycloneDDS><Domain Id='any'><General><AllowMulticast>true</AllowMulticast></General><Tracing>"
         "<Verbosity>finest</Verbosity><OutputFile>/tmp/tessera_dds_test_trace</OutputFile></Tracing>"
         "</Domain></CycloneDDS>",
         1);
  const auto memberships = [] {
    std::ifstream file("/proc/self/net/igmp");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string before = memberships();
  const dds::OpenSockets sockets_before = dds::open_sockets();
  const Crossing crossing;
  const DdsCarrier carrier(crossing.setup(Crossing::cart, 20));
  int sockets = 0;
  for (const auto& [inode, file] : dds::open_sockets()) {
    if (sockets_before.contains(inode)) continue;
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) != 0) continue;
    if (address.sin_family != AF_INET) continue;
    ++sockets;
    EXPECT_TRUE(is_closed(file, address)) << "port " << ntohs(address.sin_port);
  }
  EXPECT_GE(sockets, 2);
  EXPECT_EQ(memberships(), before);
  EXPECT_FALSE(std::ifstream("/tmp/tessera_dds_test_trace"));
  unsetenv("CYCLONEDDS_URI");
}

}  // namespace
}  // namespace tessera::test
