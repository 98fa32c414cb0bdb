#include <gmock/gmock.h>

#include "served.hpp"
#include "server/analysis/analysis.hpp"

namespace tessera::server_test {

using nlohmann::json;

class VerifyJob : public Served {
 protected:
  json verify(const json& body) {
    EventStream stream(port_, token_);
    EXPECT_FALSE(stream.next("hello").is_null());
    const Reply started = post("/api/verify", body);
    EXPECT_EQ(started.status, 202) << started.body;
    const json job = started.json().at("job");
    json done = stream.next(
        "verify", [&](const json& data) { return data.at("job") == job && data.at("state") != "running"; });
    EXPECT_EQ(get("/api/verify/" + job.get<std::string>()).json(), done);
    return done;
  }
};

TEST_F(VerifyJob, FindsThatTheExampleHolds) {
  serve();
  const json done = verify({{"text", content_of(spec())}});
  EXPECT_EQ(done.at("state"), "done");
  const json& result = done.at("result");
  EXPECT_EQ(result.at("net_hash"), get("/api/spec").json().at("analysis").at("net_hash"));
  ASSERT_GT(result.at("properties").size(), 5U);
  for (const json& property : result.at("properties")) {
    EXPECT_EQ(property.at("verdict"), "holds") << property;
    EXPECT_TRUE(property.at("steps").is_null());
  }
}

TEST_F(VerifyJob, AViolationHasStepsOfTheNetAndIsToldInWords) {
  std::string text = content_of(spec());
  const std::string own = "properties:\n";
  ASSERT_NE(text.find(own), std::string::npos);
  text.replace(text.find(own), own.size(), own + "  - { name: still, never: robot.motor.drive }\n");
  serve();
  const json done = verify({{"text", text}, {"properties", {"still"}}});
  const json& result = done.at("result");
  ASSERT_EQ(result.at("properties").size(), 1U);
  const json& property = result.at("properties")[0];
  ASSERT_EQ(property.at("verdict"), "violated") << property;
  const server::Analysis analysis = server::analyse("spec.yaml", text);
  const auto& transitions = analysis.net->transitions();
  ASSERT_EQ(property.at("steps").size(), property.at("trace").size());
  for (std::size_t step = 0; step < property.at("steps").size(); ++step) {
    const std::size_t index = property.at("steps")[step];
    if (index < transitions.size()) {
      EXPECT_EQ(transitions[index].name, property.at("trace")[step].at("transition"));
    }
  }
  const json& last = property.at("narrative").back();
  EXPECT_EQ(last.at("who"), "robot.motor");
  EXPECT_THAT(last.at("text").get<std::string>(), testing::StartsWith("starts in drive"));
  EXPECT_THAT(last.at("text").get<std::string>(), testing::Not(testing::HasSubstr("(t")));
  EXPECT_EQ(last.at("last"), property.at("steps").size());
}

constexpr const char* greeting = R"(tessera: 1
system: greeting
agents:
  left: { control: { inputs: { heard: bool }, outputs: { said: bool }, behaviours: { talk: {} } } }
  right: { control: { inputs: { heard: bool }, outputs: { said: bool }, behaviours: { talk: {} } } }
channels:
  - { from: left.control.said, to: right.control.heard, send: blocking, receive: blocking }
  - { from: right.control.said, to: left.control.heard, send: blocking, receive: blocking }
)";

TEST_F(VerifyJob, WhoIsStuckIsData) {
  serve();
  const json done = verify({{"text", greeting}, {"properties", {"goes_on"}}});
  const json& property = done.at("result").at("properties")[0];
  ASSERT_EQ(property.at("verdict"), "violated") << property;
  const json& at_end = property.at("at_end");
  ASSERT_EQ(at_end.size(), 2U) << at_end;
  for (const json& one : at_end) {
    EXPECT_EQ(one.at("state"), "waits");
    const bool left = one.at("path") == "left.control";
    EXPECT_EQ(one.at("from"), json::array({left ? "right.control" : "left.control"}));
  }
  // The same is found in the marking at the end of the run.
  const server::Analysis analysis = server::analyse("spec.yaml", greeting);
  std::vector<std::uint32_t> tokens;
  for (const net::Place& place : analysis.net->places()) tokens.push_back(place.tokens);
  for (const json& step : property.at("steps")) {
    const net::TransitionId transition{step.get<std::uint32_t>()};
    for (const net::Arc& arc : analysis.net->preset(transition)) --tokens[arc.place.value];
    for (const net::Arc& arc : analysis.net->postset(transition)) ++tokens[arc.place.value];
  }
  json marking = json::array();
  for (std::size_t place = 0; place < tokens.size(); ++place)
    if (tokens[place] > 0) marking.push_back({{"place", place}});
  const Reply waits = post("/api/waits", {{"text", greeting}, {"marking", marking}});
  EXPECT_EQ(waits.json().at("at_end"), at_end) << waits.body;
  EXPECT_EQ(post("/api/waits", {{"text", "tessera: 1"}, {"marking", json::array()}}).status, 422);
}

TEST_F(VerifyJob, RefusesWhatHasNoNetAndWhatNobodyKnows) {
  serve();
  EXPECT_EQ(post("/api/verify", {{"text", "tessera: 1"}}).status, 422);
  const Reply unknown = post("/api/verify", {{"text", content_of(spec())}, {"properties", {"saef"}}});
  EXPECT_EQ(unknown.status, 422);
  EXPECT_THAT(unknown.json().at("hint").get<std::string>(), testing::HasSubstr("safe"));
  EXPECT_EQ(post("/api/verify", {{"text", content_of(spec())}, {"timeout", "soon"}}).status, 400);
  EXPECT_EQ(get("/api/verify/77").status, 404);
  EXPECT_EQ(ask("DELETE", "/api/verify/99999999999999999999999", {}).status, 404);
}

}  // namespace tessera::server_test
