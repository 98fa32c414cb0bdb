// Times that a specification asks for, as `verify` and `check` tell them.
#include "command.hpp"

namespace tessera::cli_test {

using VerifyTimes = Command;

const std::string arm = std::string(TESSERA_SOURCE_DIR) + "/examples/09_arm/spec.yaml";

TEST_F(VerifyTimes, ChainsThatHoldAreToldAndExplained) {
  const project::Exit done = tessera("verify " + arm);
  EXPECT_EQ(done.code, 0) << done.text;
  EXPECT_NE(done.text.find(
                "joints to motors: age holds (exact: 81 ms; asked 100 ms), reaction holds (exact: 101 ms; "
                "asked 120 ms)"),
            std::string::npos)
      << done.text;
  const nlohmann::json result = json("verify " + arm);
  ASSERT_EQ(result.at("chains").size(), 1U);
  EXPECT_EQ(result["chains"][0].at("chain"), "joints to motors");
  EXPECT_EQ(result["chains"][0].at("age"), "holds");
  EXPECT_EQ(result.at("times").at("rates").size(), 3U);
  EXPECT_EQ(result["times"]["rates"][0].at("keeps"), true);

  const project::Exit explained =
      tessera("verify " + arm + " --explain 'joints to motors' --json chain.json");
  EXPECT_EQ(explained.code, 0) << explained.text;
  EXPECT_NE(explained.text.find("what helps most: "), std::string::npos) << explained.text;
  const auto chain = nlohmann::json::parse(content_of(folder_ / "chain.json"));
  std::int64_t age = 0;
  for (const auto& step : chain.at("steps").at("age")) age += step.at("ns").get<std::int64_t>();
  EXPECT_EQ(age, 81'000'000);
  // A file behind --explain is the specification.
  const project::Exit all = tessera("verify --explain " + arm);
  EXPECT_EQ(all.code, 0) << all.text;
  EXPECT_NE(all.text.find("arm.control: begins every 20 ms: it keeps its rate"), std::string::npos)
      << all.text;
  const project::Exit wrong = tessera("verify " + arm + " --explain 'joints to motor'");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.text.find("did you mean 'joints to motors'?"), std::string::npos) << wrong.text;
  const project::Exit none = tessera("verify " + arm + " --explain wheels");
  EXPECT_NE(none.text.find("the chains are: joints to motors"), std::string::npos) << none.text;
}

TEST_F(VerifyTimes, WhatIsNotProvedOrViolatedHasTheExitCodesOfProperties) {
  fs::copy_file(arm, folder_ / "spec.yaml");
  replace(folder_ / "spec.yaml", "simulation:", "# simulation:");
  std::string text = content_of(folder_ / "spec.yaml");
  write(folder_ / "spec.yaml", text.substr(0, text.find("# simulation:")));
  replace(folder_ / "spec.yaml", "age: 100 ms", "age: 80 ms");
  const project::Exit violated = tessera("verify spec.yaml");
  EXPECT_EQ(violated.code, 1) << violated.text;
  EXPECT_NE(violated.text.find("age violated (exact: 81 ms; asked 80 ms)"), std::string::npos)
      << violated.text;

  // With a latency the bound is exact because a run was found; behaviours with other times stand against a search.
  replace(folder_ / "spec.yaml", "timing:\n", "timing:\n  latency: 100 us\n");
  EXPECT_EQ(tessera("verify spec.yaml").code, 1);
  replace(folder_ / "spec.yaml", "left:  { terminal: memory.there, takes: 0.5..4 ms",
          "left:  { terminal: memory.there, takes: 0.5..3 ms");
  const project::Exit unproved = tessera("verify spec.yaml");
  EXPECT_EQ(unproved.code, 3) << unproved.text;
  EXPECT_NE(unproved.text.find(", asked 80 ms: not proved"), std::string::npos) << unproved.text;
  EXPECT_EQ(tessera("verify spec.yaml --property goes_on").code, 0);

  const project::Exit stopped = tessera("verify spec.yaml --timeout 0s");
  EXPECT_EQ(stopped.code, 3) << stopped.text;
  EXPECT_NE(stopped.text.find("times: not computed"), std::string::npos) << stopped.text;

  replace(folder_ / "spec.yaml", "measure: { takes: 0.2..1 ms }", "measure: {}");
  const project::Exit none = tessera("verify spec.yaml");
  EXPECT_EQ(none.code, 3) << none.text;
  EXPECT_NE(none.text.find("none: arm.encoders.measure does not say what it takes"), std::string::npos)
      << none.text;
  const project::Exit checked = tessera("check spec.yaml");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_NE(checked.text.find("N341"), std::string::npos) << checked.text;
}

}  // namespace tessera::cli_test
