#include "command.hpp"

namespace tessera::cli_test {

using Verify = Command;

constexpr const char* stuck_system =
    "tessera: 1\nsystem: s\ntypes: { V: { v: float64 } }\nagents:\n"
    "  a: { control: { rate: 10 Hz, inputs: { x: V }, outputs: { y: V }, behaviours: { go: {} } } }\n"
    "  b: { control: { rate: 10 Hz, inputs: { x: V }, outputs: { y: V }, behaviours: { go: {} } } }\n"
    "channels:\n"
    "  - { from: a.control.y, to: b.control.x, send: blocking, receive: blocking }\n"
    "  - { from: b.control.y, to: a.control.x, send: blocking, receive: blocking }\n";

constexpr const char* net_that_stops =
    "<?xml version=\"1.0\"?>\n<pnml xmlns=\"http://www.pnml.org/version-2009/grammar/pnml\">"
    "<net id=\"n\" type=\"http://www.pnml.org/version-2009/grammar/ptnet\"><page id=\"g\">"
    "<place id=\"p\"><initialMarking><text>1</text></initialMarking></place><place id=\"q\"/>"
    "<transition id=\"t\"/><arc id=\"a\" source=\"p\" target=\"t\"/><arc id=\"b\" source=\"t\" target=\"q\"/>"
    "</page></net></pnml>\n";

TEST_F(Verify, TheExampleHoldsInEveryRespect) {
  const std::string spec = std::string(TESSERA_SOURCE_DIR) + "/examples/01_line_follower/spec.yaml";
  const nlohmann::json result = json("verify " + spec);
  ASSERT_EQ(result.at("properties").size(), 9U);
  for (const auto& property : result.at("properties")) EXPECT_EQ(property.at("verdict"), "holds") << property;
  EXPECT_EQ(result.at("properties").back().at("name"), "motors can always run");
  EXPECT_EQ(result.at("properties").back().at("asks"), "always_reachable robot.motor.drive");
  const project::Exit explained = tessera("verify " + spec + " --property goes_on --explain");
  EXPECT_NE(explained.text.find("if every branch that is offered is taken eventually"), std::string::npos)
      << explained.text;
}

TEST_F(Verify, AViolationNamesTheRunTheLinesAndWhoWaitsForWhom) {
  write(folder_ / "stuck.yaml", stuck_system);
  const project::Exit done = tessera("verify stuck.yaml --trace run.json");
  EXPECT_EQ(done.code, 1) << done.text;
  for (const char* part :
       {"deadlock_free: violated",
        "a.control  starts in go: computes (t1), sends y (t1, t2), waits for the acknowledgement  [line 5]",
        "channels at the end",
        "a.control waits for the acknowledgement of a.control.y->b.control.x from b.control"})
    EXPECT_NE(done.text.find(part), std::string::npos) << part << "\n" << done.text;
  const auto traces = nlohmann::json::parse(content_of(folder_ / "run.json")).at("traces");
  ASSERT_FALSE(traces.empty());
  EXPECT_EQ(traces[0].at("property"), "deadlock_free");
  EXPECT_EQ(traces[0].at("firings")[0].at("transition"), "t_in");
  EXPECT_EQ(traces[0].at("waits").size(), 2U);
}

TEST_F(Verify, AFileIsWhatItHoldsWhateverItIsCalled) {
  const std::string bytes = "\xEF\xBB\xBF" + std::string("\n  ") + std::string(net_that_stops).substr(22);
  for (const char* name : {"net.xml", "net.tapn", "net.PNML", "net", "net.yaml"}) {
    write(folder_ / name, net_that_stops);
    const project::Exit done = tessera(std::string("verify ") + name);
    EXPECT_EQ(done.code, 1) << name << done.text;
    EXPECT_NE(done.text.find("deadlock_free: violated"), std::string::npos) << name << done.text;
    EXPECT_NE(tessera(std::string("play ") + name + " 3").text.find("1 firing"), std::string::npos) << name;
    EXPECT_NE(tessera(std::string("check ") + name).text.find("E005: this is XML"), std::string::npos)
        << name;
  }
  write(folder_ / "late.txt", bytes);
  EXPECT_EQ(tessera("verify late.txt").code, 1);
  write(folder_ / "stuck.pnml", stuck_system);
  EXPECT_NE(tessera("verify stuck.pnml").text.find("a.control waits for the acknowledgement"),
            std::string::npos);
}

TEST_F(Verify, APnmlNetHasTwoPropertiesAndEveryDeadMarkingCounts) {
  write(folder_ / "net.pnml", net_that_stops);
  const project::Exit done = tessera("verify net.pnml --states --json -");
  EXPECT_EQ(done.code, 1) << done.text;
  const nlohmann::json result = nlohmann::json::parse(done.text);
  ASSERT_EQ(result.at("properties").size(), 2U);
  EXPECT_EQ(result["properties"][0].at("verdict"), "holds");
  EXPECT_EQ(result["properties"][1].at("name"), "deadlock_free");
  EXPECT_EQ(result["properties"][1].at("verdict"), "violated");
  EXPECT_EQ(result["properties"][1].at("trace").size(), 1U);
  EXPECT_EQ(result.at("state_space").at("markings"), 2);
  EXPECT_EQ(result.at("state_space").at("edges"), 1);
}

TEST_F(Verify, WhatCannotBeDecidedIsUnknown) {
  const std::string spec = std::string(TESSERA_SOURCE_DIR) + "/examples/01_line_follower/spec.yaml";
  const project::Exit done = tessera("verify " + spec + " --property goes_on --method invariants");
  EXPECT_EQ(done.code, 3) << done.text;
  EXPECT_NE(done.text.find("goes_on: unknown"), std::string::npos) << done.text;
}

TEST_F(Verify, MemoryIsLimited) {
  write(folder_ / "stuck.yaml", stuck_system);
  const project::Exit done = tessera("verify stuck.yaml --memory 1kB --method explicit --property goes_on");
  EXPECT_EQ(done.code, 3) << done.text;
  EXPECT_NE(done.text.find("the memory limit of "), std::string::npos) << done.text;
  const project::Exit wrong = tessera("verify stuck.yaml --memory lots");
  EXPECT_NE(wrong.code, 0);
  EXPECT_NE(wrong.text.find("--memory: 'lots' is no size"), std::string::npos) << wrong.text;
}

TEST_F(Verify, WrongNamesAreDiagnosed) {
  write(folder_ / "stuck.yaml", stuck_system);
  const project::Exit done = tessera("verify stuck.yaml --property goes_onn");
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.text.find("did you mean 'goes_on'?"), std::string::npos) << done.text;
  const project::Exit time = tessera("verify stuck.yaml --timeout soon");
  EXPECT_EQ(time.code, 1);
  EXPECT_NE(time.text.find("'soon' is no time"), std::string::npos) << time.text;
}

}  // namespace tessera::cli_test
