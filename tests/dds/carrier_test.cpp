#include "network/dds/carrier.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "network/dds/setup_error.hpp"
#include "tests/dds/crossing.hpp"
#include "tests/dds/heard.hpp"
#include "tests/dds/sides.hpp"

/// Carriers over real DDS on loopback. The two of a test are in one process, but tell each other all over UDP.
namespace tessera::test {
namespace {

using namespace std::chrono_literals;
using dds::DdsCarrier;
using network::Data;
using network::Incarnation;
using network::Number;
using network::State;

std::vector<std::byte> some_bytes(std::size_t count) {
  std::vector<std::byte> bytes(count);
  for (std::size_t at = 0; at < count; ++at) bytes[at] = static_cast<std::byte>(at * 7 + at / 251);
  return bytes;
}

struct Pair {
  explicit Pair(const Crossing& a = {}, const Crossing& b = {})
      : office_carrier(a.setup(Crossing::office, 10)), cart_carrier(b.setup(Crossing::cart, 20)) {}
  [[nodiscard]] bool meet() {
    return receive_until(
        [&] { return office.heard.sees(Crossing::cart) && cart.heard.sees(Crossing::office); }, office, cart);
  }
  DdsCarrier office_carrier, cart_carrier;
  Station office{office_carrier}, cart{cart_carrier};
};

TEST(Carrier, ValuesAndStatesArriveAsTheyWereSent) {
  Pair pair;
  ASSERT_TRUE(pair.meet());
  const std::vector<std::byte> value = some_bytes(64);
  const Data data{Incarnation{10}, Incarnation{20}, Number{5}, false};
  pair.office_carrier.send(Crossing::goal, data, {123456789ns, true, value});
  const State state{Incarnation{20}, Incarnation{10}, Number{5}};
  pair.cart_carrier.send(Crossing::goal, state);
  ASSERT_TRUE(
      receive_until([&] { return !pair.cart.heard.messages.empty() && !pair.office.heard.states.empty(); },
                    pair.office, pair.cart));
  const Heard::Message& message = pair.cart.heard.messages.front();
  EXPECT_EQ(message.channel, Crossing::goal);
  EXPECT_EQ(message.data, data);
  EXPECT_EQ(message.stamp, 123456789ns);
  EXPECT_TRUE(message.valid);
  EXPECT_EQ(message.bytes, value);
  EXPECT_EQ(pair.office.heard.states.front().channel, Crossing::goal);
  EXPECT_EQ(pair.office.heard.states.front().state, state);
  EXPECT_TRUE(pair.office.heard.complaints.empty());
  EXPECT_TRUE(pair.cart.heard.complaints.empty());
}

TEST(Carrier, ARecallHasNoValue) {
  Pair pair;
  ASSERT_TRUE(pair.meet());
  const Data recall{Incarnation{10}, Incarnation{20}, Number{5}, true};
  pair.office_carrier.send(Crossing::goal, recall, {1ns, true, some_bytes(8)});
  ASSERT_TRUE(receive_until([&] { return !pair.cart.heard.messages.empty(); }, pair.office, pair.cart));
  EXPECT_EQ(pair.cart.heard.messages.front().data, recall);
  EXPECT_TRUE(pair.cart.heard.messages.front().bytes.empty());
}

TEST(Carrier, AValueOfAMegabyteArrivesWhole) {
  Pair pair;
  ASSERT_TRUE(pair.meet());
  const std::vector<std::byte> value = some_bytes(Crossing::large);
  pair.office_carrier.send(Crossing::picture, {Incarnation{10}, {}, Number{1}, false}, {0ns, true, value});
  ASSERT_TRUE(receive_until([&] { return !pair.cart.heard.messages.empty(); }, pair.office, pair.cart));
  EXPECT_EQ(pair.cart.heard.messages.front().bytes, value);
}

TEST(Carrier, AValueLongerThanItsChannelIsNotSentAndToldOf) {
  Pair pair;
  ASSERT_TRUE(pair.meet());
  const std::vector<std::byte> value = some_bytes(Crossing::small + 1);
  pair.office_carrier.send(Crossing::goal, {Incarnation{10}, {}, Number{1}, false}, {0ns, true, value});
  EXPECT_TRUE(receive_until([&] { return pair.office.heard.has_complaint("longer than the channel"); },
                            pair.office, pair.cart));
  EXPECT_TRUE(pair.cart.heard.messages.empty());
}

TEST(Carrier, ASenderThatStartsLateLearnsTheStateAtOnceButNoOldValue) {
  const Crossing crossing;
  DdsCarrier cart_carrier(crossing.setup(Crossing::cart, 20));
  Station cart(cart_carrier);
  const State last{Incarnation{20}, Incarnation{9}, Number{7}};
  cart_carrier.send(Crossing::goal, {Incarnation{20}, Incarnation{9}, Number{6}});
  cart_carrier.send(Crossing::goal, last);
  cart_carrier.send(Crossing::position, {Incarnation{20}, {}, Number{1}, false}, {0ns, true, some_bytes(8)});
  DdsCarrier office_carrier(crossing.setup(Crossing::office, 10));
  Station office(office_carrier);
  ASSERT_TRUE(receive_until([&] { return !office.heard.states.empty() && office.heard.sees(Crossing::cart); },
                            office, cart));
  ASSERT_EQ(office.heard.states.size(), 1U);
  EXPECT_EQ(office.heard.states.front().state, last);
  EXPECT_TRUE(office.heard.messages.empty());
}

/// Both are in one process, so the offset of its clock is zero.
TEST(Carrier, SignsOfLifeTellTheClockOfTheOtherAndHowMuchOfItIsCertain) {
  Pair pair;
  const auto known = [](const Station& station, network::ProcessNumber peer) {
    const auto found = station.heard.signs.find(peer);
    return found != station.heard.signs.end() && found->second.clock && found->second.expected >= 3;
  };
  ASSERT_TRUE(
      receive_until([&] { return known(pair.office, Crossing::cart) && known(pair.cart, Crossing::office); },
                    pair.office, pair.cart));
  for (const network::SignsOfLife& signs :
       {pair.office.heard.signs.at(Crossing::cart), pair.cart.heard.signs.at(Crossing::office)}) {
    EXPECT_LE(signs.lost, signs.expected);
    EXPECT_GE(signs.clock->uncertainty, 0ns);
    EXPECT_LE(std::chrono::abs(signs.clock->ahead), signs.clock->uncertainty);
  }
}

/// A busy machine makes a silence longer than it has to be, so that only one of many has to be short.
TEST(Carrier, ASilentProcessIsGoneAfterTheLivelinessOfTheDeployment) {
  using Clock = std::chrono::steady_clock;
  Crossing crossing;
  crossing.liveliness = 200ms;
  Pair pair(crossing, crossing);
  Clock::duration shortest = Clock::duration::max();
  for (int round = 0; round < 20 && shortest >= 600ms; ++round) {
    ASSERT_TRUE(pair.meet());
    const Clock::time_point begin = Clock::now();
    ASSERT_TRUE(receive_until([&] { return !pair.office.heard.sees(Crossing::cart); }, pair.office));
    shortest = std::min(shortest, Clock::now() - begin);
  }
  EXPECT_LT(shortest, 600ms);
}

TEST(Carrier, OneOfAnotherLivelinessIsRefusedAndToldOf) {
  Crossing other;
  other.liveliness = 300ms;
  Pair pair({}, other);
  const auto told = [](const Station& station) { return station.heard.has_complaint("its liveliness"); };
  EXPECT_TRUE(receive_until([&] { return told(pair.office) && told(pair.cart); }, pair.office, pair.cart));
  EXPECT_FALSE(pair.office.heard.sees(Crossing::cart));
}

TEST(Carrier, WakeEndsTheWaitOrTheNextOne) {
  const Crossing crossing;
  DdsCarrier carrier(crossing.setup(Crossing::office, 10));
  Heard heard;
  carrier.wake();
  carrier.receive(heard, std::chrono::nanoseconds::max());  // would not return
  std::thread other([&] {
    std::this_thread::sleep_for(50ms);
    carrier.wake();
  });
  carrier.receive(heard, std::chrono::nanoseconds::max());
  other.join();
  EXPECT_TRUE(heard.changes.empty());
}

TEST(Carrier, AProcessThatEndsInOrderIsNotReachableAndItsNextIncarnationIsHeard) {
  const Crossing crossing;
  DdsCarrier office_carrier(crossing.setup(Crossing::office, 10));
  Station office(office_carrier);
  for (const std::uint64_t incarnation : {20U, 21U}) {
    office.heard.messages.clear();
    DdsCarrier cart_carrier(crossing.setup(Crossing::cart, incarnation));
    Station cart(cart_carrier);
    ASSERT_TRUE(
        receive_until([&] { return office.heard.sees(Crossing::cart) && cart.heard.sees(Crossing::office); },
                      office, cart));
    cart_carrier.send(Crossing::position, {Incarnation{incarnation}, {}, Number{1}, false},
                      {1ns, true, some_bytes(8)});
    ASSERT_TRUE(receive_until([&] { return !office.heard.messages.empty(); }, office, cart));
    EXPECT_EQ(office.heard.messages.front().bytes, some_bytes(8));
  }
  ASSERT_TRUE(receive_until([&] { return !office.heard.sees(Crossing::cart); }, office));
  EXPECT_EQ(
      office.heard.changes,
      (std::vector<Heard::Change>{
          {Crossing::cart, true}, {Crossing::cart, false}, {Crossing::cart, true}, {Crossing::cart, false}}));
  EXPECT_TRUE(office.heard.complaints.empty());
}

TEST(Carrier, ProcessesOfAnotherNetAreToldOfAndNotHeard) {
  Crossing other;
  other.net_hash = "0badcafe";
  Pair pair({}, other);
  ASSERT_TRUE(receive_until(
      [&] {
        pair.office_carrier.send(Crossing::goal, {Incarnation{10}, {}, Number{1}, false},
                                 {0ns, true, some_bytes(8)});
        return !pair.office.heard.complaints.empty() && !pair.cart.heard.complaints.empty();
      },
      pair.office, pair.cart));
  EXPECT_TRUE(pair.office.heard.has_complaint("cart[0]"));
  EXPECT_TRUE(pair.office.heard.has_complaint("0badcafe"));
  EXPECT_TRUE(pair.cart.heard.has_complaint("office"));
  EXPECT_EQ(pair.office.heard.complaints.size(), 1U);
  EXPECT_TRUE(pair.cart.heard.messages.empty());
  EXPECT_TRUE(pair.cart.heard.changes.empty());
}

TEST(Carrier, AProcessThatRunsTwiceIsToldOf) {
  const Crossing crossing;
  DdsCarrier one(crossing.setup(Crossing::cart, 20)), two(crossing.setup(Crossing::cart, 21));
  DdsCarrier office_carrier(crossing.setup(Crossing::office, 10));
  Station first(one), second(two), office(office_carrier);
  EXPECT_TRUE(receive_until(
      [&] {
        return first.heard.has_complaint("process cart[0] was started a second time, on ") &&
               second.heard.has_complaint("process cart[0] runs already on ") &&
               office.heard.has_complaint("It was started a second time, or its clock was set back");
      },
      first, second, office));
}

TEST(Carrier, APeerThatHasNoAddressKeepsNobodyFromStarting) {
  Crossing crossing;
  crossing.peers = {"no such host"};
  Pair pair(crossing, crossing);
  EXPECT_TRUE(pair.meet());
  EXPECT_TRUE(pair.office.heard.has_complaint("peer no such host has no IPv4 address"));
}

TEST(Carrier, SetupsThatMakeNoSenseAreRefused) {
  const auto refusal = [](const Crossing& crossing, network::ProcessNumber process = 0) -> std::string {
    try {
      const DdsCarrier carrier(crossing.setup(process, 1));
    } catch (const dds::SetupError& error) {
      return error.what();
    }
    return "";
  };
  Crossing crossing;
  crossing.interface = "nosuch0";
  EXPECT_THAT(refusal(crossing), testing::HasSubstr("there is no interface nosuch0"));
  EXPECT_THAT(refusal(crossing), testing::HasSubstr("lo (127.0.0.1)"));
  crossing.interface = "lo";
  crossing.peers = {"192.0.2.1"};
  EXPECT_THAT(refusal(crossing), testing::HasSubstr("is on another host"));
  crossing.peers = {"localhost"};
  crossing.domain = 231;
  EXPECT_THAT(refusal(crossing), testing::HasSubstr("there is no domain 231"));
  crossing.domain = 1;
  EXPECT_THAT(refusal(crossing, 9), testing::HasSubstr("not one of the deployment"));
  crossing.channels.push_back(crossing.channels.front());
  EXPECT_THAT(refusal(crossing), testing::HasSubstr("two channels have the number"));
}

TEST(Carrier, TenThousandBlockingTransfersAreReadOnceAndInOrder) {
  const Crossing crossing;
  DdsCarrier office(crossing.setup(Crossing::office, 10)), cart(crossing.setup(Crossing::cart, 20));
  SendingSide sender(office, Crossing::goal, Incarnation{10});
  ReceivingSide receiver(cart, Crossing::goal, Incarnation{20});
  for (std::uint64_t count = 1; count <= 10'000; ++count) {
    sender.write(count);
    std::optional<std::uint64_t> read;
    ASSERT_TRUE(eventually([&] {
      receiver.step();
      read = receiver.read();
      if (!read) sender.step();
      return read.has_value();
    }));
    ASSERT_EQ(*read, count);
    ASSERT_TRUE(eventually([&] {
      sender.step();
      if (sender.waiting()) receiver.step();
      EXPECT_EQ(receiver.read(), std::nullopt);
      return !sender.waiting();
    }));
  }
  EXPECT_EQ(sender.strange + receiver.strange, 0);
}

}  // namespace
}  // namespace tessera::test
