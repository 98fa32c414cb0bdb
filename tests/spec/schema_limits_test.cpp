#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tessera/channel_limits.hpp"

namespace tessera {
namespace {

TEST(Schema, HasTheLimitsOfChannels) {
  std::ifstream file(TESSERA_SOURCE_DIR "/share/tessera/spec.schema.json");
  const nlohmann::json model = nlohmann::json::parse(file)["$defs"]["model"]["properties"];
  EXPECT_EQ(model["shared"]["maxProperties"], most_shared_places);
  EXPECT_EQ(model["slots"]["maximum"], most_slots);
}

}  // namespace
}  // namespace tessera
