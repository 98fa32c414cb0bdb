#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "machines.hpp"

/// The crossing of examples/11_crossing_apart, forty times as fast: as threads, as processes, and as processes of three
/// machines whose network loses packets.
namespace tessera::cli_test {
namespace {

/// When a rover was inside, by the steady clock of this machine, in ns.
struct Visit {
  std::size_t rover = 0;
  long in = 0, out = 0;
};

class Crossings : public Machines {
 protected:
  /// Time passes forty times as fast on the lanes, and the rovers write down when they are inside.
  void make(bool apart) const {
    fs::remove_all(project());
    copy(TESSERA_SOURCE_DIR "/examples/11_crossing_apart");
    const fs::path spec = project() / "spec.yaml", control = project() / "src/rover/control.cpp";
    for (int count = 0; count < 2; ++count) replace(spec, "rate: 20 Hz", "rate: 800 Hz");
    for (int count = 0; count < 2; ++count) replace(spec, "rate: 50 Hz", "rate: 800 Hz");
    replace(spec, "default: 0.8,", "default: 0.5,");
    replace(spec, "default: 0.6,", "default: 1,");
    const std::string text = content_of(spec);
    if (!apart) write(spec, text.substr(0, text.find("\ndeploy:")) + text.substr(text.find("\ndrivers:")));
    // If the machine is late, the lane waits for it.
    replace(project() / "src/drivers.hpp", "std::chrono::duration<double>(now - since_).count()",
            "std::fmin(40 * std::chrono::duration<double>(now - since_).count(), 0.1)");
    replace(control, "#include <algorithm>\n",
            "#include <unistd.h>\n\n#include <algorithm>\n#include <cstdio>\n#include <utility>\n");
    replace(
        control, "}  // namespace\n",
        "void say(const char* what, const Context& context) {\n"
        "  dprintf(STDERR_FILENO, \"@ %s %u %lld\\n\", what, unsigned{context.index},\n"
        "          static_cast<long long>(std::chrono::steady_clock::now().time_since_epoch().count()));\n"
        "}\n\n}  // namespace\n");
    replace(control, "  drive_to(context.parameters.stop, false, context, in, memory, out);\n",
            "  static std::uint32_t said[2];\n"
            "  if (std::exchange(said[context.index], memory.crossings) != memory.crossings) say(\"in\", "
            "context);\n"
            "  drive_to(context.parameters.stop, false, context, in, memory, out);\n");
    replace(control, "Memory& memory, Outputs& out) {}\n",
            "Memory& memory, Outputs& out) {\n  say(\"out\", context);\n}\n");
  }

  /// The number of crossings of each rover; no two rovers were inside at once.
  static std::array<std::size_t, 2> judge(const std::vector<fs::path>& logs) {
    std::vector<Visit> visits;
    for (const fs::path& log : logs) {
      std::map<std::size_t, long> inside;
      std::ifstream stream(log);
      for (std::string text; std::getline(stream, text);) {
        const std::size_t at = text.find("@ ");  // after the name of a process
        if (at == std::string::npos) continue;
        std::istringstream words(text.substr(at + 2));
        std::string what;
        std::size_t rover = 0;
        long time = 0;
        if (!(words >> what >> rover >> time)) continue;
        if (what == "in" && !inside.emplace(rover, time).second) ADD_FAILURE() << "in twice: " << text;
        if (what != "out") continue;
        const auto entered = inside.extract(rover);
        EXPECT_FALSE(entered.empty()) << "it leaves without having been inside: " << text;
        if (!entered.empty()) visits.push_back({rover, entered.mapped(), time});
      }
      for (const auto& [rover, time] : inside)
        visits.push_back({rover, time, std::numeric_limits<long>::max()});
    }
    std::ranges::sort(visits, {}, &Visit::in);
    std::size_t together = 0;
    for (std::size_t at = 1; at < visits.size(); ++at)
      together += visits[at].in < visits[at - 1].out ? 1U : 0U;
    EXPECT_EQ(together, 0U) << "two were inside at once";
    std::array<std::size_t, 2> crossings{};
    for (const Visit& visit : visits) ++crossings.at(visit.rover);
    return crossings;
  }

  /// Runs for a while, again and again, until TESSERA_CROSSINGS have been counted, and each rover has crossed. once: runs it for so many seconds,
  /// and says where the logs and the recordings are.
  struct Run {
    project::Exit done;
    std::vector<fs::path> logs;
    std::string recordings;
  };
  template <class Once>
  void count(const char* what, Once once) const {
    const int wanted = given_or("TESSERA_CROSSINGS", 1);
    std::size_t crossings = 0;
    std::array<bool, 2> crossed{};
    int seconds = 0;
    // On a busy machine the second rover may start late.
    for (int rounds = 0;
         crossings < static_cast<std::size_t>(wanted) || (!(crossed[0] && crossed[1]) && rounds < 5);
         ++rounds) {
      if (HasFailure()) break;
      const int now = wanted > 1 ? 60 : 3 + 5 * rounds;
      const Run run = once(now);
      if (run.done.code == 77) return static_cast<void>(std::printf("%s: %s", what, run.done.text.c_str()));
      EXPECT_EQ(run.done.code, 0) << run.done.text;
      const std::array<std::size_t, 2> found = judge(run.logs);
      for (const std::size_t rover : {0U, 1U}) crossed.at(rover) = crossed.at(rover) || found.at(rover) > 0;
      crossings += found[0] + found[1];
      seconds += now;
      const project::Exit joint = tessera("replay --spec project --check " + run.recordings);
      EXPECT_EQ(joint.code, 0) << joint.text;
    }
    EXPECT_TRUE(crossed[0] && crossed[1]) << what << ": a rover has never crossed";
    std::printf("%s: %zu crossings in %d s\n", what, crossings, seconds);
    std::fflush(stdout);
  }
};

TEST_F(Crossings, NeverHaveTwoInsideAsThreadsAsProcessesAndAsMachines) {
  make(/*apart=*/false);
  ASSERT_TRUE(build());
  count("threads", [&](int seconds) -> Run {
    return {tessera("run project --for " + std::to_string(seconds) + "s >log 2>&1"),
            {folder_ / "log"},
            "project/.tessera/last/recording.tsr"};
  });
  make(/*apart=*/true);
  ASSERT_TRUE(build());
  count("processes", [&](int seconds) -> Run {
    // Others may run the same system on this machine.
    return {tessera("run project --deploy --for " + std::to_string(seconds) + "s --domain " +
                    std::to_string(1 + getpid() % 230) + " >log 2>&1"),
            {folder_ / "log"},
            "project/.tessera/last"};
  });
  if (geteuid() != 0) GTEST_SKIP() << "only root may make network namespaces";
  count("machines", [&](int seconds) -> Run {
    const project::Exit done = run_apart("gate,rover[0],rover[1]", "run " + std::to_string(seconds * 1000));
    return {done, {runs() / "rover[0]@1.log", runs() / "rover[1]@1.log"}, "'" + runs().string() + "'/*.tsr"};
  });
}

}  // namespace
}  // namespace tessera::cli_test
