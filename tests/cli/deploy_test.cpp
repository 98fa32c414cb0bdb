#include "deploy.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <csignal>

#include "../schema/judge.hpp"
#include "cli/recordings/legality_check.hpp"
#include "tessera/process_claim.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli_test {
namespace {

constexpr const char* checked = "replay 11_crossing_apart/.tessera/last --check";

TEST_F(Deploy, ProcessesRunTogetherAndTheirRecordingsAreOneLegalRun) {
  const project::Exit alone = tessera("run 11_crossing_apart --for 1s");
  EXPECT_EQ(alone.code, 1);
  EXPECT_NE(alone.text.find("`--deploy` starts those of this machine"), std::string::npos) << alone.text;
  const project::Exit unknown = tessera("run 11_crossing_apart --deploy --only rover[0],gat");
  EXPECT_NE(unknown.text.find("has no process 'gat'; did you mean 'gate'?"), std::string::npos)
      << unknown.text;

  const project::Exit run = tessera("run 11_crossing_apart --deploy --for 3s --mcap bags" + domain_);
  EXPECT_EQ(run.code, 0) << run.text;
  EXPECT_NE(run.text.find("rover[1] | "), std::string::npos) << run.text;
  EXPECT_NE(run.text.find("ended: duration"), std::string::npos) << run.text;
  EXPECT_FALSE(any_is_left());
  const project::Exit joint = tessera(checked);
  EXPECT_EQ(joint.code, 0) << joint.text;
  EXPECT_NE(joint.text.find("in 3 recordings"), std::string::npos) << joint.text;
  EXPECT_NE(run.text.find("bags in bags"), std::string::npos) << run.text;
  const project::Exit bags = tessera("replay --check bags --spec 11_crossing_apart");
  EXPECT_EQ(bags.code, 0) << bags.text;
  EXPECT_NE(bags.text.find("in 3 recordings"), std::string::npos) << bags.text;
  EXPECT_TRUE(fs::exists(folder_ / "bags/process-rover[1].mcap"));

  const std::string last = "11_crossing_apart/.tessera/last/process-";
  const project::Exit part = tessera("replay --check '" + last + "gate.tsr' '" + last + "rover[0].tsr'");
  EXPECT_EQ(part.code, 3) << part.text;
  EXPECT_NE(part.text.find("no recording of rover[1] is given"), std::string::npos) << part.text;
  const project::Exit twice = tessera("replay --check '" + last + "gate.tsr' '" + last + "gate.tsr'");
  EXPECT_EQ(twice.code, 1);
  EXPECT_NE(twice.text.find("two of them are of 'gate'"), std::string::npos) << twice.text;
}

TEST_F(Deploy, OneThatIsKilledIsToldOfAndStopsTheOthersOrStartsAgain) {
  const project::Exit stopped = run_and_kill(" --for 60s");
  EXPECT_EQ(stopped.code, 1) << stopped.text;
  EXPECT_NE(stopped.text.find("rover[0]: the controller was killed by SIGKILL"), std::string::npos)
      << stopped.text;
  EXPECT_NE(stopped.text.find("ended: SIGTERM"), std::string::npos) << stopped.text;
  EXPECT_FALSE(any_is_left());
  const project::Exit cut = tessera(checked);
  EXPECT_EQ(cut.code, 3) << cut.text;
  EXPECT_NE(cut.text.find("the recording of rover[0] is cut off at its end"), std::string::npos) << cut.text;

  const project::Exit again = run_and_kill(" --for 20s --restart on-failure");
  EXPECT_EQ(again.code, 0) << again.text;
  EXPECT_NE(again.text.find("start 2 in 1.0 s"), std::string::npos) << again.text;
  EXPECT_NE(again.text.find("warning: survives_partition is violated"), std::string::npos) << again.text;
  EXPECT_TRUE(fs::exists(project_ / ".tessera/last/process-rover[0]@2.tsr")) << again.text;
  EXPECT_FALSE(any_is_left());
  const project::Exit both = tessera(checked);
  EXPECT_EQ(both.code, 3) << both.text;
  EXPECT_NE(both.text.find("in 4 recordings"), std::string::npos) << both.text;
}

TEST_F(Deploy, WhatCannotRunIsRefusedBeforeAnythingStarts) {
  const auto refused = [&](const std::string& options, const std::string& why) {
    const project::Exit run = tessera("run 11_crossing_apart --deploy --for 1s" + options);
    EXPECT_EQ(run.code, 1) << options;
    EXPECT_NE(run.text.find(why), std::string::npos) << options << "\n" << run.text;
    EXPECT_EQ(run.text.find("recordings in"), std::string::npos) << run.text;
  };
  refused(" --domain 231", "--domain 231: expected a whole number from 0 to 230");
  refused(" --mcap 11_crossing_apart/spec.yaml" + domain_,
          "--mcap names a folder for the bags of all processes");
  refused(" --only ''", "--only names no process");
  refused(" --only 'rover[0] , gat'", "has no process 'gat'; did you mean 'gate'?");
  refused(" --interface nosuch0" + domain_, "nothing was recorded");
  const ProcessClaim claim(
      {.system = "crossroads", .process = "gate", .domain = std::stoi(domain_.substr(10))});
  refused(domain_, "process gate of crossroads runs on this machine already (number " +
                       std::to_string(getpid()) + "), in domain " + domain_.substr(10) + " on interface lo");
  const project::Exit alone = shell("'" + (project_ / ".tessera/build/release/controller").string() +
                                    "' run --process gate --for 1s" + domain_);
  EXPECT_EQ(alone.code, 1) << alone.text;
  EXPECT_NE(alone.text.find("process gate of crossroads runs on this machine already"), std::string::npos)
      << alone.text;
  const project::Exit cut =
      tessera("simulate 11_crossing_apart --for 1s --inject 'link:rover[0]-rover[1]:cut=1s@0s'");
  EXPECT_NE(
      cut.text.find("no channel joins rover[0]-rover[1]; there are the links gate-rover[0], gate-rover[1]"),
      std::string::npos)
      << cut.text;
}

/// The files that a robot gets, in a folder without other files, without the environment of this machine.
TEST_F(Deploy, PackagesRunWhereThereIsNothingElse) {
  for (const char* format : {"deb", "archive"})
    for (const char* folder : {"one", "two"}) {
      const project::Exit made =
          tessera(std::string("package 11_crossing_apart --set robot[0].control.speed=0.5 --format ") +
                  format + " --release 1.2 --output " + folder);
      ASSERT_EQ(made.code, 0) << made.text;
      EXPECT_NE(made.text.find("gate, rover[0], rover[1]"), std::string::npos) << made.text;
    }
  const std::string deb = "tessera-crossroads_1.2_$(dpkg --print-architecture).deb";
  const project::Exit same = shell("cmp one/" + deb + " two/" + deb + " && cmp one/*.gz two/*.gz");
  EXPECT_EQ(same.code, 0) << "the same bytes each time: " << same.text;
  ASSERT_EQ(shell("mkdir archive && tar -C archive -xf one/*.gz && dpkg-deb -x one/" + deb + " robot").code,
            0);
  EXPECT_EQ(shell("dpkg-deb -e one/" + deb + " control && ls control | sort | tr '\\n' ' '").text,
            "conffiles control prerm ");
  EXPECT_NE(content_of(folder_ / "control/control").find("libddsc0debian"), std::string::npos);
  EXPECT_NE(content_of(folder_ / "robot/usr/lib/systemd/system/crossroads-rover-0.service")
                .find("run --process \"rover[0]\" --parameters /opt/crossroads/parameters"),
            std::string::npos);
  for (const char* unpacked : {"robot/opt/crossroads", "archive/crossroads"})
    EXPECT_NE(content_of(folder_ / unpacked / "parameters").find("robot[0].control.speed = 0.5"),
              std::string::npos)
        << unpacked;

  fs::rename(kept(), folder_ / "away");  // so that no file of the project is found
  const std::string run =
      "for p in gate 'rover[0]' 'rover[1]'; do env -i LD_DEBUG=files LD_DEBUG_OUTPUT=\"$PWD/loaded\" "
      "robot/opt/crossroads/controller run --process $p --parameters robot/opt/crossroads/parameters --for "
      "3s "
      "--record $p.tsr" +
      domain_ + " & all=\"$all $!\"; done; for one in $all; do wait $one || exit 1; done";
  const project::Exit ran = shell(run);
  fs::rename(folder_ / "away", kept());
  EXPECT_EQ(ran.code, 0) << ran.text;
  EXPECT_EQ(shell("grep -ho 'calling init: .*libtessera_dds.so' loaded.* | sort -u").text,
            "calling init: " + (folder_ / "robot/opt/crossroads/libtessera_dds.so").string() + "\n");
  const project::Exit joint =
      tessera("replay --spec 11_crossing_apart --check gate.tsr 'rover[0].tsr' 'rover[1].tsr'");
  EXPECT_EQ(joint.code, 0) << joint.text;
}

TEST_F(Deploy, ASimulatedRunInWhichProcessesDieIsJudged) {
  const auto simulated = [&](const char* file) {
    return tessera(std::string("simulate 11_crossing_apart --for 12s --network loss=0.1 --record ") + file +
                   " --inject 'process:gate:restart=1s@3s' --inject 'process:rover[1]:restart=500ms@6s'");
  };
  const project::Exit run = simulated("once.tsr");
  EXPECT_NE(run.text.find("gate  warning: injected: the process begins again (start 2)"), std::string::npos)
      << run.text;
  static_cast<void>(simulated("again.tsr"));
  EXPECT_EQ(content_of(folder_ / "once.tsr"), content_of(folder_ / "again.tsr"));
  const project::Exit legal = tessera("replay --spec 11_crossing_apart --check once.tsr");
  EXPECT_EQ(legal.code, 0) << legal.text;
  const project::Exit events = tessera("replay --spec 11_crossing_apart --print once.tsr");
  EXPECT_NE(events.text.find("process rover[1] has died (start 1)"), std::string::npos)
      << events.text.substr(0, 500);

  // The restarted gate reads a value that no sender has written.
  std::string error;
  std::optional<Recording> recording = read_recording((folder_ / "once.tsr").string(), error);
  ASSERT_TRUE(recording) << error;
  for (auto entry = recording->entries.rbegin(); entry != recording->entries.rend(); ++entry) {
    if (entry->event.kind() != Event::Kind::firing || entry->event.version == 0) continue;
    if (!recording->transitions[entry->event.subject].name.starts_with("crossing.control.watch.rcv"))
      continue;
    entry->event.version += 5;
    break;
  }
  const auto judged = cli::check_against(kept().string(), {*recording});
  ASSERT_TRUE(judged);
  EXPECT_EQ(judged->verdict, replay::Legality::Verdict::illegal) << judged->why;
}

TEST_F(Deploy, APackageSaysWhatIsWrongBeforeAnythingIsBuilt) {
  const project::Exit version = tessera("package 11_crossing_apart --release beta");
  EXPECT_EQ(version.code, 2);
  EXPECT_NE(version.text.find("'beta' is no version"), std::string::npos) << version.text;
  const project::Exit host = tessera("package 11_crossing_apart --host cart.local");
  EXPECT_EQ(host.code, 2);
  EXPECT_NE(host.text.find("names no host"), std::string::npos) << host.text;
}

TEST_F(Deploy, AllAreWatchedSetAndResetTogetherAndAWatcherThatDiesDisturbsNone) {
  fs::create_directories(folder_ / "runtime");
  fs::permissions(folder_ / "runtime", fs::perms::owner_all);
  const project::Exit done = shell(
      "export XDG_RUNTIME_DIR=$PWD/runtime; T=" + std::string(TESSERA_BINARY_DIR) +
      "/tessera; await() { for i in $(seq 600); do if \"$@\"; then return; fi; sleep 0.05; done; echo WAITED "
      "IN VAIN: "
      "$*; }; "
      "shows() { $T top crossroads --once 2>>none.txt | tr '\\n' ' ' | grep -q \"$1\"; }; "
      "$T run 11_crossing_apart --deploy --on-failure go-on --for 120s" +
      domain_ +
      " >run.txt 2>&1 & R=$!; await shows '3 of 3 processes run'; await shows 'gate <- rover.0. *reachable.* "
      "ms'; "
      "$T top --once --json >lines.json; $T top crossroads >watched.txt & await test -s watched.txt; "
      "$T set speed=0.5; $T set lane=99; $T set spead=1; echo set code $?; "
      "$T emergency-stop --why smoke; await shows 'EMERGENCY STOP of gate, rover.0., rover.1.: smoke'; "
      "$T reset; echo reset code $?; $T reset crossroads; $T reset crossroads; kill -KILL $!; "
      "G=$($T top --once --json --controller gate | sed 's/.*\"pid\":\\([0-9]*\\).*/\\1/'); kill -KILL $G; "
      "await shows 'waits for crossing.control: no value.* process gate is gone.*gate  *GONE'; "
      "await shows 'rover.1. <- gate *DISCONNECTED'; "
      "kill -INT $R; wait $R; echo run code $?");
  for (const char* part :
       {"rover[0]: speed=0.5", "rover[1]: speed=0.5", "rover[1]: parameter lane = 99: 99 is out of range",
        "unknown parameter 'spead'; did you mean 'speed'?", "set code 1", "several controllers are running",
        "`tessera reset crossroads` resets all of them", "reset code 1",
        "gate: the emergency stop is over (smoke)", "rover[1]: the emergency stop is over (smoke)",
        "no process of crossroads on this machine has an emergency", "run code 1"})
    EXPECT_NE(done.text.find(part), std::string::npos) << part << "\n" << done.text;
  EXPECT_EQ(done.text.find("WAITED IN VAIN"), std::string::npos)
      << done.text << content_of(folder_ / "run.txt");
  std::ifstream lines(folder_ / "lines.json");
  std::size_t judged = 0;
  for (std::string line; std::getline(lines, line); ++judged) {
    const nlohmann::json said = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(said.is_object()) << line;
    schema_test::judge_line(said);
    EXPECT_FALSE(said.at("links").empty()) << line;
  }
  EXPECT_EQ(judged, 3U);
  const project::Exit joint = tessera(checked);
  EXPECT_EQ(joint.code, 3) << joint.text;
  EXPECT_NE(joint.text.find("the recording of gate is cut off"), std::string::npos) << joint.text;
}

/// A run with --restart, in which an operator stops processes and rover[0] is killed. `script` has $T, await,
/// shows, $R (the run) and K, which kills rover[0].
TEST_F(Deploy, NothingStartsAgainWhileAnEmergencyStopStands) {
  fs::create_directories(folder_ / "runtime");
  fs::permissions(folder_ / "runtime", fs::perms::owner_all);
  const auto run = [&](const std::string& limit, const std::string& script) {
    const project::Exit done =
        shell("export XDG_RUNTIME_DIR=$PWD/runtime; T=" + std::string(TESSERA_BINARY_DIR) +
              "/tessera; await() { for i in $(seq 600); do if \"$@\"; then return; fi; sleep 0.05; done; "
              "echo WAITED IN VAIN: $*; }; "
              "shows() { $T top crossroads --once 2>>none.txt | tr '\\n' ' ' | grep -q \"$1\"; }; "
              "says() { grep -q \"$1\" run.txt; }; "
              "K() { kill -KILL $($T top --once --json --controller 'rover[0]' | sed "
              "'s/.*\"pid\":\\([0-9]*\\).*/\\1/'); }; "
              "$T run 11_crossing_apart --deploy --on-failure go-on --restart on-failure --for " +
              limit + domain_ + " >run.txt 2>&1 & R=$!; await shows '3 of 3 processes run'; " + script +
              "kill -INT $R; wait $R; echo run code $?; cat run.txt");
    EXPECT_EQ(done.text.find("WAITED IN VAIN"), std::string::npos) << done.text;
    return done.text;
  };
  const auto count_starts = [&] { return deployment().at("processes").at(1).at("starts").size(); };

  // It stood in the stop, and begins again only after the reset.
  const std::string reset = run(
      "300s",
      "$T emergency-stop --why smoke; await shows 'EMERGENCY STOP of gate, rover.0., rover.1.: smoke'; K; "
      "await says 'rover.0. is not started again yet: an emergency stop stands at gate, rover.1. (smoke)'; "
      "ls 11_crossing_apart/.tessera/last; $T reset crossroads; await says 'rover.0. is started again'; "
      "await shows '3 of 3 processes run'; ");
  EXPECT_EQ(reset.substr(0, reset.find("over (smoke)")).find("rover[0]@2"), std::string::npos) << reset;
  EXPECT_NE(reset.find("run code 130"), std::string::npos) << reset;
  EXPECT_EQ(count_starts(), 2U) << reset;

  // The stop comes when it is dead already.
  const std::string later = run(
      "300s",
      "K; $T emergency-stop --why smoke; "
      "await says 'rover.0. is not started again yet: an emergency stop stands at gate, rover.1. (smoke)'; ");
  EXPECT_EQ(count_starts(), 1U) << later;

  // Nobody is left whose reset could end its stop. The command hears of it with the next state, within 0.2 s.
  const std::string alone =
      run("300s",
          "$T emergency-stop --why smoke --controller 'rover[0]'; await shows 'EMERGENCY STOP of rover.0.'; "
          "sleep 2; K; await says 'rover.0. is not started again: it failed in an emergency stop (smoke)'; ");
  EXPECT_EQ(count_starts(), 1U) << alone;
  EXPECT_NE(alone.find("run code 1\n"), std::string::npos) << alone;
}

/// examples/13_fleet_apart, with four rovers of its 49.
TEST_F(Command, AConvoyOfProcessesDrivesAndItsRecordingsAreOneLegalRun) {
  const fs::path spec = example("13_fleet_apart") / "spec.yaml";
  replace(spec, "count: 49", "count: 4");
  replace(spec, "rover[48]", "rover[3]");
  const project::Exit judged = tessera("verify 13_fleet_apart");
  EXPECT_NE(judged.text.find("survives_partition: holds"), std::string::npos) << judged.text;
  const project::Exit tests = tessera("test 13_fleet_apart");
  EXPECT_EQ(tests.code, 0) << tests.text;
  const project::Exit run =
      tessera("run 13_fleet_apart --deploy --for 3s --domain " + std::to_string(1 + getpid() % 230));
  EXPECT_EQ(run.code, 0) << run.text;
  EXPECT_NE(run.text.find("office   | "), std::string::npos) << run.text;
  const project::Exit joint = tessera("replay 13_fleet_apart/.tessera/last --check");
  EXPECT_EQ(joint.code, 0) << joint.text;
  EXPECT_NE(joint.text.find("in 5 recordings"), std::string::npos) << joint.text;
}

}  // namespace
}  // namespace tessera::cli_test
