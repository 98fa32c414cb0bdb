// Scans and pictures that a page can show: where they are, and their values in a recording.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "served.hpp"
#include "tessera/recording.hpp"

namespace tessera::server_test {

using nlohmann::json;

/// A rover with a laser, in place of the line follower.
class ViewsOfTheStudio : public Served {
 protected:
  ViewsOfTheStudio() { mirror(fs::path(TESSERA_SOURCE_DIR) / "examples/08_rover", folder_ / "project"); }

  void replace(const std::string& old, const std::string& by) const {
    std::string text = content_of(spec());
    text.replace(text.find(old), old.size(), by);
    write(spec(), text);
  }
};

TEST_F(ViewsOfTheStudio, SayWhereAScanIsOnItsBody) {
  serve();
  const json views = get("/api/views").json().at("views");
  ASSERT_EQ(views.size(), 1U) << views;
  const json& scan = views[0];
  EXPECT_EQ(scan.at("path"), "robot.laser.ranges");
  EXPECT_EQ(scan.at("kind"), "scan");
  EXPECT_EQ(scan.at("body"), "robot/base");
  // As rover.xml and spec.yaml say, wherever the model stands and however it is turned.
  EXPECT_NEAR(scan.at("position").at(0), 0, 1e-9);
  EXPECT_NEAR(scan.at("position").at(1), 0, 1e-9);
  EXPECT_NEAR(scan.at("position").at(2), 0.02, 1e-9);
  EXPECT_NEAR(std::abs(scan.at("quaternion").at(0).get<double>()), 1, 1e-9);
  EXPECT_NEAR(scan.at("reach"), 3, 1e-9);
  EXPECT_NEAR(scan.at("to"), std::numbers::pi, 1e-9);
}

TEST_F(ViewsOfTheStudio, ThatCannotBeAskedForSayWhy) {
  replace("world: hall.xml", "world: nowhere.xml");
  serve();
  const Reply reply = get("/api/views");
  EXPECT_EQ(reply.status, 422);
  EXPECT_THAT(reply.body, testing::HasSubstr("nowhere.xml"));
}

TEST_F(ViewsOfTheStudio, HaveTheirNumbersInRecordings) {
  const auto event = [](std::int64_t time_ns, std::uint32_t buffer, const std::string& bytes) {
    const Event head{.time_ns = time_ns,
                     .subject = static_cast<std::uint32_t>(bytes.size()),
                     .version = buffer,
                     .origin = static_cast<std::uint32_t>(Event::Kind::value)};
    std::string all(reinterpret_cast<const char*>(&head), sizeof head);
    all += bytes;
    all.resize((all.size() + sizeof head - 1) / sizeof head * sizeof head);
    return all;
  };
  const auto numbers = [](float first, float second) {
    const std::array<float, 2> both{first, second};
    return std::string(reinterpret_cast<const char*>(both.data()), sizeof both);
  };
  json header{{"system", "scout"},         {"net_hash", ""},
              {"verification_hash", ""},   {"seed", 1},
              {"clock", "simulated"},      {"instances", {"robot.laser"}},
              {"channels", json::array()}, {"transitions", json::array()}};
  header["values"] = {
      {"limit", 4096},
      {"buffers", json::array({json::array({"robot.laser.ranges", 0, "real_in", "float32[2]"}),
                               json::array({"robot.laser.bright", 0, "real_in", "float32"})})}};
  const std::string text = header.dump();
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string bytes(recording_magic);
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length).append(text);
  bytes.resize((bytes.size() + 7) / 8 * 8);
  bytes += event(0, 0, numbers(1, 2)) + event(0, 1, numbers(7, 7).substr(0, 4)) +
           event(1'000'000'000, 0, numbers(3, 4)) + event(2'000'000'000, 0, numbers(5, 6));
  write(folder_ / "project/run.tsr", bytes);
  serve();
  EXPECT_EQ(get("/api/recordings/nobody.tsr/arrays?from=0&to=1").status, 404);
  // Little-endian 1, 2 and so on, in base64.
  const std::string one = "AACAPwAAAEA=", three = "AABAQAAAgEA=", five = "AACgQAAAwEA=";
  const json whole = get("/api/recordings/run.tsr/arrays?from=0&to=9000000000").json().at("arrays");
  ASSERT_EQ(whole.size(), 3U) << whole;
  EXPECT_EQ(whole[0], json::array({0, {{"robot.laser.ranges", one}}}));
  EXPECT_EQ(whole[2], json::array({2'000'000'000, {{"robot.laser.ranges", five}}}));
  // A part begins with the values before it.
  const json part = get("/api/recordings/run.tsr/arrays?from=500000000&to=1500000000").json().at("arrays");
  ASSERT_EQ(part.size(), 2U) << part;
  EXPECT_EQ(part[0], json::array({500'000'000, {{"robot.laser.ranges", one}}}));
  EXPECT_EQ(part[1], json::array({1'000'000'000, {{"robot.laser.ranges", three}}}));
}

}  // namespace tessera::server_test
