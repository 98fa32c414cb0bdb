#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "served.hpp"

namespace tessera::server_test {

using nlohmann::json;

class Timing : public Served {
 protected:
  /// The line follower, or a fleet of such robots, with the times of docs/theory/timing.md.
  static std::string robot(const std::string& agent) {
    return R"(tessera: 1
system: follower
types: { Reading: { dark: bool }, Velocity: { linear: float64 } }
templates:
  follower:
    control:
      rate: 20 Hz
      inputs: { line: Reading }
      outputs: { motion: Velocity }
      behaviours: { follow: { takes: 2..8 ms } }
    receptors:
      sensor:
        rate: 50 Hz
        real: { light: float64 }
        outputs: { line: Reading }
        behaviours: { watch: { takes: 1..2 ms } }
    effectors:
      motor:
        rate: 50 Hz
        inputs: { velocity: Velocity }
        real: { speed: float64 }
        behaviours: { drive: { takes: 1..2 ms } }
agents: { robot: )" +
           agent + R"( }
channels:
  - "ROBOT.sensor.line -> ROBOT.control.line"
  - { from: "ROBOT.control.motion", to: "ROBOT.motor.velocity", receive: blocking, timeout: 200 ms }
)";
  }
  static std::string with(std::string text, const std::string& name) {
    for (std::size_t at = 0; (at = text.find("ROBOT", at)) != std::string::npos;) text.replace(at, 5, name);
    return text;
  }
  json bounds(const std::string& text, const json& what_if = json::array()) {
    const Reply reply = post("/api/timing", {{"text", text}, {"what_if", what_if}});
    EXPECT_EQ(reply.status, 200) << reply.body;
    return reply.json();
  }
  const std::string chain_ = "robot.sensor -> robot.control -> robot.motor";
  const std::string single_ = with(robot("{ use: follower }"), "robot");
};

TEST_F(Timing, TheChainOfTheLineFollowerHasItsBounds) {
  serve();
  const json told = bounds(single_);
  ASSERT_EQ(told.at("chains").size(), 1U) << told;
  const json& chain = told.at("chains")[0];
  EXPECT_EQ(chain.at("path"), json({"robot.sensor", "robot.control", "robot.motor"}));
  EXPECT_EQ(chain.at("channels"),
            json({"robot.sensor.line->robot.control.line", "robot.control.motion->robot.motor.velocity"}));
  EXPECT_EQ(chain.at("age").at("at_most_ns"), 82'000'000);
  EXPECT_EQ(chain.at("reaction").at("at_most_ns"), 142'000'000);
  EXPECT_EQ(chain.at("why"), "");
  EXPECT_EQ(told.at("subsystems")[1], json({{"path", "robot.control"},
                                            {"period_ns", 50'000'000},
                                            {"shortest_ns", 2'000'000},
                                            {"longest_ns", 8'000'000},
                                            {"waits", false},
                                            {"missing", ""}}));
  EXPECT_EQ(told.at("subsystems")[2].at("waits"), true);
}

TEST_F(Timing, OtherTimesAreThoseOfATextThatSaysThem) {
  serve();
  std::string faster = single_;
  faster.replace(faster.find("20 Hz"), 5, "50 Hz");
  EXPECT_EQ(bounds(single_, {{{"path", "robot.control"}, {"period_ns", 20'000'000}}}), bounds(faster));
  std::string slower = single_;
  slower.replace(slower.find("2..8 ms"), 7, "2..9 ms");
  EXPECT_EQ(bounds(single_, {{{"path", "robot.control"}, {"longest_ns", 9'000'000}}}), bounds(slower));
  std::string driven = single_;
  driven.replace(driven.rfind("        rate: 50 Hz\n"), 20, "");
  const json without = bounds(single_, {{{"path", "robot.motor"}, {"period_ns", 0}}});
  EXPECT_EQ(without, bounds(driven));
  EXPECT_EQ(without.at("chains")[0].at("reaction").at("at_most_ns"), 130'000'000);
}

TEST_F(Timing, AFleetIsOneEntryAndItsMembersChangeTogether) {
  serve();
  const std::string fleet = with(robot("{ use: follower, count: 3 }"), "robot[i]");
  const json told = bounds(fleet, {{{"path", "robot.control"}, {"period_ns", 20'000'000}}});
  ASSERT_EQ(told.at("chains").size(), 1U) << told;
  EXPECT_EQ(told.at("chains")[0].at("agents"), 3);
  EXPECT_EQ(told.at("chains")[0].at("name"), "robot[0].sensor -> robot[0].control -> robot[0].motor");
  EXPECT_EQ(told, bounds(fleet, {{{"path", "robot[2].control"}, {"period_ns", 20'000'000}}}));
}

TEST_F(Timing, AChainWithoutABoundSaysWhy) {
  serve();
  std::string text = single_;
  text.replace(text.find("{ takes: 2..8 ms }"), 18, "{}");
  const json told = bounds(text);
  EXPECT_EQ(told.at("chains")[0].at("age").at("at_most_ns"), nullptr);
  EXPECT_EQ(told.at("chains")[0].at("why"), "robot.control.follow does not say what it takes");
  const Reply guessed = post(
      "/api/timing", {{"text", text}, {"what_if", {{{"path", "robot.control"}, {"longest_ns", 9'000'000}}}}});
  EXPECT_EQ(guessed.status, 422);
}

TEST_F(Timing, ThePartsOfATimeAddUpToIt) {
  serve();
  const auto explained = [&](const json& what_if) {
    const Reply reply = post("/api/timing", {{"text", single_}, {"what_if", what_if}, {"chain", chain_}});
    EXPECT_EQ(reply.status, 200) << reply.body;
    return reply.json();
  };
  const std::vector<json> questions{json::array(), {{{"path", "robot.control"}, {"period_ns", 20'000'000}}}};
  for (const json& what_if : questions) {
    const json told = explained(what_if);
    for (const char* const name : {"age", "reaction"}) {
      std::int64_t sum = 0;
      for (const json& step : told.at("steps").at(name)) sum += step.at("ns").get<std::int64_t>();
      EXPECT_EQ(sum, told.at("chains")[0].at(name).at("at_most_ns")) << name << told;
    }
  }
  EXPECT_EQ(bounds(single_).at("steps"), nullptr);
}

TEST_F(Timing, AChangeThatHelpsHasTheBoundsOfATextWithIt) {
  serve();
  const Reply reply = post("/api/timing/changes", {{"text", single_}, {"chain", chain_}});
  ASSERT_EQ(reply.status, 200) << reply.body;
  const json changes = reply.json().at("changes");
  const auto driven = std::ranges::find_if(changes, [](const json& change) {
    return change.at("kind") == "event_driven" && change.at("subsystem") == "robot.motor";
  });
  ASSERT_NE(driven, changes.end()) << changes;
  EXPECT_EQ(driven->at("channel"), "robot.control.motion->robot.motor.velocity");
  EXPECT_EQ(driven->at("age_ns"), 80'000'000);
  EXPECT_EQ(driven->at("reaction_ns"), 130'000'000);
  EXPECT_EQ(post("/api/timing/changes", {{"text", single_}, {"chain", "robot"}}).status, 422);
  EXPECT_EQ(post("/api/timing/changes", {{"text", "agents: ["}, {"chain", chain_}}).status, 422);
}

TEST_F(Timing, TheWorstRunReachesTheBound) {
  serve();
  const auto run = [&](const std::string& of, const json& what_if = json::array()) {
    const Reply reply =
        post("/api/timing/worst", {{"text", single_}, {"chain", chain_}, {"of", of}, {"what_if", what_if}});
    EXPECT_EQ(reply.status, 200) << reply.body;
    EXPECT_EQ(reply.json().at("why"), "");
    return reply.json().at("run");
  };
  const json reaction = run("reaction");
  EXPECT_EQ(reaction.at("at_most_ns"), 142'000'000);
  EXPECT_EQ(reaction.at("reaches"), true);
  EXPECT_EQ(reaction.at("to_ns").get<long>() - reaction.at("from_ns").get<long>(), 142'000'000);
  ASSERT_EQ(reaction.at("hops").size(), 2U);
  EXPECT_EQ(reaction.at("hops")[0].at("channel"), "robot.sensor.line->robot.control.line");
  EXPECT_EQ(reaction.at("hops")[1].at("to"), "robot.motor");
  EXPECT_EQ(reaction.at("calls").back().at("subsystem"), "robot.motor");
  EXPECT_EQ(reaction.at("calls").back().at("end_ns"), reaction.at("to_ns"));
  EXPECT_EQ(run("age").at("at_most_ns"), 82'000'000);
  EXPECT_EQ(run("reaction", {{{"path", "robot.motor"}, {"period_ns", 0}}}).at("at_most_ns"), 130'000'000);

  std::string other = single_;
  other.replace(other.find("{ takes: 2..8 ms }"), 18, "{}");
  const json none = post("/api/timing/worst", {{"text", other}, {"chain", chain_}, {"of", "age"}}).json();
  EXPECT_EQ(none.at("run"), nullptr);
  EXPECT_EQ(none.at("why"), "robot.control.follow does not say what it takes");
  EXPECT_EQ(post("/api/timing/worst", {{"text", single_}, {"chain", "robot"}, {"of", "age"}}).status, 422);
  EXPECT_EQ(post("/api/timing/worst", {{"text", single_}, {"chain", chain_}, {"of", "both"}}).status, 400);
}

TEST_F(Timing, WhatIsAskedHasAnAnswer) {
  serve();
  const std::string asks = single_ +
                           "timing: { chains: [{ name: quick, path: [robot.sensor, robot.control, "
                           "robot.motor], reaction: 100 ms }] }\n";
  const json chain = bounds(asks).at("chains")[0];
  EXPECT_EQ(chain.at("name"), "quick");
  EXPECT_EQ(chain.at("named"), true);
  EXPECT_EQ(chain.at("age").at("answer"), "not_asked");
  EXPECT_EQ(chain.at("reaction"),
            json({{"at_most_ns", 142'000'000}, {"asked_ns", 100'000'000}, {"answer", "unknown"}}));
}

TEST_F(Timing, WhatIsNotUnderstoodIsRefused) {
  serve();
  const auto status = [&](const json& body) { return post("/api/timing", body).status; };
  EXPECT_EQ(status({{"text", "agents: ["}}), 422);
  EXPECT_EQ(status({{"text", single_}, {"what_if", {{{"path", "robot.arm"}, {"period_ns", 1}}}}}), 422);
  EXPECT_EQ(status({{"text", single_}, {"what_if", {{{"path", "robot.control"}, {"shortest_ns", 9e6}}}}}),
            422);
  EXPECT_EQ(status({{"text", single_}, {"what_if", {{{"path", "robot.control"}, {"period_ns", -1}}}}}), 400);
  EXPECT_EQ(status({{"text", single_}, {"what_if", {{{"path", "robot.control"}, {"period", 1}}}}}), 400);
  EXPECT_EQ(status({{"text", single_}, {"what_if", {{{"period_ns", 1}}}}}), 400);
  EXPECT_EQ(status({{"text", single_}, {"what_if", 3}}), 400);
}

TEST_F(Timing, TheAnswersToWhatTheSpecificationAsksAreTold) {
  serve();
  const json told =
      bounds(single_ +
             "timing:\n  chains:\n    - { name: line to wheels, path: [robot.sensor, robot.control, "
             "robot.motor], age: 100 ms, reaction: 120 ms }\n");
  ASSERT_EQ(told.at("chains").size(), 1U) << told;
  const json& chain = told.at("chains")[0];
  EXPECT_EQ(chain.at("name"), "line to wheels");
  EXPECT_EQ(chain.at("age"),
            json({{"at_most_ns", 82'000'000}, {"asked_ns", 100'000'000}, {"answer", "holds"}}));
  EXPECT_EQ(chain.at("reaction"),
            json({{"at_most_ns", 142'000'000}, {"asked_ns", 120'000'000}, {"answer", "unknown"}}));
}

}  // namespace tessera::server_test
