#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "../schema/judge.hpp"
#include "machines.hpp"

/// `tessera top` and the studio of one machine see the processes of three, whose network loses packets. Nothing is
/// configured: a process of the machine knows where the others are.
namespace tessera::cli_test {
namespace {

using Json = nlohmann::json;

/// A user's commands on the machines. The processes gate, rover[0] and rover[1] run on the machines 0 to 2.
constexpr const char* look_around = R"sh(
all() { on $1 $T top --once --json >"$run/all$1.json" 2>"$run/all$1.txt" && test $(wc -l <"$run/all$1.json") = 3 &&
        ! grep -q '"state"' "$run/all$1.json"; }
await() { for i in $(seq 20); do "$@" && return; sleep 0.5; done; echo WAITED IN VAIN: "$*"; }
for n in 0 1 2; do await all $n; done
become 1 $T top --json >"$run/stream.json" 2>&1 & top=$!
become 1 $T studio "$project" --no-browser --port 0 >"$run/url" 2>"$run/studio.txt" & studio=$!
# "http://127.0.0.1:8123/?token=abc"
ask() { # METHOD TARGET BODY
  on 1 bash -c 'url=$(head -1 "$1"); host=${url#*//}; host=${host%%/*}; exec 3<>/dev/tcp/${host%:*}/${host#*:}
    printf "%s %s HTTP/1.1\r\nHost: %s\r\nAuthorization: Bearer %s\r\nContent-Type: application/json\r\nContent-Length: %s\r\nConnection: close\r\n\r\n%s" \
      "$2" "$3" "$host" "${url#*token=}" "${#4}" "$4" >&3; cat <&3' ask "$run/url" "$@" 2>/dev/null | tail -1
}
await test -s "$run/url"
began() { ask POST /api/runs '{"kind":"deployment"}' >"$run/run.json"; grep -q '"run"' "$run/run.json"; }
await began
watched=$(sed 's/.*"run":"\([^"]*\)".*/\1/' "$run/run.json")
sleep 7
ask GET "/api/runs/$watched" '' >"$run/studio_all.json"
kill -9 ${running[0]}
sleep 5
on 1 $T top --once >"$run/table.txt" 2>&1
on 1 $T top --once --json >"$run/after.json" 2>&1
ask GET "/api/runs/$watched" '' >"$run/studio_after.json"
on 2 $T emergency-stop >"$run/stop.txt" 2>&1; echo "code $?" >>"$run/stop.txt"
on 2 $T reset crossroads >"$run/reset.txt" 2>&1; echo "code $?" >>"$run/reset.txt"
on 0 $T top "$project" --interface cable --peers 10.78.0.1,10.78.0.2,10.78.0.3 --once --json >"$run/outside.json" 2>&1
kill $top $studio; wait $top $studio
true
)sh";

/// Clients are killed, or stopped and then killed, again and again.
constexpr const char* trouble = R"sh(
look() { for n in 0 1 2; do on $n $T top "machine[$n]" --once --json >"$run/$1$n.json" 2>"$run/$1$n.txt"; done; }
met() { look begin; ! grep -q '"reachable":false' "$run"/begin?.json; }
for i in $(seq 40); do met && break; sleep 0.5; done
sleep 8
look quiet
for i in $(seq 12); do
  become $((i % 3)) $T top --json >/dev/null 2>&1 & top=$!
  sleep 0.7
  [ $((i % 2)) = 0 ] || kill -STOP $top
  sleep 0.1
  kill -9 $top; wait $top 2>/dev/null
done
look end
true
)sh";

std::vector<Json> lines_of(const fs::path& file) {
  std::vector<Json> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    Json read = Json::parse(line, nullptr, false);
    if (read.is_object()) lines.push_back(std::move(read));
  }
  return lines;
}

class Watched : public Machines {
 protected:
  /// false: namespaces cannot be made here.
  [[nodiscard]] bool run_watched(const std::string& processes, const std::string& script) const {
    write(folder_ / "script", "T=" + std::string(TESSERA_BINARY_DIR) + "/tessera; sleep 1.5\n" + script);
    const project::Exit ran = run_apart(processes, "watched 120000 \"$(cat script)\"");
    EXPECT_TRUE(ran.code == 0 || ran.code == 77) << ran.text;
    EXPECT_EQ(ran.text.find("WAITED IN VAIN"), std::string::npos)
        << ran.text << content_of(runs() / "all1.txt");
    return ran.code != 77;
  }
  [[nodiscard]] Json answer(const char* name) const {
    return Json::parse(content_of(runs() / name), nullptr, false);
  }
};

TEST_F(Watched, EveryMachineSeesAllProcessesWhoWaitsForWhomAndWhoIsGone) {
  copy(TESSERA_SOURCE_DIR "/examples/11_crossing_apart");
  if (!build()) return;
  if (!run_watched("gate,rover[0],rover[1]", look_around)) GTEST_SKIP() << "no network namespaces here";
  const std::set<std::string> names{"gate", "rover[0]", "rover[1]"};
  for (const char* file : {"all0.json", "all1.json", "all2.json"}) {
    std::set<std::string> seen;
    for (const Json& line : lines_of(runs() / file)) {
      schema_test::judge_line(line);
      EXPECT_TRUE(seen.insert(line.at("process")).second) << file;
      EXPECT_FALSE(line.at("subsystems").empty()) << file;
      EXPECT_FALSE(line.at("links").empty()) << file;
    }
    EXPECT_EQ(seen, names) << file;
  }

  // The gate was killed: a client that has heard it finds it silent, and one that comes later names it.
  const auto says_of_gate = [&](const char* file, const char* state) {
    return std::ranges::any_of(lines_of(runs() / file), [&](const Json& line) {
      return line.value("process", "") == "gate" && line.value("state", "") == state;
    });
  };
  EXPECT_TRUE(says_of_gate("stream.json", "silent")) << content_of(runs() / "stream.json");
  EXPECT_TRUE(says_of_gate("after.json", "absent")) << content_of(runs() / "after.json");
  EXPECT_EQ(lines_of(runs() / "after.json").size(), 3U);
  const std::string table = content_of(runs() / "table.txt");
  for (const char* part : {"2 of 3 processes run", "robot[0].control waits for crossing.control",
                           "robot[1].control waits for", "process gate cannot be reached from rover[",
                           "NOT HEARD, NOT REACHABLE from rover[0]", "rover[1] <- gate", "DISCONNECTED"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;

  // A machine that runs none of them names the project.
  EXPECT_EQ(lines_of(runs() / "outside.json").size(), 3U) << content_of(runs() / "outside.json");

  // Half a stop is none.
  const std::string stop = content_of(runs() / "stop.txt"), reset = content_of(runs() / "reset.txt");
  for (const char* part :
       {"rover[1]", ": emergency stop\n", "NOT STOPPED", "crossroads: gate, rover[0]", "code 1"})
    EXPECT_NE(stop.find(part), std::string::npos) << part << "\n" << stop;
  for (const char* part : {"rover[1]: the emergency stop is over", "not reset", "gate, rover[0]", "code 0"})
    EXPECT_NE(reset.find(part), std::string::npos) << part << "\n" << reset;

  const auto states = [](const Json& run) {
    std::map<std::string, std::string> all;
    if (run.is_object() && run.contains("deployment") && run.at("deployment").is_object())
      for (const Json& one : run.at("deployment").at("processes")) all[one.at("name")] = one.at("state");
    return all;
  };
  using States = std::map<std::string, std::string>;
  const Json all = answer("studio_all.json"), after = answer("studio_after.json");
  EXPECT_EQ(states(all), (States{{"gate", "running"}, {"rover[0]", "running"}, {"rover[1]", "running"}}))
      << all << content_of(runs() / "studio.txt");
  EXPECT_EQ(states(after), (States{{"gate", "silent"}, {"rover[0]", "running"}, {"rover[1]", "running"}}))
      << after;
  ASSERT_TRUE(after.is_object());
  EXPECT_TRUE(after.at("deployment").at("network"));
  EXPECT_FALSE(after.at("deployment").at("waits").empty()) << after;
  EXPECT_EQ(after.at("deployment").at("links").size(), 2U) << after;
}

TEST_F(Watched, AKilledOrStoppedClientDisturbsNoProcess) {
  copy(TESSERA_SOURCE_DIR "/tests/namespaces/ring");
  if (!build()) return;
  if (!run_watched("machine[0],machine[1],machine[2]", trouble)) GTEST_SKIP() << "no network namespaces here";
  for (const char* machine : {"0", "1", "2"}) {
    std::map<std::string, std::vector<std::pair<double, double>>> progress;  // time, iterations
    std::map<std::string, double> since;                                     // by the process of a link
    for (const char* moment : {"begin", "quiet", "end"}) {
      const std::vector<Json> lines = lines_of(runs() / (moment + std::string(machine) + ".json"));
      ASSERT_EQ(lines.size(), 1U) << content_of(runs() / (moment + std::string(machine) + ".txt"));
      for (const Json& one : lines[0].at("subsystems"))
        progress[one.at("path")].emplace_back(lines[0].at("time_s").get<double>(),
                                              one.at("iterations").get<double>());
      for (const Json& link : lines[0].at("links")) {
        EXPECT_TRUE(link.at("reachable").get<bool>()) << moment << link;
        const auto [known, is_first] = since.try_emplace(link.at("process"), link.at("since_s"));
        EXPECT_EQ(known->second, link.at("since_s")) << "it was interrupted: " << moment << link;
      }
    }
    for (const auto& [path, at] : progress) {
      const double quiet = (at[1].second - at[0].second) / (at[1].first - at[0].first),
                   watched = (at[2].second - at[1].second) / (at[2].first - at[1].first);
      EXPECT_GT(watched, 0.8 * quiet) << path;  // a client that is waited for stops it
    }
  }
  // No process complains of the client.
  for (const auto& file : fs::directory_iterator(runs()))
    if (file.path().extension() == ".log") {
      const std::string log = content_of(file.path());
      for (const char* part :
           {"dropped", "says that it is of system", "was started a second time", "middleware"})
        EXPECT_EQ(log.find(part), std::string::npos) << file.path() << ": " << part;
    }
}

}  // namespace
}  // namespace tessera::cli_test
