// Subsystems that receive first, in compiled controllers.
#include <cstdlib>
#include <string>

#include "command.hpp"

namespace tessera::cli_test {

/// Runs a project in simulated time, plays its recording on the net, and runs its code again on the recording.
class ReceiveFirst : public Command {
 protected:
  std::string run(const std::string& project, const std::string& duration) const {
    const project::Exit ran = tessera("simulate " + project + " --for " + duration);
    EXPECT_EQ(ran.code, 0) << ran.text;
    const project::Exit legal = tessera("replay " + project + " --check");
    EXPECT_EQ(legal.code, 0) << legal.text;
    const project::Exit again = tessera("rerun " + project + "/.tessera/last/recording.tsr " + project);
    EXPECT_EQ(again.code, 0) << again.text;
    EXPECT_NE(again.text.find("run again: the same"), std::string::npos) << again.text;
    return ran.text;
  }
};

TEST_F(ReceiveFirst, AFunctionComputesWithTheNewestValueAndElseWithOneThatIsAPeriodOld) {
  const char* data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const fs::path given = fs::path(data) / "field/projects/one_period_old";
  ASSERT_TRUE(fs::exists(given)) << given;
  fs::copy(given, folder_ / "old", fs::copy_options::recursive);
  const std::string last = run("old", "500ms");
  EXPECT_NE(last.find("0.400 s  robot.control  computes with the value of 0.19 s"), std::string::npos)
      << last;
  replace(folder_ / "old/spec.yaml", "rate: 5 Hz", "rate: 5 Hz\n      receive: first");
  const std::string first = run("old", "500ms");
  EXPECT_NE(first.find("0.400 s  robot.control  computes with the value of 0.39 s"), std::string::npos)
      << first;
}

/// Branches of a parallel transfer, a blocking input, a fleet, and channels between two processes.
TEST_F(ReceiveFirst, FleetsInSeveralProcessesDoSo) {
  write(folder_ / "herd/spec.yaml", R"(tessera: 1
system: herd
templates:
  walker:
    control:
      rate: 10 Hz
      receive: first
      inputs: { order: float64, ahead: float64 }
      outputs: { at: float64 }
      behaviours: { walk: { transfer: parallel, next: { to: walk, when: error } } }
agents:
  sheep: { use: walker, count: 3, ring: true }
  shepherd:
    control:
      rate: 7 Hz
      receive: first
      inputs: { seen: float64 }
      outputs: { order: float64 }
      behaviours: { guide: { next: { to: guide, when: error } } }
channels:
  - { from: shepherd.control.order, to: "sheep[*].control.order", receive: blocking, timeout: 500 ms }
  - sheep[i].control.at -> sheep[i+1].control.ahead
  - sheep[0].control.at -> shepherd.control.seen
deploy: { processes: { home: shepherd, field: "sheep[*]" } }
)");
  write(folder_ / "herd/src/all.cpp", R"(#include "shepherd/control.hpp"
#include "walker/control.hpp"
namespace herd::shepherd::control {
void guide(Context& context, const Inputs& in, Memory&, Outputs& out) {
  out.order = tessera::seconds(context.now.time_since_epoch()) + 0 * in.seen;
}
}
namespace herd::walker::control {
void walk(Context& context, const Inputs& in, Memory&, Outputs& out) {
  if (in.order.fresh && in.order.age > std::chrono::milliseconds(50))
    throw std::runtime_error("it came for the iteration before");
  out.at = in.order + in.ahead * 0.1 + static_cast<double>(context.iteration);
}
}
)");
  const std::string text = run("herd", "5s");
  EXPECT_NE(text.find("sheep[2].control"), std::string::npos) << text;
  EXPECT_EQ(text.find("it came for the iteration before"), std::string::npos) << text;
}

}  // namespace tessera::cli_test
