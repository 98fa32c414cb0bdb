#include "watch/status_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace tessera::testing {
namespace {

using nlohmann::json;

[[nodiscard]] Snapshot process_of(std::size_t subsystems) {
  Snapshot snapshot;
  snapshot.system = "depot";
  snapshot.process = "cart[0]";
  snapshot.host = "cart.local";
  snapshot.incarnation = "7";
  snapshot.recording = "/somewhere/private.tsr";
  snapshot.deployment = Snapshot::Deployment{};
  for (std::size_t count = 0; count < subsystems; ++count) {
    Snapshot::Subsystem& one = snapshot.subsystems.emplace_back();
    one.path = "cart.part" + std::to_string(count);
    one.memory.push_back({"secret", "1"});
  }
  snapshot.channels.emplace_back().name = "a->b";
  snapshot.waits.emplace_back().channel = "a->b";
  snapshot.links.emplace_back().process = "office";
  snapshot.chains.emplace_back().name = "joints to motors";
  snapshot.emergency = "smoke";
  return snapshot;
}

TEST(StatusText, TellsWhatEverybodyMaySee) {
  const StatusTexts texts = status_texts(process_of(2), 32768);
  const json whole = json::parse(texts.whole), brief = json::parse(texts.brief);
  EXPECT_EQ(whole.at("subsystems").size(), 2U);
  EXPECT_EQ(whole.at("waits").size(), 1U);
  EXPECT_EQ(whole.at("links").size(), 1U);
  EXPECT_EQ(whole.at("chains").size(), 1U);
  for (const json* one : {&whole, &brief}) {
    EXPECT_EQ(one->at("incarnation"), "7");
    EXPECT_EQ(one->at("emergency"), "smoke");
    EXPECT_TRUE(one->at("channels").empty());
    EXPECT_FALSE(one->contains("recording") || one->contains("deployment") || one->contains("left_out"));
  }
  EXPECT_FALSE(whole.at("subsystems").at(0).contains("memory"));
  EXPECT_FALSE(whole.contains("brief"));
  EXPECT_EQ(brief.at("brief"), true);
  EXPECT_TRUE(brief.at("subsystems").empty() && brief.at("waits").empty() && !brief.contains("links"));
  EXPECT_FALSE(brief.contains("chains"));
  EXPECT_LT(texts.brief.size(), 1000U) << "it fits into one packet";
}

TEST(StatusText, LeavesOutWhatHasNoRoomAndSaysHowMuch) {
  const StatusTexts texts = status_texts(process_of(1000), 32768);
  EXPECT_LE(texts.whole.size(), 32768U);
  const json whole = json::parse(texts.whole);
  EXPECT_GT(whole.at("subsystems").size(), 50U);
  EXPECT_EQ(whole.at("subsystems").size() + whole.at("left_out").get<std::size_t>(), 1000U);
  EXPECT_EQ(whole.at("waits").size(), 1U) << "the shorter lists stay";
  EXPECT_EQ(whole.at("links").size(), 1U);
}

TEST(StatusText, ALongReasonOfAnEmergencyStopIsCut) {
  Snapshot snapshot = process_of(1);
  snapshot.emergency = std::string(100'000, 'x');
  const StatusTexts texts = status_texts(std::move(snapshot), 32768);
  EXPECT_LT(texts.brief.size(), 1000U);
  EXPECT_EQ(json::parse(texts.whole).at("subsystems").size(), 1U);
}

}  // namespace
}  // namespace tessera::testing
