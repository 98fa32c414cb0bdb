// `tessera replay --takes`: the times of calls become an edit of the specification.
#include "../spec/spec_reading.hpp"
#include "cli/recordings/learned_takes.hpp"
#include "cli/recordings/overtime.hpp"
#include "command.hpp"

namespace tessera::cli_test {
namespace {

constexpr std::int64_t us = 1'000, ms = 1'000'000;

std::string takes_of(std::int64_t shortest, std::int64_t longest) {
  return cli::takes_text(shortest, longest);
}

TEST(LearnedTakes, AreRoundedOutwardsToTwoDigits) {
  EXPECT_EQ(takes_of(1'949 * us, 7'211 * us), "1.9..7.3 ms");
  EXPECT_EQ(takes_of(0, 1), "0..1 ns");
  EXPECT_EQ(takes_of(850, 3 * ms), "850 ns..3 ms");
  EXPECT_EQ(takes_of(5 * ms, 5 * ms), "5 ms");
  EXPECT_EQ(takes_of(99'900 * us, 999 * ms), "99 ms..1 s");
  EXPECT_EQ(takes_of(2'000 * ms, 12'340 * ms), "2..13 s");
}

replay::CallDurations calls(std::uint64_t count, std::int64_t least, std::int64_t most) {
  return {count, 0, least, most, 0};
}

/// A fleet, with comments and a map in one line.
constexpr const char* system_text = R"(tessera: 1
system: demo
agents:
  robot:
    count: 2
    control:
      rate: 20 Hz
      behaviours:
        init: { terminal: true, next: follow }   # once
        follow:                                  # the work
          takes: 2..8 ms                         # measured in May
        dock: {}
)";

TEST(LearnedTakes, ChangeTheSpecificationAndKeepItsComments) {
  const std::string text = system_text;
  const spec::Reading reading(text);
  ASSERT_TRUE(reading.model) << reading.report();
  const replay::DurationsOfBehaviours measured{
      {{"robot[0].control", "init"}, calls(1, 3 * ms, 3 * ms)},
      {{"robot[0].control", "follow"}, calls(500, 3 * ms, 7 * ms)},
      {{"robot[1].control", "follow"}, calls(600, 4 * ms, 10 * ms)},
  };
  const std::vector<cli::LearnedTakes> all = cli::learned_takes(*reading.model, measured, 0.2);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].text, "2.4..3.6 ms");
  EXPECT_EQ(all[1].text, "2..12 ms");  // the shortest holds, the longest does not
  EXPECT_EQ(all[1].measured.count, 1100U);
  EXPECT_EQ(all[1].names, std::vector<std::string>{"robot[].control.follow"});
  EXPECT_EQ(all[2].text, "");
  const std::string table = cli::takes_table(all);
  EXPECT_NE(
      table.find("robot[].control.init: 1 call, 3 ms to 3 ms: takes: 2.4..3.6 ms\n  fewer than 100 calls"),
      std::string::npos)
      << table;
  EXPECT_NE(
      table.find("robot[].control.follow: 1100 calls, 3 ms to 10 ms: takes: 2..12 ms (now takes: 2..8 ms)"),
      std::string::npos)
      << table;
  EXPECT_NE(table.find("never called, so nothing is known: robot[].control.dock"), std::string::npos)
      << table;
  const cli::TakesEdit edit = cli::with_takes(diagnostics::Diagnostics("spec.yaml", text), all);
  EXPECT_EQ(edit.problem, "");
  EXPECT_TRUE(edit.elsewhere.empty());
  std::string expected = text;
  expected.replace(expected.find("next: follow }"), 14, "next: follow, takes: 2.4..3.6 ms }");
  expected.replace(expected.find("2..8 ms"), 7, "2..12 ms");
  // The edit may move a comment behind a line that has become longer, and changes nothing else.
  const auto without_blanks = [](std::string from) {
    std::erase(from, ' ');
    return from;
  };
  ASSERT_EQ(edit.files.size(), 1U);
  EXPECT_EQ(without_blanks(edit.files[0].after), without_blanks(expected));
  const spec::Reading again(edit.files[0].after);
  EXPECT_TRUE(again.model) << again.report();
}

TEST(LearnedTakes, ThatAreDeclaredStayIfAllCallsAreWithinThem) {
  const std::string text = system_text;
  const spec::Reading reading(text);
  ASSERT_TRUE(reading.model) << reading.report();
  const std::vector<cli::LearnedTakes> all =
      cli::learned_takes(*reading.model, {{{"robot[0].control", "follow"}, calls(500, 2 * ms, 8 * ms)}}, 0.2);
  EXPECT_EQ(all.at(1).text, "");
  EXPECT_NE(cli::takes_table(all).find("within takes: 2..8 ms"), std::string::npos) << cli::takes_table(all);
  EXPECT_EQ(cli::with_takes(diagnostics::Diagnostics("spec.yaml", text), all).files.at(0).after, text);
}

}  // namespace

using TakesOfRuns = Command;

TEST_F(TakesOfRuns, AreProposedAndWrittenAndASimulatedRunTeachesNothing) {
  const fs::path project = built_example("01_line_follower");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 5s --record run.tsr").code, 0);
  const project::Exit nothing = tessera("replay run.tsr --takes --spec 01_line_follower");
  EXPECT_EQ(nothing.code, 1);
  EXPECT_NE(nothing.text.find("a simulated run"), std::string::npos) << nothing.text;

  ASSERT_EQ(tessera("run 01_line_follower --world --for 1s --record real.tsr").code, 0);
  const std::string before = content_of(project / "spec.yaml");
  const nlohmann::json told = json("replay real.tsr --takes --spec 01_line_follower --margin 50");
  EXPECT_EQ(told.at("margin_percent"), 50);
  ASSERT_EQ(told.at("takes").size(), 4U);
  EXPECT_EQ(content_of(project / "spec.yaml"), before);
  const project::Exit written = tessera("replay real.tsr --takes --spec 01_line_follower --write");
  EXPECT_EQ(written.code, 0) << written.text;
  EXPECT_NE(written.text.find("margin: 20 %"), std::string::npos) << written.text;
  const std::string after = content_of(project / "spec.yaml");
  EXPECT_NE(after.find("watch: { takes: "), std::string::npos) << after;
  EXPECT_NE(after.find("# reflected light"), std::string::npos) << after;
  const project::Exit again = tessera("replay real.tsr --takes --spec 01_line_follower");
  EXPECT_EQ(again.code, 0) << again.text;
  EXPECT_NE(again.text.find("nothing to change"), std::string::npos) << again.text;
  EXPECT_EQ(tessera("replay real.tsr --takes --margin 100 --spec 01_line_follower").code, 2);

  // Behaviours of an included file get theirs there.
  const std::size_t agents = before.find("agents:\n"), channels = before.find("\nchannels:");
  std::string agent = before.substr(agents, channels - agents);
  agent.replace(0, agent.find("robot:"), "templates:\n  ");
  fs::create_directory(project / "parts");
  write(project / "parts/robot.yaml", agent);
  const std::string whole = "include: parts/robot.yaml\n" + before.substr(0, agents) +
                            "agents: { robot: { use: robot } }\n" + before.substr(channels);
  write(project / "spec.yaml", whole);
  fs::rename(project / "parts/robot.yaml", project / "parts/elsewhere.yaml");
  fs::create_symlink("elsewhere.yaml", project / "parts/robot.yaml");
  const project::Exit refused = tessera("replay real.tsr --takes --spec 01_line_follower --write");
  EXPECT_EQ(refused.code, 1) << refused.text;
  EXPECT_NE(refused.text.find("nothing was changed: "), std::string::npos) << refused.text;
  EXPECT_EQ(content_of(project / "parts/elsewhere.yaml"), agent);
  fs::rename(project / "parts/elsewhere.yaml", project / "parts/robot.yaml");
  const project::Exit there = tessera("replay real.tsr --takes --spec 01_line_follower --write");
  EXPECT_EQ(there.code, 0) << there.text;
  EXPECT_NE(there.text.find("parts/robot.yaml"), std::string::npos) << there.text;
  EXPECT_EQ(content_of(project / "spec.yaml"), whole);
  EXPECT_NE(content_of(project / "parts/robot.yaml").find("watch: { takes: "), std::string::npos);
  EXPECT_NE(tessera("verify 01_line_follower").text.find("reaction at most "), std::string::npos);
}

/// The recording of a simulated run, told as one of a real run.
void make_real(const fs::path& file) {
  std::string bytes = content_of(file);
  const std::string simulated = R"("clock":"simulated")";
  const std::size_t at = bytes.find(simulated);
  ASSERT_NE(at, std::string::npos);
  write(file, bytes.replace(at, simulated.size(), R"("clock":"steady"   )"));
}

TEST_F(TakesOfRuns, ASlowCallIsInTheProposal) {
  built_example("01_line_follower");
  ASSERT_EQ(
      tessera("simulate 01_line_follower --for 5s --inject robot.control:stall=30ms@1s --record run.tsr")
          .code,
      0);
  make_real(folder_ / "run.tsr");
  const nlohmann::json told = json("replay run.tsr --takes --spec 01_line_follower");
  for (const nlohmann::json& one : told.at("takes"))
    if (one.at("behaviours").at(0) == "robot.control.follow") {
      EXPECT_EQ(one.at("most_ns"), 30 * ms);
      EXPECT_EQ(one.at("proposed").at("text"), "0..36 ms");
    }
}

TEST(Overtime, OfASummaryIsToldPerBehaviourAndOnceForAllThreads) {
  const nlohmann::json summary = nlohmann::json::parse(R"({
    "subsystems": [{"path": "robot.control", "late_wakeups": 1, "latest_wakeup_s": 0.0002},
                   {"path": "robot.motor", "late_wakeups": 2, "latest_wakeup_s": 0.001204}],
    "overtime": [{"behaviour": "robot.control.follow", "calls": 500, "slow": 3, "declared_ns": 8000000,
                  "longest_ns": 30000000, "longest_at_ns": 1500000000}]})");
  EXPECT_EQ(
      cli::overtime_text(summary, cli::slow_calls_of(summary)),
      "overtime: robot.control.follow: 3 of 500 calls took longer than its takes of 8 ms; the longest took "
      "30.000 ms, at 1.500 s\n"
      "threads went on at most 1.204 ms late (robot.motor); later than the latency: 3 times\n");
  const nlohmann::json simulated = nlohmann::json::parse(R"({"subsystems": [{"path": "a.b"}]})");
  EXPECT_EQ(cli::overtime_text(simulated, cli::slow_calls_of(simulated)), "");
}

TEST_F(TakesOfRuns, AreDrawnAsTheyWereMeasured) {
  const fs::path project = built_example("01_line_follower");
  ASSERT_EQ(
      tessera("simulate 01_line_follower --for 10s --inject robot.control:stall=30ms@1s --record run.tsr")
          .code,
      0);
  const std::string text = content_of(project / "spec.yaml");
  const auto check_with = [&](const std::string& takes) {
    std::string changed = text;
    changed.replace(changed.find("follow: {}"), 10, "follow: { takes: " + takes + " }");
    write(project / "spec.yaml", changed);
    return tessera("check 01_line_follower");
  };
  const auto says = [](const project::Exit& done, const std::string& what) {
    EXPECT_NE(done.text.find(what), std::string::npos) << done.text;
  };
  says(check_with("{ measured: ../none.tsr, within: 0..40 ms }"),
       "error E385: no times can be read from '../none.tsr'");
  const project::Exit simulated = check_with("{ measured: ../run.tsr, within: 0..40 ms }");
  EXPECT_EQ(simulated.code, 1);
  says(simulated, "it is of a simulated run");
  make_real(folder_ / "run.tsr");
  const project::Exit good = check_with("{ measured: ../run.tsr, within: 0..40 ms }");
  EXPECT_EQ(good.code, 0) << good.text;
  const project::Exit narrow = check_with("{ measured: ../run.tsr, within: 0..20 ms }");
  EXPECT_EQ(narrow.code, 1);
  says(narrow, " calls in '../run.tsr' are not within 0..20 ms: they took 0..30 ms");
  says(narrow, "hint: for example within: 0..36 ms, which is 20 % wider");
  says(check_with("{ measured: ../run.tsr }"), "'takes' lacks 'within', the bounds of all calls; the ");
  // Its bounds change, the distribution stays.
  std::string bounds = text;
  bounds.replace(bounds.find("follow: {}"), 10,
                 "follow: { takes: { normal: [5 ms, 1 ms], within: 4..6 ms } }");
  write(project / "spec.yaml", bounds);
  EXPECT_EQ(tessera("replay run.tsr --takes --spec 01_line_follower --write").code, 0);
  says({0, content_of(project / "spec.yaml")}, "takes: { normal: [5 ms, 1 ms], within: 0..36 ms }");
}

}  // namespace tessera::cli_test
