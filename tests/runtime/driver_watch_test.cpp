// Drivers that do not return, or that end the process, before and after the run.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "child_run.hpp"
#include "nets.hpp"
#include "run/execute.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// Writes a line for each of its steps into a file. In one step it does not return, or it ends the process.
class Troubled final : public Effector<double> {
 public:
  explicit Troubled(const DriverSetup& setup)
      : name_(setup.text("name")),
        story_(setup.text("story")),
        step_(setup.text_or("step", "")),
        exits_(setup.flag_or("exits", false)) {
    take("constructor");
  }
  ~Troubled() override { take("destructor"); }
  bool open() override {
    take("open");
    return true;
  }
  bool write(const double& value) override {
    if (value == -1 && !std::exchange(is_safe_, true)) take("safe");
    return true;
  }
  void close() override { take("close"); }

 private:
  void take(const std::string& step) const {
    std::ofstream(story_, std::ios::app) << name_ + " " + step + "\n" << std::flush;
    if (step != step_) return;
    if (exits_) std::exit(0);
    for (;;) std::this_thread::sleep_for(1s);
  }
  std::string name_, story_, step_;
  bool exits_, is_safe_ = false;
};

/// The traces of a run with two devices; the second one is troubled.
struct Left {
  int code = 0;
  std::string ended, story, output;
};

class TroubledRun {
 public:
  TroubledRun(const std::string& step, bool exits) : step_(step), exits_(exits) {
    for (const std::string& file : {story_, ended_, output_}) std::filesystem::remove(file);
    Script moves;
    moves.acts = true;
    moves.call = [](ScriptState& state) { state.command = 5; };
    robot_.add("robot.first", nets::alone, moves, 1ms, 0ms, Kind::effector);
    robot_.add("robot.second", nets::alone, moves, 1ms, 0ms, Kind::effector);
    system_ = robot_.system();
    system_.real_drivers = drivers_;
    options_.recording = recording;
  }

  /// text: SIGINT is sent when the output has it; empty: none is sent.
  Left run(const std::string& text = "") {
    ChildRun child([this](CommandLog&) { return body(); });
    if (!text.empty()) {
      EXPECT_TRUE(child.await([&] { return file_bytes(output_).find(text) != std::string::npos; }))
          << file_bytes(output_);
      child.kill(SIGINT);
    }
    const int code = child.wait();
    return {code, file_bytes(ended_), file_bytes(story_), file_bytes(output_)};
  }

  const std::string recording = scratch_file("run");

 private:
  int body() {
    const int file = ::open(output_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    dup2(file, STDERR_FILENO);
    const auto end_process = [this](const RunSummary& summary) {
      std::ofstream(ended_) << summary.ended << std::flush;
      _exit(summary.failed ? 1 : 2);
    };
    std::string error;
    const GiveUp give_up{.end_process = end_process, .unsafe = 300ms, .safe = 1h};
    return execute(system_, options_, nullptr, give_up, error) ? 3 : 4;
  }

  const std::string story_ = scratch_file("story"), ended_ = scratch_file("ended"),
                    output_ = scratch_file("output");
  std::string step_;
  bool exits_;
  std::vector<DriverOption> first_{{"name", "first"}, {"story", std::string_view(story_)}},
      second_{{"name", "second"},
              {"story", std::string_view(story_)},
              {"step", std::string_view(step_)},
              {"exits", exits_}};
  TestSystem robot_;
  System system_;
  RunOptions options_ = steady(20ms);
  std::vector<CppDriver> drivers_{{"robot.first.command", "Troubled", nullptr, first_, nullptr,
                                   make_driver<RealEffector, double, Troubled>},
                                  {"robot.second.command", "Troubled", nullptr, second_, nullptr,
                                   make_driver<RealEffector, double, Troubled>}};
};

struct Trouble {
  const char* step;
  const char* name;   ///< in messages
  const char* story;  ///< of the devices
};
constexpr Trouble at_start[] = {
    {"constructor", "the constructor of the driver", "first constructor\nsecond constructor\n"},
    {"open", "open()",
     "first constructor\nsecond constructor\nfirst open\nfirst safe\nsecond open\nfirst close\n"},
    {"safe", "the first safe command",
     "first constructor\nsecond constructor\nfirst open\nfirst safe\nsecond open\nsecond safe\nfirst "
     "close\n"}};
constexpr const char* whole_start =
    "first constructor\nsecond constructor\nfirst open\nfirst safe\nsecond open\nsecond safe\n";
constexpr Trouble at_end[] = {{"close", "close()", "second close\nfirst close\n"},
                              {"destructor", "the destructor of the driver",
                               "second close\nfirst close\nfirst destructor\nsecond destructor\n"}};

void expect_whole_recording(const std::string& file) {
  std::string error;
  const auto recording = read_recording(file, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_FALSE(recording->truncated);
  EXPECT_EQ(recording->entries.back().event.kind(), Event::Kind::stop);
}

TEST(DriverWatch, ADriverThatDoesNotReturnAtTheStartIsNamedAndASignalEndsTheRun) {
  for (const Trouble& trouble : at_start) {
    SCOPED_TRACE(trouble.step);
    TroubledRun run(trouble.step, /*exits=*/false);
    const std::string what = std::string(trouble.name) + " of robot.second.command";
    const Left left = run.run("waits for " + what + " (");
    EXPECT_EQ(left.code, 1);
    EXPECT_TRUE(left.ended.starts_with("SIGINT; " + what + " has not returned for ")) << left.ended;
    EXPECT_EQ(left.story, trouble.story);
    EXPECT_NE(left.output.find("s); Ctrl-C ends the run"), std::string::npos) << left.output;
    EXPECT_NE(left.output.find("SIGINT; waits for " + what + ", for at most 0.3 s"), std::string::npos)
        << left.output;
    if (trouble.step != std::string("constructor")) expect_whole_recording(run.recording);
  }
}

TEST(DriverWatch, ADriverThatDoesNotReturnAtTheEndFailsTheRunThatHasItsRecording) {
  for (const Trouble& trouble : at_end) {
    SCOPED_TRACE(trouble.step);
    TroubledRun run(trouble.step, /*exits=*/false);
    const Left left = run.run();
    EXPECT_EQ(left.code, 1);
    EXPECT_TRUE(left.ended.starts_with(std::string("duration; ") + trouble.name +
                                       " of robot.second.command has not returned for "))
        << left.ended;
    EXPECT_EQ(left.story, std::string(whole_start) + trouble.story);
    expect_whole_recording(run.recording);
  }
}

TEST(DriverWatch, ADriverThatEndsTheProcessFailsTheRun) {
  for (const auto& [troubles, ended] : {std::pair{std::span<const Trouble>(at_start), ""},
                                        std::pair{std::span<const Trouble>(at_end), "duration; "}})
    for (const Trouble& trouble : troubles) {
      SCOPED_TRACE(trouble.step);
      const Left left = TroubledRun(trouble.step, /*exits=*/true).run();
      EXPECT_EQ(left.code, 1);
      EXPECT_EQ(left.ended,
                ended + std::string(trouble.name) + " of robot.second.command has called exit(0)");
    }
}

}  // namespace
}  // namespace tessera::testing
