#include "statistics/results.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "example_results.hpp"
#include "statistics/table.hpp"

namespace tessera::statistics {
namespace {

using nlohmann::json;

TEST(Results, ComeBackFromTheirJson) {
  const std::string text = to_json(example_results(101, 201));
  const Result<Results> back = parse_results(text);
  ASSERT_TRUE(back) << back.problem();
  EXPECT_EQ(to_json(*back), text);
  const json written = json::parse(text);
  EXPECT_EQ(written.at("reproduce"), "tessera simulate rover --interleave --for 1s --seed 110");
  EXPECT_EQ(written.at("outcomes").at(1).at("first_seed"), 110);
  EXPECT_NEAR(written.at("interval").at(0).get<double>(), 0.04900469, 1e-7);
}

TEST(Results, OfADeathHaveNoTime) {
  Results results = example_results(1, 101);
  results.kinds[0].at_s = results.outcomes[1].at_s = results.failure->at_s =
      std::numeric_limits<double>::quiet_NaN();
  const std::string text = to_json(results);
  EXPECT_TRUE(json::parse(text).at("failure").at("at_s").is_null());
  const Result<Results> back = parse_results(text);
  ASSERT_TRUE(back) << back.problem();
  EXPECT_EQ(to_json(*back), text);
  EXPECT_NE(to_table(*back).find("\n    blind\n"), std::string::npos) << to_table(*back);
}

TEST(Results, OfOtherFilesAndNonsenseAreRefused) {
  for (const char* text : {"", "{", "[]", "null", "7", "\"x\"", "{}", R"({"tessera": 3})",
                           R"({"tessera": "net"})", R"({"tessera": "schedules"})", "\x01\xff\xfe"})
    EXPECT_FALSE(parse_results(text)) << text;
}

TEST(Results, ThatContradictThemselvesAreRefused) {
  const json good = json::parse(to_json(example_results(1, 101)));
  struct Case {
    const char* where;
    json value;
    const char* says;
  };
  for (const Case& one :
       {Case{"/version", 2, "another version"}, Case{"/tried", 99, "not that of the seeds"},
        Case{"/tried", -1, "natural number"}, Case{"/tried", 1.5, "natural number"},
        Case{"/failed", 101, "more runs failed"}, Case{"/failure", nullptr, "first failure"},
        Case{"/ran", json::array({{1, 51}, {50, 100}}), "twice"},
        Case{"/ran", json::array({{101, 1}}), "before they begin"},
        Case{"/seeds", {1, 50}, "none of the whole"}, Case{"/parts", 0, "no parts"},
        Case{"/simulated_s", -3, "from 0 up"}, Case{"/kinds/0/runs", 101, "more runs than there were"},
        Case{"/kinds/0/failed", 11, "more runs than there were"}}) {
    json wrong = good;
    wrong[json::json_pointer(one.where)] = one.value;
    const Result<Results> read = parse_results(wrong.dump());
    ASSERT_FALSE(read) << one.where;
    EXPECT_NE(read.problem().find(one.says), std::string::npos) << one.where << ": " << read.problem();
  }
}

TEST(Table, NamesWhatHappenedWithIntervalsAndCommands) {
  const std::string table = to_table(example_results(101, 201));
  for (const char* part :
       {"100 of 300 schedules from seed 1 on (seeds 101 to 200), 10 fail", "4.9 % to 17.6 %", "assertion",
        "robot.control", "0.250000 s: blind", "each at most 3.62 %): deadlock\n",
        "\n  nobody touches                         0       0 %   0 % to 3.62 %                   -\n",
        "tessera simulate rover --interleave --for 1s --seed 110\n"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
}

TEST(Table, HasARowForEachCheckThatNeverFailed) {
  Results results = example_results(1, 10);
  results.outcomes.push_back({"assertion", "always: distance(robot[i], robot[i+1]) > 20 cm", 0, 0, 0, 0, ""});
  EXPECT_EQ(
      to_table(results),
      R"(9 of 300 schedules from seed 1 on (seeds 1 to 9), none fails (9.0 s simulated in 0.50 s, 5940 firings)
A run fails with a probability of 0 % to 33.6 % (95 % confidence).

                                      runs     share   95 % interval          first seed
assertion                                0       0 %   0 % to 33.6 %                   -
  nobody touches                         0       0 %   0 % to 33.6 %                   -
  always: distance(robot[i], robot[i+1]) > 20 cm
                                         0       0 %   0 % to 33.6 %                   -

In none of 9 runs (each at most 33.6 %): deadlock
)");
  const json written = json::parse(to_json(results));
  EXPECT_EQ(written.at("outcomes").at(1).at("interval").at(0), 0);
  EXPECT_NEAR(written.at("outcomes").at(1).at("interval").at(1).get<double>(), 0.3363, 1e-4);
}

TEST(Table, WarnsOfASeedThatGoesOtherwiseAlone) {
  Results results = example_results(1, 101);
  EXPECT_EQ(to_table(results).find("went otherwise"), std::string::npos);
  results.not_repeated = {10};
  EXPECT_NE(to_table(results).find("Seed 10 went otherwise"), std::string::npos);
}

TEST(Table, WarnsOfAFaultThatNoRunHad) {
  Results results = example_results(1, 10);
  results.injected = {{"robot.a:throw@any", 7, 2}, {"robot.b:throw@5s", 0, 8}, {"robot.c:throw@1s", 0, 0}};
  EXPECT_NE(to_table(results).find(
                "injected robot.a:throw@any: in 7 of 9 runs\n"
                "injected robot.b:throw@5s: in 0 of 9 runs (not known of 1)\n"
                "warning: robot.b:throw@5s has happened in no run: these figures do not show what this "
                "fault does.\n"
                "injected robot.c:throw@1s: in 0 of 9 runs (not known of 9)\n"
                "A run fails"),
            std::string::npos)
      << to_table(results);
  const Result<Results> back = parse_results(to_json(results));
  ASSERT_TRUE(back) << back.problem();
  EXPECT_EQ(to_json(*back), to_json(results));
  results.injected[0].missed = 3;
  EXPECT_FALSE(parse_results(to_json(results))) << "more than there were";
}

TEST(Table, WithoutRunsClaimsNothing) {
  const std::string table = to_table(example_results(1, 1));
  EXPECT_EQ(table.find('%'), std::string::npos) << table;
}

TEST(Table, OfAFaultThatFailsNoRunSaysSo) {
  Results results = example_results(1, 10);
  results.kinds[1] = {"deadlock", "", 4, 0, 2, 0.5, "late"};
  results.outcomes.push_back({"deadlock", "robot.a", 4, 0, 2, 0.5, "late"});
  const std::string table = to_table(results);
  EXPECT_NE(table.find("none of these runs failed"), std::string::npos) << table;
  EXPECT_NE(table.find("none fails"), std::string::npos) << table;
}

}  // namespace
}  // namespace tessera::statistics
