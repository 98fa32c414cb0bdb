// `tessera replay --ages`: the times that a recording tells, against a calculation that uses no versions of channels.
#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "command.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli_test {
namespace {

struct Call {
  std::int64_t begin_ns = 0, end_ns = 0;
  std::optional<std::int64_t> stamp_ns{};  ///< when the value in its input was written
  bool safe = false;                       ///< a device has its safe command
};

/// The calls of a subsystem, with the stamp of the value that it had received before.
std::vector<Call> calls_in(const Recording& recording, const std::string& subsystem,
                           const std::string& input) {
  std::vector<Call> calls;
  std::optional<std::int64_t> stamp;
  std::map<std::string, bool> safe;
  Call call;
  for (const Recording::Entry& entry : recording.entries) {
    const Event& event = entry.event;
    if (event.instance() == system_instance || recording.instances[event.instance()] != subsystem) continue;
    if (event.kind() == Event::Kind::call) call = {event.time_ns, 0, stamp};
    if (event.kind() == Event::Kind::safe)
      safe[entry.text.substr(0, entry.text.find(':'))] = event.version != 2;
    if (event.kind() == Event::Kind::value) {
      const ValueEvent value = value_of(entry);
      if (recording.buffers[value.buffer].path == input && value.has(ValueFlags::stamped))
        stamp = value.stamp_ns;
    }
    if (event.kind() != Event::Kind::firing ||
        recording.transitions[event.subject].role.step != Step::begin_sending)
      continue;
    call.end_ns = event.time_ns;
    call.safe = std::ranges::any_of(safe, [](const auto& device) { return device.second; });
    calls.push_back(call);
  }
  return calls;
}

/// The call that had ended last at that time: it wrote the value with this stamp.
const Call& writer(const std::vector<Call>& calls, std::int64_t stamp_ns) {
  return *std::prev(std::ranges::upper_bound(calls, stamp_ns, {}, &Call::end_ns));
}

struct Naive {
  std::vector<std::int64_t> ages, reactions;
};

Naive naive_times(const std::string& file) {
  std::string error;
  const std::optional<Recording> recording = read_recording(file, error);
  EXPECT_TRUE(recording) << error;
  const std::vector<Call> sensor = calls_in(*recording, "robot.sensor", ""),
                          control = calls_in(*recording, "robot.control", "robot.control.line"),
                          motor = calls_in(*recording, "robot.motor", "robot.motor.velocity");
  Naive result;
  std::vector<std::pair<std::int64_t, std::int64_t>> commands;  // reading, end
  for (const Call& call : motor) {
    if (call.safe || !call.stamp_ns) continue;
    const Call& decided = writer(control, *call.stamp_ns);
    if (!decided.stamp_ns) continue;
    const std::int64_t reading = writer(sensor, *decided.stamp_ns).begin_ns;
    result.ages.push_back(call.end_ns - reading);
    commands.emplace_back(reading, call.end_ns);
  }
  for (const Call& call : sensor) {
    const auto first =
        std::ranges::find_if(commands, [&](const auto& command) { return command.first > call.begin_ns; });
    if (first != commands.end()) result.reactions.push_back(first->second - call.begin_ns);
  }
  std::ranges::sort(result.ages);
  std::ranges::sort(result.reactions);
  return result;
}

void compare(const nlohmann::json& told, const std::vector<std::int64_t>& naive) {
  ASSERT_FALSE(naive.empty());
  const auto rank = [&](std::size_t percent) { return naive[(naive.size() * percent + 99) / 100 - 1]; };
  EXPECT_EQ(told.at("count"), naive.size());
  EXPECT_EQ(told.at("least_ns"), naive.front());
  EXPECT_EQ(told.at("median_ns"), rank(50));
  EXPECT_EQ(told.at("p95_ns"), rank(95));
  EXPECT_EQ(told.at("p99_ns"), rank(99));
  EXPECT_EQ(told.at("most_ns"), naive.back());
  EXPECT_EQ(
      told.at("worst").at("to_ns").get<std::int64_t>() - told.at("worst").at("from_ns").get<std::int64_t>(),
      naive.back());
}

}  // namespace

using AgesOfCommands = Command;

TEST_F(AgesOfCommands, AreThoseOfTheStampsAndStayBelowTheirBounds) {
  const fs::path project = example("01_line_follower");
  replace(project / "spec.yaml", "watch: {}", "watch: { takes: 1..2 ms }");
  replace(project / "spec.yaml", "next: follow }", "next: follow, takes: 2..8 ms }");
  replace(project / "spec.yaml", "follow: {}", "follow: { takes: 2..8 ms }");
  replace(project / "spec.yaml", "drive: {}", "drive: { takes: 1..2 ms }");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 30s --record run.tsr --report page").code, 0);
  EXPECT_EQ(content_of(folder_ / "page/index.html").find("take no time"), std::string::npos);
  const nlohmann::json chain = json("replay run.tsr --ages --spec 01_line_follower").at("ages").at(0);
  EXPECT_EQ(chain.at("chain"), "robot.sensor -> robot.control -> robot.motor");
  EXPECT_EQ(chain.at("bound").at("age_ns"), 82'000'000);
  EXPECT_EQ(chain.at("bound").at("reaction_ns"), 142'000'000);
  const Naive naive = naive_times(folder_ / "run.tsr");
  compare(chain.at("age"), naive.ages);
  compare(chain.at("reaction"), naive.reactions);
  EXPECT_LE(naive.ages.back(), 82'000'000);
  EXPECT_LE(naive.reactions.back(), 142'000'000);

  // The same chain, with a name.
  const std::string unnamed = content_of(project / "spec.yaml");
  write(project / "spec.yaml",
        unnamed +
            "\ntiming:\n  chains:\n    - { name: line to wheels, path: [robot.sensor, robot.control, "
            "robot.motor] }\n");
  nlohmann::json named = json("replay run.tsr --ages --spec 01_line_follower").at("ages").at(0);
  EXPECT_EQ(std::exchange(named.at("chain"), chain.at("chain")), "line to wheels");
  for (const char* times : {"age", "reaction"})
    EXPECT_EQ(std::exchange(named.at(times).at("worst").at("chain"), chain.at("chain")), "line to wheels");
  EXPECT_EQ(named, chain);
  write(project / "spec.yaml", unnamed);

  // Without `takes`, calls take no time in a simulation. The recording says so, whatever the specification says now.
  replace(project / "spec.yaml", "drive: { takes: 1..2 ms }", "drive: {}");
  ASSERT_EQ(tessera("simulate 01_line_follower --for 10s --record free.tsr --report page").code, 0);
  EXPECT_NE(content_of(folder_ / "page/index.html").find("the calls of robot.motor.drive take no time"),
            std::string::npos);
  write(project / "spec.yaml", unnamed);
  const project::Exit free = tessera("replay free.tsr --ages --spec 01_line_follower");
  EXPECT_NE(free.text.find("the calls of robot.motor.drive take no time"), std::string::npos) << free.text;
  const nlohmann::json told = json("replay run.tsr free.tsr --ages --spec 01_line_follower").at("ages").at(0);
  EXPECT_EQ(told.at("takes_no_time"), nlohmann::json({"robot.motor.drive"}));
  EXPECT_FALSE(chain.contains("takes_no_time"));

  // In segments, of which the first are gone, and cut off.
  ASSERT_EQ(tessera("simulate 01_line_follower --for 60s --record part.tsr --record-limit 1MB").code, 0);
  std::string bytes = content_of(folder_ / "part.tsr");
  write(folder_ / "part.tsr", bytes.substr(0, bytes.size() - 100));
  const nlohmann::json part = json("replay part.tsr --ages --spec 01_line_follower").at("ages").at(0);
  EXPECT_GT(part.at("age").at("count"), 10);
  EXPECT_LT(part.at("age").at("count"), 1100);
  EXPECT_LE(part.at("age").at("most_ns"), 82'000'000);
  const nlohmann::json both = json("replay run.tsr part.tsr --ages --spec 01_line_follower").at("ages").at(0);
  EXPECT_EQ(both.at("age").at("count"),
            chain.at("age").at("count").get<int>() + part.at("age").at("count").get<int>());
  EXPECT_EQ(both.at("age").at("most_ns"),
            std::max(chain.at("age").at("most_ns").get<int>(), part.at("age").at("most_ns").get<int>()));

  // A bound that is too small for the run is exceeded.
  replace(project / "spec.yaml", "follow: { takes: 2..8 ms }", "follow: { takes: 2..3 ms }");
  replace(project / "spec.yaml", "next: follow, takes: 2..8 ms }", "next: follow, takes: 2..3 ms }");
  replace(project / "spec.yaml", "rate: 20 Hz", "rate: 50 Hz");
  const project::Exit above = tessera("replay run.tsr --ages --spec 01_line_follower");
  EXPECT_EQ(above.code, 1) << above.text;
  EXPECT_NE(above.text.find("above the bound"), std::string::npos) << above.text;
  EXPECT_EQ(tessera("replay run.tsr --ages --check --spec 01_line_follower").code, 2);
}

}  // namespace tessera::cli_test
