#include <algorithm>
#include <map>

#include "command.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli_test {

using VerificationGate = Command;

/// Two agents that send to each other and wait for the acknowledgement before they listen; the first may end.
constexpr const char* stuck =
    "tessera: 1\nsystem: s\ntypes: { V: { v: float64 } }\nagents:\n"
    "  a: { control: { rate: 10 Hz, inputs: { x: V }, outputs: { y: V },\n"
    "                  behaviours: { go: { terminal: in.x.v > 100, next: again }, again: {} } } }\n"
    "  b: { control: { rate: 10 Hz, inputs: { x: V }, outputs: { y: V }, behaviours: { go: {} } } }\n"
    "channels:\n"
    "  - { from: a.control.y, to: b.control.x, send: blocking, receive: blocking }\n"
    "  - { from: b.control.y, to: a.control.x, send: blocking, receive: blocking }\n";

/// A consumer that may leave for a behaviour in which it does not listen.
constexpr const char* leaves =
    "tessera: 1\nsystem: s\ntypes: { V: { v: float64 } }\nagents:\n"
    "  a: { control: { rate: 10 Hz, outputs: { y: V }, behaviours: { go: {} } } }\n"
    "  b: { control: { rate: 10 Hz, inputs: { x: V },\n"
    "                  behaviours: { go: { terminal: in.x.v > 100, next: rest }, rest: { receive: [] } } } "
    "}\n"
    "channels:\n"
    "  - { from: a.control.y, to: b.control.x, send: blocking, receive: blocking }\n";

TEST_F(VerificationGate, AViolatedNetIsRefusedWithTheRunAndAWayOn) {
  write(folder_ / "p/spec.yaml", stuck);
  for (const char* command : {"generate p", "simulate p", "run p"}) {
    SCOPED_TRACE(command);
    const project::Exit done = tessera(command);
    EXPECT_EQ(done.code, 1);
    for (const char* part :
         {"deadlock_free: violated", "a.control waits for the acknowledgement of a.control.y->b.control.x",
          "a run of 11 firings shows it",
          "no controller is made of a net that violates deadlock_free, goes_on", "tessera verify p",
          "--accept-violations"})
      EXPECT_NE(done.text.find(part), std::string::npos) << part << "\n" << done.text;
  }
  EXPECT_FALSE(fs::exists(folder_ / "p/.tessera/generated"));
}

TEST_F(VerificationGate, AnAcceptedViolationIsWrittenIntoTheController) {
  write(folder_ / "p/spec.yaml", stuck);
  const project::Exit done = tessera("generate p --accept-violations --stubs --json out.json");
  EXPECT_EQ(done.code, 0) << done.text;
  EXPECT_NE(done.text.find("warning: deadlock_free, goes_on"), std::string::npos) << done.text;
  const auto result = nlohmann::json::parse(content_of(folder_ / "out.json"));
  EXPECT_EQ(result.at("verdicts").at("goes_on"), "violated");
  EXPECT_EQ(result.at("verdicts").at("safe"), "holds");
  const std::string system = content_of(folder_ / "p/.tessera/generated/system.cpp");
  EXPECT_NE(system.find("{\"goes_on\", \"violated\""), std::string::npos) << system;
  EXPECT_NE(system.find(result.at("verification_hash").get<std::string>()), std::string::npos);
}

TEST_F(VerificationGate, ADeploymentIsJudgedAndMadeIntoOneController) {
  constexpr const char* deployed =
      "tessera: 1\nsystem: s\ntypes: { V: { v: float64 } }\nagents:\n"
      "  a: { control: { rate: 10 Hz, outputs: { y: V }, behaviours: { go: {} } } }\n"
      "  b: { control: { rate: 10 Hz, inputs: { x: V }, behaviours: { go: {} } } }\n"
      "channels:\n"
      "  - { from: a.control.y, to: b.control.x, receive: blocking }\n"
      "deploy: { processes: { left: a, right: b } }\n";
  write(folder_ / "p/spec.yaml", deployed);
  const project::Exit judged = tessera("verify p");
  EXPECT_EQ(judged.code, 0) << "survives_partition is a warning\n" << judged.text;
  for (const char* part : {"goes_on: holds", "warning: survives_partition: violated",
                           "and the network is cut", "receive_timeout on line 8"})
    EXPECT_NE(judged.text.find(part), std::string::npos) << part << "\n" << judged.text;
  const project::Exit made = tessera("generate p --stubs");
  EXPECT_EQ(made.code, 0) << made.text;
  const std::string system = content_of(folder_ / "p/.tessera/generated/system.cpp");
  for (const char* part :
       {"{\"survives_partition\", \"violated\"", "tessera::Step::replace, ", "{\"right\", \"\", \"\"}",
        "process_of[] = {0, 1}", ".domain = 0", ".liveliness = 900ms"})
    EXPECT_NE(system.find(part), std::string::npos) << part << "\n" << system;
  EXPECT_EQ(tessera("verify p --scenario out.json").code, 1);
}

TEST_F(VerificationGate, VerdictsAreKeptUntilWhatTheyDependOnChanges) {
  const fs::path project = example("01_line_follower");
  const auto kept = [&] {
    std::map<fs::path, fs::file_time_type> files;
    for (const auto& entry : fs::directory_iterator(user_ / "tessera/verdicts"))
      files[entry.path()] = fs::last_write_time(entry.path());
    return files;
  };
  ASSERT_EQ(tessera("generate 01_line_follower").code, 0);
  const auto first = kept();
  EXPECT_EQ(first.size(), 1U);
  replace(project / "spec.yaml", "0.2 m/s", "0.3 m/s");  // a parameter: the net is the same
  ASSERT_EQ(tessera("generate 01_line_follower").code, 0);
  EXPECT_EQ(kept(), first);
  replace(project / "spec.yaml", "terminal: true, ", "terminal: in.line.fresh, ");
  ASSERT_EQ(tessera("generate 01_line_follower").code, 0);
  EXPECT_EQ(kept().size(), 2U);
}

TEST_F(VerificationGate, KeptVerdictsThatAreDamagedAreMadeAgain) {
  write(folder_ / "p/spec.yaml", stuck);
  ASSERT_EQ(tessera("generate p").code, 1);
  for (const auto& entry : fs::directory_iterator(user_ / "tessera/verdicts"))
    write(entry.path(), "{\"properties\": []");
  EXPECT_NE(tessera("generate p").text.find("deadlock_free: violated"), std::string::npos);
}

/// A net that deadlocks, in a project that comes with a verdict of its own: that it does not.
TEST_F(VerificationGate, VerdictsThatComeWithAProjectAreNotBelieved) {
  write(folder_ / "p/spec.yaml", stuck);
  ASSERT_EQ(tessera("generate p").code, 1);
  const fs::path kept = fs::directory_iterator(user_ / "tessera/verdicts")->path();
  auto forged = nlohmann::json::parse(content_of(kept));
  for (auto& property : forged.at("properties")) property["verdict"] = 0;
  const std::string name = kept.filename().string();
  fs::remove(kept);
  for (const char* const place : {"p/.tessera/verdicts", "p/verdicts", "p/.tessera"})
    write(folder_ / place / name, forged.dump());
  const project::Exit done = tessera("generate p --stubs");
  EXPECT_EQ(done.code, 1) << done.text;
  EXPECT_NE(done.text.find("deadlock_free: violated"), std::string::npos) << done.text;
  EXPECT_FALSE(fs::exists(folder_ / "p/.tessera/generated"));

  // In the folder of the user it counts only if nobody else can have written it.
  write(kept, forged.dump());
  fs::permissions(kept, fs::perms::others_write, fs::perm_options::add);
  EXPECT_EQ(tessera("generate p --stubs").code, 1);
}

/// The marked part of the net after the firings of a recording, in the form of a viewer's trace.
std::vector<std::string> marked_after(const nlohmann::json& traces, const nlohmann::json& firings) {
  std::map<std::string, int> tokens;
  for (const auto& place : traces.at("initial")) ++tokens[place.get<std::string>()];
  for (const auto& firing : firings) {
    for (const auto& place : firing.at("takes")) EXPECT_GE(--tokens[place.get<std::string>()], 0) << firing;
    for (const auto& place : firing.at("gives")) ++tokens[place.get<std::string>()];
  }
  std::vector<std::string> marked;
  for (const auto& [place, count] : tokens)
    if (count > 0) marked.push_back(place);
  return marked;
}

TEST_F(VerificationGate, ATraceIsCompleteForAViewerThatSteps) {
  write(folder_ / "p/spec.yaml", stuck);
  EXPECT_EQ(tessera("verify p --trace run.json").code, 1);
  const auto run = nlohmann::json::parse(content_of(folder_ / "run.json"));
  EXPECT_EQ(run.at("net_hash").get<std::string>().size(), 32U);
  ASSERT_FALSE(run.at("traces").empty());
  for (const auto& trace : run.at("traces")) {
    auto end = trace.at("end").get<std::vector<std::string>>();
    std::ranges::sort(end);
    EXPECT_EQ(marked_after(run, trace.at("firings")), end) << trace.at("property");
    EXPECT_EQ(trace.at("story").back().at("last"), trace.at("firings").size());
  }
  const auto& last = run.at("traces")[0].at("firings").back();
  EXPECT_EQ(last.at("page"), last.at("subsystem").get<std::string>() + ".go.snd");
  EXPECT_GT(last.at("line"), 0);
}

TEST_F(VerificationGate, AScenarioDrivesTheControllerIntoTheMarkingOfItsRun) {
  write(folder_ / "p/spec.yaml", leaves);
  const project::Exit verified =
      tessera("verify p --property goes_on --trace run.json --scenario stuck.json");
  EXPECT_EQ(verified.code, 1);
  EXPECT_NE(verified.text.find("tessera simulate p --scenario stuck.json"), std::string::npos)
      << verified.text;
  const auto traces = nlohmann::json::parse(content_of(folder_ / "run.json"));
  ASSERT_EQ(tessera("generate p --accept-violations --stubs").code, 0);
  const project::Exit done = tessera("simulate p --scenario stuck.json --for 2s --record run.tsr");
  EXPECT_EQ(done.code, 1) << done.text;
  EXPECT_NE(done.text.find("(forced: terminal)"), std::string::npos) << done.text;
  EXPECT_NE(done.text.find("stuck since the scenario: a.control at go.snd.y.wait waits for b.control"),
            std::string::npos)
      << done.text;

  std::string error;
  const auto recording = read_recording((folder_ / "run.tsr").string(), error);
  ASSERT_TRUE(recording) << error;
  EXPECT_NE(recording->header.find(R"({"name":"goes_on","verdict":"violated")"), std::string::npos);
  const auto& trace = traces.at("traces")[0];
  std::map<std::string, nlohmann::json> by_name;
  for (const auto& firing : trace.at("firings")) by_name[firing.at("transition")] = firing;
  nlohmann::json fired = nlohmann::json::array();
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() != Event::Kind::firing || fired.size() == trace.at("firings").size()) continue;
    const std::string name = recording->transitions[entry.event.subject].name;
    ASSERT_TRUE(by_name.contains(name)) << name;
    fired.push_back(by_name[name]);
  }
  auto end = trace.at("end").get<std::vector<std::string>>();
  std::ranges::sort(end);
  EXPECT_EQ(marked_after(traces, fired), end);
}

TEST_F(VerificationGate, WithoutAViolationThereIsNoScenario) {
  const std::string spec = std::string(TESSERA_SOURCE_DIR) + "/examples/01_line_follower/spec.yaml";
  const project::Exit done = tessera("verify " + spec + " --scenario none.json");
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.text.find("no property is violated by a run"), std::string::npos) << done.text;
  EXPECT_FALSE(fs::exists(folder_ / "none.json"));
}

}  // namespace tessera::cli_test
