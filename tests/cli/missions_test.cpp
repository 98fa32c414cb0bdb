// How long missions take and what they use, held against closed forms.
#include <cmath>

#include "command.hpp"

namespace tessera::cli_test {

using Missions = Command;

/// A normal stage (mean 2 s, deviation 0.3 s, cut off far away), and a uniform one from 8 to 12 s.
constexpr const char* two_stages = R"(tessera: 1
system: mission
agents:
  robot:
    control:
      behaviours:
        plan: { takes: { normal: [2 s, 0.3 s], within: 0.5..3.5 s }, uses: { energy: 5 W }, terminal: true, next: drive }
        drive: { takes: 8..12 s, uses: { energy: 80 W, brushes: 2 /h }, terminal: true }
)";

constexpr const char* functions = R"(#include "robot/control.hpp"
namespace mission::robot::control {
void plan(Context&, const Inputs&, Memory&, Outputs&) {}
void drive(Context&, const Inputs&, Memory&, Outputs&) {}
}
)";

struct Moments {
  std::uint64_t runs;
  double mean, variance;
};

Moments moments_of(const nlohmann::json& results, const std::string& name) {
  for (const nlohmann::json& one : results.at("distributions"))
    if (one.at("name") == name) {
      const auto runs = one.at("runs").get<std::uint64_t>();
      const double count = static_cast<double>(runs), mean = one.at("sum").get<double>() / count;
      return {runs, mean, one.at("sum_of_squares").get<double>() / count - mean * mean};
    }
  ADD_FAILURE() << "no " << name << " in " << results;
  return {};
}

/// Fewer than one of ten thousand normally distributed estimates is so far off.
constexpr double far = 4;

TEST_F(Missions, HaveTheMeanAndVarianceOfTheirStages) {
  write(folder_ / "mission/spec.yaml", two_stages);
  write(folder_ / "mission/src/robot.cpp", functions);
  const nlohmann::json all = json("schedules 4000 mission --for 60s");
  EXPECT_EQ(all.at("failed"), 0);
  EXPECT_EQ(all.at("ended_by_themselves"), 4000);
  const double normal = 0.3 * 0.3, uniform = 4.0 * 4.0 / 12;
  // The fourth central moments of the stages give the deviation of the estimated variance.
  const double fourth = 3 * normal * normal + 6 * normal * uniform + std::pow(4.0, 4) / 80;
  const Moments time = moments_of(all, "time");
  const double runs = static_cast<double>(time.runs), variance = normal + uniform;
  EXPECT_EQ(time.runs, 4000U);
  EXPECT_NEAR(time.mean, 12, far * std::sqrt(variance / runs));
  EXPECT_NEAR(time.variance, variance, far * std::sqrt((fourth - variance * variance) / runs));
  const Moments energy = moments_of(all, "energy");
  const double energy_variance = 25 * normal + 6400 * uniform;
  EXPECT_NEAR(energy.mean, 5 * 2 + 80 * 10, far * std::sqrt(energy_variance / runs));
  EXPECT_NEAR(energy.variance, energy_variance, 0.1 * energy_variance);
  EXPECT_NEAR(moments_of(all, "brushes").mean, 10.0 * 2 / 3600, 1e-4);

  // Later than 12 s: half of them, since both stages are symmetric.
  const nlohmann::json late = json("schedules 1000 mission --for 12s");
  EXPECT_NEAR(late.at("ended_by_themselves").get<double>(), 500, far * std::sqrt(1000 * 0.25));
  const project::Exit table = tessera("schedules 1000 mission --for 12s");
  EXPECT_NE(table.text.find(" of 1000 runs ended by themselves within 12s; the others: "), std::string::npos)
      << table.text;
  EXPECT_NE(table.text.find("90 % of the runs at most"), std::string::npos) << table.text;

  // One run tells the same as its summary, and the same again.
  const nlohmann::json one = json("simulate mission --for 60s --seed 7");
  const nlohmann::json& used = one.at("used").at(0);
  EXPECT_EQ(used.at("resource"), "energy");
  EXPECT_EQ(used.at("unit"), "J");
  const double taken = one.at("simulated_s").get<double>();
  EXPECT_GT(used.at("amount").get<double>(), 80 * (taken - 3.5));
  EXPECT_LT(used.at("amount").get<double>(), 80 * taken);
  EXPECT_EQ(used.at("agents").at("robot"), used.at("amount"));
  EXPECT_EQ(json("simulate mission --for 60s --seed 7").at("used"), one.at("used"));
}

TEST_F(Missions, ChecksBoundWhatTheyUse) {
  const std::string check = "simulation: { checks: [{ name: battery, at_most: { energy: 0.81 kJ } }] }\n";
  write(folder_ / "mission/spec.yaml", two_stages + check);
  write(folder_ / "mission/src/robot.cpp", functions);
  // Half of them use more than the mean, since both stages are symmetric. Yet all of them count in the distribution.
  const nlohmann::json all = json("schedules 1000 mission --for 60s", 1);
  const auto failed = all.at("failed").get<std::uint64_t>();
  EXPECT_NEAR(static_cast<double>(failed), 500, far * std::sqrt(1000 * 0.25));
  EXPECT_EQ(all.at("ended_by_themselves"), 1000);
  EXPECT_EQ(all.at("ended_with_failed_check"), failed);
  EXPECT_EQ(moments_of(all, "energy").runs, 1000U);
  EXPECT_EQ(moments_of(all, "time").runs, 1000U);
  for (const nlohmann::json& outcome : all.at("outcomes"))
    if (outcome.at("name") == "battery") EXPECT_EQ(outcome.at("runs"), failed);
  const project::Exit table = tessera("schedules 300 mission --for 60s");
  EXPECT_NE(table.text.find("300 of 300 runs ended by themselves within 60s; the others: 0 %"),
            std::string::npos)
      << table.text;
  EXPECT_NE(table.text.find("of which 0 failed"), std::string::npos) << table.text;

  // Runs that use up their duration have not ended by themselves, also where the check fails.
  const nlohmann::json late = json("schedules 300 mission --for 12s", 1);
  EXPECT_EQ(moments_of(late, "energy").runs, 300U);
  EXPECT_LT(late.at("ended_by_themselves").get<int>(), 200);

  const std::uint64_t seed = all.at("failure").at("seed");
  const nlohmann::json one = json("simulate mission --for 60s --seed " + std::to_string(seed), 1);
  const nlohmann::json& judged = one.at("checks").at(0);
  EXPECT_EQ(judged.at("name"), "battery");
  EXPECT_EQ(judged.at("text"), "at_most: energy 810 J");
  EXPECT_EQ(judged.at("verdict"), "failed");
  EXPECT_NE(one.at("ended").get<std::string>().find("; a check failed: battery"), std::string::npos) << one;

  write(folder_ / "mission/spec.yaml",
        two_stages +
            std::string(
                "simulation: { checks: [{ at_most: { energy: 5 kJ } }, { at_most: { brushes: 1 } }] }\n"));
  const project::Exit kept = tessera("simulate mission --for 60s");
  EXPECT_EQ(kept.code, 0) << kept.text;
  EXPECT_NE(kept.text.find("check at_most energy: held"), std::string::npos) << kept.text;
  EXPECT_NE(kept.text.find("check at_most brushes: held"), std::string::npos) << kept.text;
}

}  // namespace tessera::cli_test
