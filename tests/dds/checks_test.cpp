#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "network/dds/announcements.hpp"
#include "network/dds/dropped.hpp"
#include "network/dds/presence.hpp"
#include "network/dds/received.hpp"
#include "network/dds/setup_error.hpp"
#include "tests/dds/crossing.hpp"
#include "tests/dds/heard.hpp"

/// The reactions of a carrier to messages, without a network.
namespace tessera::test {
namespace {

using namespace std::chrono_literals;
using dds::Clock;
using dds::Refusal;

dds::Deployment deployment(network::ProcessNumber process = Crossing::office,
                           std::uint64_t incarnation = 10) {
  const Crossing crossing;
  return dds::deployment_of(crossing.setup(process, incarnation));
}

TEST(Received, DataIsCheckedInEveryField) {
  const dds::Deployment cart = deployment(Crossing::cart);
  tessera_wire_Data good{};
  good.channel = Crossing::goal;
  good.process = Crossing::office;
  good.from_incarnation = 10;
  good.number = 1;
  good.stamp_ns = 5;
  good.valid = true;
  good.bytes._length = Crossing::small;
  EXPECT_EQ(dds::check(good, cart), Refusal::none);
  const auto with = [&](auto change) {
    tessera_wire_Data data = good;
    change(data);
    return dds::check(data, cart);
  };
  EXPECT_EQ(with([](auto& data) { data.channel = 99; }), Refusal::unknown_channel);
  EXPECT_EQ(with([](auto& data) { data.channel = Crossing::other_goal; }), Refusal::unknown_channel);
  EXPECT_EQ(with([](auto& data) { data.channel = Crossing::position; }), Refusal::wrong_direction);
  EXPECT_EQ(with([](auto& data) { data.process = Crossing::other_cart; }), Refusal::wrong_process);
  EXPECT_EQ(with([](auto& data) { data.process = 4'000'000'000U; }), Refusal::wrong_process);
  EXPECT_EQ(with([](auto& data) { data.from_incarnation = 0; }), Refusal::no_incarnation);
  EXPECT_EQ(with([](auto& data) { data.number = 0; }), Refusal::no_number);
  EXPECT_EQ(with([](auto& data) { data.bytes._length = Crossing::small + 1; }), Refusal::too_large);
  EXPECT_EQ(with([](auto& data) { data.stamp_ns = -1; }), Refusal::time_before_zero);
  EXPECT_EQ(with([](auto& data) { data.recall = true; }), Refusal::recall_with_value);
  EXPECT_EQ(
      dds::description(Refusal::wrong_process, good, cart),
      "data of channel office.goal->cart[0].goal from process 0: the channel does not begin or end there");
}

TEST(Received, StatesAndSignsOfLifeAreChecked) {
  const dds::Deployment office = deployment();
  const tessera_wire_State good{.channel = Crossing::goal,
                                .process = Crossing::cart,
                                .from_incarnation = 20,
                                .peer_incarnation = 10,
                                .taken = 3};
  EXPECT_EQ(dds::check(good, office), Refusal::none);
  const auto with = [&](auto change) {
    tessera_wire_State state = good;
    change(state);
    return dds::check(state, office);
  };
  EXPECT_EQ(with([](auto& state) { state.channel = 99; }), Refusal::unknown_channel);
  EXPECT_EQ(with([](auto& state) { state.channel = Crossing::position; }), Refusal::wrong_direction);
  EXPECT_EQ(with([](auto& state) { state.process = Crossing::other_cart; }), Refusal::wrong_process);
  EXPECT_EQ(with([](auto& state) { state.from_incarnation = 0; }), Refusal::no_incarnation);
  EXPECT_EQ(with([](auto& state) { state.peer_incarnation = 0; }), Refusal::state_of_nothing);
  const auto alive = [&](std::uint32_t process, std::uint64_t incarnation) {
    tessera_wire_Alive sign{};
    sign.process = process;
    sign.incarnation = incarnation;
    return dds::check(sign, office);
  };
  EXPECT_EQ(alive(Crossing::cart, 1), Refusal::none);
  EXPECT_EQ(alive(Crossing::cart, 0), Refusal::no_incarnation);
  EXPECT_EQ(alive(Crossing::office, 1), Refusal::no_peer);
  EXPECT_EQ(alive(99, 1), Refusal::no_peer);
}

TEST(Presence, SilenceARestartAndAFarewellAreToldOf) {
  dds::Presence presence(deployment());
  Heard heard;
  const Clock::time_point start = Clock::now();
  EXPECT_EQ(presence.next_look(), std::nullopt);
  presence.heard(Crossing::cart, 20, start, heard);
  presence.heard(Crossing::cart, 20, start + 800ms, heard);
  presence.look(start + 1600ms, heard);
  EXPECT_EQ(presence.next_look(), start + 800ms + 900ms);
  presence.look(start + 1700ms, heard);
  presence.look(start + 1800ms, heard);
  EXPECT_EQ(heard.changes, (std::vector<Heard::Change>{{Crossing::cart, true}, {Crossing::cart, false}}));
  heard.changes.clear();
  presence.heard(Crossing::cart, 20, start + 2s, heard);  // the network was cut
  presence.heard(Crossing::cart, 21, start + 2s, heard);  // restarted
  presence.left(Crossing::cart, 20, heard);               // late
  presence.left(Crossing::cart, 21, heard);
  presence.heard(77, 1, start + 2s, heard);
  EXPECT_EQ(
      heard.changes,
      (std::vector<Heard::Change>{
          {Crossing::cart, true}, {Crossing::cart, false}, {Crossing::cart, true}, {Crossing::cart, false}}));
  EXPECT_TRUE(heard.complaints.empty());
}

TEST(Presence, TheDeploymentSaysWhichSilenceIsTooLong) {
  Crossing crossing;
  crossing.liveliness = 300ms;
  dds::Presence presence(dds::deployment_of(crossing.setup(Crossing::office, 10)));
  Heard heard;
  const Clock::time_point start = Clock::now();
  presence.heard(Crossing::cart, 20, start, heard);
  EXPECT_EQ(presence.next_look(), start + 300ms);
  presence.look(start + 299ms, heard);
  EXPECT_TRUE(heard.sees(Crossing::cart));
  presence.look(start + 300ms, heard);
  EXPECT_FALSE(heard.sees(Crossing::cart));
}

TEST(Presence, AnOlderIncarnationThatGoesOnSpeakingIsToldOfOnce) {
  dds::Presence presence(deployment());
  Heard heard;
  const Clock::time_point now = Clock::now();
  presence.heard(Crossing::cart, 20, now, heard);
  presence.heard(Crossing::cart, 19, now, heard);  // late
  EXPECT_TRUE(heard.complaints.empty());
  for (int count = 0; count < 100; ++count) presence.heard(Crossing::cart, 19, now, heard);
  ASSERT_EQ(heard.complaints.size(), 1U);
  EXPECT_THAT(heard.complaints.front(),
              testing::HasSubstr("process cart[0] speaks with an incarnation older"));
  EXPECT_EQ(heard.changes.size(), 1U);
}

TEST(Announcements, OnlyProcessesOfTheSameSystemThatDoNotFitAreToldOfAndOnce) {
  const dds::Deployment own = deployment();
  const dds::Announcement good = dds::announcement_of(deployment(Crossing::cart, 20));
  dds::Announcements announcements(own);
  EXPECT_EQ(announcements.hear(good), std::nullopt);
  EXPECT_EQ(announcements.hear(dds::announcement_of(own)), std::nullopt);
  const auto complaint = [&](auto change) {
    dds::Announcement other = good;
    change(other);
    const std::string first = announcements.hear(other).value_or("");
    EXPECT_EQ(announcements.hear(other), std::nullopt);
    return first;
  };
  EXPECT_EQ(complaint([](auto& other) {
              other.system = "another";
              other.wire_version = 9;
            }),
            "");
  EXPECT_THAT(complaint([](auto& other) { other.wire_version = 9; }),
              testing::HasSubstr("speaks version 9 of the messages, this process 2"));
  EXPECT_THAT(complaint([](auto& other) { other.net_hash = "\x1b[2Jx"; }),
              testing::HasSubstr("executes another net of system crossing (?[2Jx, this process 00c0ffee)"));
  EXPECT_THAT(complaint([](auto& other) { other.process_name = "tram"; }),
              testing::HasSubstr("process tram on " + good.host));
  EXPECT_THAT(complaint([](auto& other) { other.processes_hash = "1"; }),
              testing::HasSubstr("another `deploy` than this one"));
  EXPECT_THAT(complaint([](auto& other) { other.process_name = "office"; }),
              testing::HasSubstr("process office was started a second time, on " + good.host));
}

TEST(Announcements, StrangersCannotFillTheMemory) {
  dds::Announcements announcements(deployment());
  dds::Announcement other = dds::announcement_of(deployment(Crossing::cart, 20));
  ++other.wire_version;
  int told = 0;
  for (std::uint64_t start = 1; start < 5000; ++start) {
    other.incarnation = start;
    if (announcements.hear(other)) ++told;
  }
  EXPECT_EQ(told, 1000);
}

TEST(Dropped, OneComplaintASecondSaysHowMany) {
  dds::Dropped dropped("dropped");
  Heard heard;
  const Clock::time_point now = Clock::now();
  dropped.tell(now, heard);
  dropped.add([] { return std::string("a"); });
  dropped.tell(now, heard);
  for (const char* text : {"b", "c", "d"}) dropped.add([&] { return std::string(text); });
  dropped.tell(now + 999ms, heard);
  dropped.tell(now + 1s, heard);
  EXPECT_THAT(heard.complaints, testing::ElementsAre("dropped a", "dropped 3 messages; the first: b"));
}

TEST(Deployment, PeersAreThoseWithWhomAChannelIsShared) {
  EXPECT_THAT(deployment(Crossing::office).peers, testing::ElementsAre(Crossing::cart, Crossing::other_cart));
  EXPECT_THAT(deployment(Crossing::cart).peers, testing::ElementsAre(Crossing::office));
  EXPECT_FALSE(deployment(Crossing::other_cart).channel(Crossing::goal));
  Crossing other;
  other.processes = {"office", "cart[1]", "cart[0]"};
  EXPECT_NE(dds::deployment_of(other.setup(0, 1)).processes_hash, deployment().processes_hash);
}

TEST(Deployment, OneOfAnotherLivelinessIsAnotherDeployment) {
  Crossing other;
  other.liveliness = 901ms;
  EXPECT_NE(dds::deployment_of(other.setup(0, 1)).processes_hash, deployment().processes_hash);
  other.liveliness = 0ms;
  EXPECT_THROW(static_cast<void>(dds::deployment_of(other.setup(0, 1))), dds::SetupError);
}

}  // namespace
}  // namespace tessera::test
