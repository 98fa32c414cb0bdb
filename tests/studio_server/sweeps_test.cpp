#include "server/runs/sweeps.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "served.hpp"
#include "server/analysis/analysis.hpp"
#include "server/runs/sweep_results.hpp"

namespace tessera::server_test {

using nlohmann::json;
using server::SweepFile;
using server::SweepRow;
using testing::HasSubstr;

class SweepOfTheStudio : public Served {};

TEST_F(SweepOfTheStudio, TakesTheMeasuresOfASummary) {
  const json summary = json::parse(R"({"ended": "duration; a check failed: one", "failed": true, "firings": 7,
    "simulated_s": 2.5, "measures": {"near": {"least": 1, "greatest": 3, "mean": 2, "last": null, "unit": "m"},
    "never": null}, "checks": [{"name": "one", "verdict": "failed", "time_s": 0.5}, {"name": "two", "verdict": "open"}],
    "subsystems": [{"overruns": 2, "errors": 0}, {"overruns": 1, "errors": 4}]})");
  SweepRow row = SweepRow::of_summary(summary);
  row.value = "0.2 m/s";
  row.seed = 3;
  const json shown = row.shown();
  EXPECT_EQ(shown.at("numbers"), json::parse(R"({"near, mean": 2.0, "near, least": 1.0, "near, greatest": 3.0,
    "near, last": null, "never, mean": null, "never, least": null, "never, greatest": null, "never, last": null,
    "time of: one": 0.5, "time of: two": null, "overruns": 3.0, "errors": 4.0, "firings": 7.0, "simulated time": 2.5,
    "failed": 1.0})"));
  EXPECT_EQ(shown.at("units").at("near, mean"), "m");
  const std::optional<SweepRow> again = SweepRow::read(shown);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->shown(), shown);
  EXPECT_FALSE(SweepRow::read(json::parse(R"({"value": 7})")));
}

TEST_F(SweepOfTheStudio, KeepsItsRowsOverAnInterruptedWrite) {
  const fs::path file = folder_ / "sweeps/a.jsonl";
  SweepRow row;
  row.value = "1";
  row.seed = 4;
  row.ended = "duration";
  EXPECT_TRUE(SweepFile(file).add(row));
  std::ofstream(file, std::ios::app) << R"({"value": "2", "se)";
  SweepFile again(file);
  EXPECT_NE(again.find("1", 4), nullptr);
  EXPECT_EQ(again.find("1", 5), nullptr);
  EXPECT_EQ(again.find("2", 4), nullptr);
  row.seed = 5;
  EXPECT_TRUE(again.add(row));
  const SweepFile third(file);
  EXPECT_NE(third.find("1", 4), nullptr);
  EXPECT_NE(third.find("1", 5), nullptr);
}

TEST_F(SweepOfTheStudio, RefusesWhatTheParameterCannotBe) {
  const server::Analysis analysis = server::analyse("spec.yaml", R"(tessera: 1
system: one
parameters: { v: { default: 0.2 m/s, min: 0, max: 1 }, n: 3, on: true }
agents: { robot: { control: { rate: 10 Hz, behaviours: { a: {} } } } }
)");
  ASSERT_TRUE(analysis.model) << analysis.net_hash;
  const auto wrong = [&](const std::string& parameter, std::vector<std::string> values,
                         std::uint64_t runs = 1) {
    return server::wrong_with_sweep(*analysis.model,
                                    {.parameter = parameter, .values = std::move(values), .runs = runs});
  };
  EXPECT_EQ(wrong("v", {"0.1", "20 cm/s", "1 m/s"}), "");
  EXPECT_EQ(wrong("", {}, 10'000), "");
  EXPECT_THAT(wrong("v", {"0.1", "fast"}), HasSubstr("no number"));
  EXPECT_THAT(wrong("v", {"0.1 m"}), HasSubstr("unit"));
  EXPECT_THAT(wrong("v", {"200 cm/s"}), HasSubstr("maximum"));
  EXPECT_THAT(wrong("v", {"-1"}), HasSubstr("minimum"));
  EXPECT_THAT(wrong("on", {"1"}), HasSubstr("no number"));
  EXPECT_THAT(wrong("w", {"1"}), HasSubstr("there is no parameter"));
  EXPECT_THAT(wrong("v", {}), HasSubstr("needs values"));
  EXPECT_THAT(wrong("", {"1"}), HasSubstr("need the parameter"));
  EXPECT_THAT(wrong("v", {"0.1", "0.2"}, 5'001), HasSubstr("1 to 10000 runs"));
  EXPECT_THAT(wrong("v", std::vector<std::string>(201, "0.1")), HasSubstr("at most 200"));
}

TEST_F(SweepOfTheStudio, RunsNoCodeOfAFolderThatIsNotTrusted) {
  serve();
  const json request{{"runs", 2}, {"for", "1s"}};
  EXPECT_EQ(post("/api/sweeps", request).status, 403);
  for (const auto& [member, value] : {std::pair<std::string, json>{"runs", 0},
                                      {"runs", 1.5},
                                      {"runs", 10'001},
                                      {"runs", "2"},
                                      {"seed", -1},
                                      {"for", "soon"},
                                      {"for", "0s"},
                                      {"for", "2000min"},
                                      {"values", "0.1"}}) {
    json wrong = request;
    wrong[member] = value;
    EXPECT_EQ(post("/api/sweeps", wrong).status, 400) << member << value;
  }
  EXPECT_EQ(get("/api/sweeps/1").status, 404);
  EXPECT_EQ(ask("DELETE", "/api/sweeps/99999999999999999999", "").status, 404);
  const json list = get("/api/sweeps").json();
  EXPECT_EQ(list.at("sweeps"), json::array());
  EXPECT_THAT(list.at("parameters").dump(), HasSubstr("\"path\":\"v\""));
}

}  // namespace tessera::server_test
