#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "drawing/drawing.hpp"
#include "layers/models.hpp"
#include "net/counts.hpp"

namespace tessera::drawing {
namespace {

class WholeNet : public testing::Test {
 protected:
  test::Built built_ = test::build(test::line_follower());
  nlohmann::json json_ = nlohmann::json::parse(to_json(built_.pages, built_.net));
};

TEST_F(WholeNet, HasEveryElement) {
  ASSERT_EQ(json_["pages"].size(), built_.pages.pages.size());
  EXPECT_EQ(json_["flat"]["places"].size(), built_.net.places().size());
  EXPECT_EQ(json_["flat"]["transitions"].size(), built_.net.transitions().size());
  EXPECT_EQ(json_["fusions"].size(), 3U);
  EXPECT_EQ(json_["counts"]["flat"]["arcs"], built_.net.arc_count());
}

TEST_F(WholeNet, TellsTheOriginOfEveryPlace) {
  for (const auto& place : json_["flat"]["places"]) {
    if (place["page"].is_null()) {
      EXPECT_FALSE(place["channel"].is_null());
      continue;
    }
    const auto& page = json_["pages"][place["page"].get<std::size_t>()];
    EXPECT_EQ(place["layer"], page["layer"]);
    EXPECT_EQ(place["name"].get<std::string>().find(page["path"].get<std::string>()), 0U);
  }
}

TEST_F(WholeNet, TellsConditionsAndOperations) {
  const auto& drive = json_["pages"][built_.pages.find("robot.motor.drive").value];
  EXPECT_EQ(drive["transitions"][3]["condition"]["kind"], "go_on");
  EXPECT_EQ(drive["transitions"][3]["condition"]["truth"], "always");
  EXPECT_TRUE(drive["transitions"][0]["condition"].is_null());
  EXPECT_EQ(drive["nodes"][0]["operation"]["kind"], "transition_function");
  EXPECT_EQ(drive["nodes"][1]["page"], built_.pages.find("robot.motor.drive.snd").value);
  EXPECT_TRUE(drive["nodes"][1]["operation"].is_null());
}

}  // namespace
}  // namespace tessera::drawing
