#include "project/process/status_inbox.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "../environment.hpp"

namespace tessera::project {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using What = HeardStatus::What;
constexpr auto whole = network::StatusPart::whole, brief = network::StatusPart::brief;

json told_by(const std::string& process, std::uint64_t incarnation) {
  return {{"system", "depot"},
          {"pid", 5},
          {"net_hash", "ab"},
          {"time_s", 3.5},
          {"process", process},
          {"incarnation", std::to_string(incarnation)},
          {"host", "h"},
          {"subsystems", json::array()},
          {"channels", json::array()},
          {"waits", json::array()},
          {"links", json::array()}};
}

class Inbox : public testing::Test {
 protected:
  static Snapshot::Deployment deployment() {
    return {
        .domain = 0, .interface = "cable", .peers = {}, .processes = {{"office", ""}, {"cart[0]", "cart"}}};
  }
  void expect_dropped(const std::string& text, network::StatusPart part = whole) {
    inbox_.heard({0, 7}, part, text);
    EXPECT_TRUE(inbox_.take().empty()) << text.substr(0, 100);
    EXPECT_THAT(inbox_.remark(), HasSubstr(std::to_string(++dropped_) + " messages")) << text.substr(0, 100);
  }
  StatusInbox inbox_{"depot", deployment()};
  int dropped_ = 0;
};

TEST_F(Inbox, KeepsTheNewestTextOfEachStart) {
  inbox_.heard({1, 7}, whole, told_by("cart[0]", 7).dump());
  json newer = told_by("cart[0]", 7);
  newer["time_s"] = 9;
  inbox_.heard({1, 7}, whole, newer.dump());
  newer["brief"] = true;
  inbox_.heard({1, 7}, brief, newer.dump());
  inbox_.heard({1, 8}, whole, told_by("cart[0]", 8).dump());
  const std::vector<HeardStatus> all = inbox_.take();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].snapshot.time_s, 9);
  EXPECT_TRUE(all[1].snapshot.brief && all[1].line.empty());
  EXPECT_EQ(all[2].incarnation, "8");
  EXPECT_TRUE(inbox_.take().empty());
  EXPECT_EQ(inbox_.remark(), "");
}

TEST_F(Inbox, TellsWhoHasEndedAndWhoHasVanishedIfItWasHeard) {
  inbox_.left({1, 7});
  EXPECT_TRUE(inbox_.take().empty());
  inbox_.heard({1, 7}, whole, told_by("cart[0]", 7).dump());
  static_cast<void>(inbox_.take());
  inbox_.heard({1, 7}, brief, R"({"ended":true})");
  inbox_.left({1, 7});
  const std::vector<HeardStatus> all = inbox_.take();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_TRUE(all[0].what == What::ended && all[1].what == What::vanished);
  EXPECT_EQ(all[1].process, "cart[0]");
}

TEST_F(Inbox, DropsAndCountsWhatNoProcessOfTheDeploymentTells) {
  inbox_.heard({1, 7}, whole, told_by("nobody", 7).dump());
  EXPECT_TRUE(inbox_.take().empty());
  dropped_ = 1;
  expect_dropped("");
  expect_dropped("{");
  expect_dropped("[]");
  expect_dropped(std::string("\xff\xfe", 2));
  expect_dropped(R"({"ended":true})");  // of one that was never heard
  expect_dropped(R"({"answer":1,"error":""})");
  expect_dropped(told_by("office", 8).dump());  // of another start
  json wrong = told_by("office", 7);
  wrong["system"] = "other";
  expect_dropped(wrong.dump());
  wrong = told_by("office", 7);
  wrong["time_s"] = "soon";
  expect_dropped(wrong.dump());
  wrong = told_by("office", 7);
  wrong["brief"] = true;
  expect_dropped(wrong.dump());
  expect_dropped(told_by("office", 7).dump(), brief);
  wrong = told_by("office", 7);
  wrong["more"] = std::string(network::longest_status_bytes, 'x');
  expect_dropped(wrong.dump());
}

TEST_F(Inbox, DeepTextsNeedNoDeepStack) {
  std::string deep = told_by("office", 7).dump();
  deep.pop_back();
  deep += R"(,"more":)" + std::string(15000, '[') + std::string(15000, ']') + "}";
  expect_dropped(deep);
  // Brackets in strings are no nesting.
  json harmless = told_by("office", 7);
  harmless["host"] = std::string(100, '[') + "\"" + std::string(100, '{');
  inbox_.heard({0, 7}, whole, harmless.dump());
  EXPECT_EQ(inbox_.take().size(), 1U);
}

TEST_F(Inbox, LettersThatTerminalsObeyAreEscaped) {
  json text = told_by("office", 7);
  text["host"] = "\x1b[2J\x7f\xc2\x9b";
  inbox_.heard({0, 7}, whole, text.dump());
  const std::vector<HeardStatus> all = inbox_.take();
  ASSERT_EQ(all.size(), 1U);
  for (const char letter : all[0].line)
    EXPECT_TRUE(letter >= 0x20 && letter < 0x7f) << static_cast<int>(letter);
}

TEST_F(Inbox, InventedStartsFillNoMemory) {
  constexpr std::uint64_t starts = sanitized ? 4'200 : 10'000;
  for (std::uint64_t incarnation = 1; incarnation <= starts; ++incarnation)
    inbox_.heard({0, incarnation}, whole, told_by("office", incarnation).dump());
  EXPECT_LE(inbox_.take().size(), 4096U);
  inbox_.heard({0, 1}, whole, told_by("office", 1).dump());
  EXPECT_TRUE(inbox_.take().empty()) << "older than all that are kept";
  inbox_.heard({0, starts + 1}, whole, told_by("office", starts + 1).dump());
  EXPECT_EQ(inbox_.take().size(), 1U);
}

}  // namespace
}  // namespace tessera::project
