#include "project/process/network_processes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "project/process/deployment_watch.hpp"

namespace tessera::project {
namespace {

using State = WatchedProcess::State;
using What = HeardStatus::What;
using testing::ElementsAre;

HeardStatus told(const std::string& process, std::uint64_t incarnation, bool brief = false) {
  HeardStatus heard{What::told, process, std::to_string(incarnation), {}, brief ? "" : "{}"};
  heard.snapshot.system = "depot";
  heard.snapshot.process = process;
  heard.snapshot.incarnation = heard.incarnation;
  heard.snapshot.net_hash = "ab";
  heard.snapshot.brief = brief;
  if (!brief) heard.snapshot.subsystems.resize(2);
  return heard;
}

/// Gives what the test says has come.
struct Script final : StatusFeed {
  std::vector<HeardStatus> next;
  std::vector<HeardStatus> take() override { return std::exchange(next, {}); }
  [[nodiscard]] std::string remark() const override { return {}; }
};

class Heard : public testing::Test {
 protected:
  State after(HeardStatus heard) {
    const std::string name = heard.process;
    script_.next.push_back(std::move(heard));
    processes_.take(script_, {});
    return processes_.find(name)->state;
  }
  Script script_;
  NetworkProcesses processes_{""};
};

TEST_F(Heard, ABriefTextKeepsTheLists) {
  after(told("cart", 7));
  HeardStatus brief = told("cart", 7, true);
  brief.snapshot.time_s = 9;
  EXPECT_EQ(after(std::move(brief)), State::running);
  EXPECT_EQ(processes_.find("cart")->snapshot.subsystems.size(), 2U);
  EXPECT_EQ(processes_.find("cart")->snapshot.time_s, 9);
}

TEST_F(Heard, ALaterStartTakesThePlaceAndAnEarlierOneIsIgnored) {
  after(told("cart", 7));
  after(told("cart", 9));
  EXPECT_EQ(processes_.find("cart")->snapshot.incarnation, "9");
  after(told("cart", 8));
  EXPECT_EQ(after({What::ended, "cart", "7", {}, {}}), State::running);
  EXPECT_EQ(processes_.find("cart")->snapshot.incarnation, "9");
}

TEST_F(Heard, TheLastTextsOfOneThatHasEndedDoNotRaiseIt) {
  after(told("cart", 7));
  EXPECT_EQ(after({What::ended, "cart", "7", {}, {}}), State::ended);
  EXPECT_EQ(after(told("cart", 7)), State::ended);
  EXPECT_EQ(after({What::vanished, "cart", "7", {}, {}}), State::ended);
}

TEST_F(Heard, OneThatTakesItsLeaveHasEndedAndOneThatIsNotHeardIsSilent) {
  after(told("cart", 7));
  after(told("office", 7));
  EXPECT_EQ(after({What::vanished, "office", "7", {}, {}}), State::ended);
  std::this_thread::sleep_for(longest_silence + std::chrono::milliseconds(50));
  EXPECT_TRUE(processes_.notice_silence());
  EXPECT_EQ(processes_.find("cart")->state, State::silent);
  EXPECT_EQ(after(told("cart", 7, true)), State::running);
}

TEST_F(Heard, ProcessesOfAnotherNetArePassedOver) {
  NetworkProcesses of_net("cd");
  script_.next.push_back(told("cart", 7));
  of_net.take(script_, {});
  EXPECT_TRUE(of_net.all().empty());
  EXPECT_EQ(of_net.of_another_net(), 1U);
}

TEST(Shown, WhatASocketSaysGoesFirstUnlessItIsOverAndEarlier) {
  const auto seen = [](State state, const char* incarnation) {
    WatchedProcess one{.state = state, .since = {}, .heard = {}, .socket = {}, .snapshot = {}};
    one.snapshot.incarnation = incarnation;
    return one;
  };
  const WatchedProcess here = seen(State::running, "5"), gone = seen(State::gone, "5"),
                       left_behind = seen(State::gone, ""), same = seen(State::running, "5"),
                       later = seen(State::running, "9"), later_gone = seen(State::gone, "9");
  EXPECT_EQ(shown_of(&here, &later), &here) << "no program on the network can replace it";
  EXPECT_EQ(shown_of(&gone, &same), &gone);
  EXPECT_EQ(shown_of(&gone, &later), &later);
  EXPECT_EQ(shown_of(&gone, &later_gone), &gone);
  EXPECT_EQ(shown_of(&left_behind, &same), &same);
  EXPECT_EQ(shown_of(nullptr, &later), &later);
  EXPECT_EQ(shown_of(&gone, nullptr), &gone);
}

TEST(WatchedNetwork, IsEnteredWhereTheSpecificationSaysWithoutALocalProcess) {
  const auto folder = std::filesystem::temp_directory_path() / ("tessera.none." + std::to_string(getpid()));
  DeploymentWatch watch(folder, "depot");
  Snapshot::Deployment given{.domain = 3, .interface = "cable", .peers = {"a"}, .processes = {{"cart", "a"}}};
  Script* script = nullptr;
  int domain = -1;
  watch.watch_network(
      [&](const std::string& system, const Snapshot::Deployment& where) {
        EXPECT_EQ(system, "depot");
        domain = where.domain;
        auto made = std::make_unique<Script>();
        script = made.get();
        return made;
      },
      given);
  EXPECT_FALSE(watch.watches_network());
  watch.poll(std::chrono::milliseconds(1));
  ASSERT_NE(script, nullptr);
  EXPECT_EQ(domain, 3);
  script->next.push_back(told("cart", 7));
  std::vector<std::string> lines;
  watch.poll(std::chrono::milliseconds(1), [&](std::string_view line) { lines.emplace_back(line); });
  EXPECT_THAT(lines, ElementsAre("{}"));
  ASSERT_EQ(watch.processes().size(), 1U);
  EXPECT_TRUE(watch.processes()[0]->by_network);
  EXPECT_EQ(watch.declared().size(), 1U);
}

}  // namespace
}  // namespace tessera::project
