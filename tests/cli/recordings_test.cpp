// Recordings of threads on a busy machine, of controllers that are killed, and on full disks: none is called
// illegal. TESSERA_RECORDINGS=1000 is the long form.
#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "../environment.hpp"
#include "cli/terminal.hpp"
#include "command.hpp"
#include "project/verification/pipeline.hpp"
#include "replay/legality.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli_test {
namespace {

using Verdict = replay::Legality::Verdict;

[[nodiscard]] std::uint64_t recordings() { return from_environment("TESSERA_RECORDINGS", 20); }

/// Pairs that wait for each other, and some that do not.
constexpr const char* talkers = R"(tessera: 1
system: talkers
types: { Word: { n: int32 } }
agents:
  a: { control: { rate: 2000 Hz, outputs: { x: Word }, inputs: { y: Word }, behaviours: { go: {} } } }
  b: { control: { inputs: { x: Word }, outputs: { y: Word }, behaviours: { go: {} } } }
  c: { control: { rate: 1500 Hz, outputs: { x: Word, z: Word }, behaviours: { go: {} } } }
  d: { control: { rate: 1000 Hz, inputs: { x: Word, z: Word }, behaviours: { go: {} } } }
channels:
  - { from: a.control.x, to: b.control.x, receive: blocking }
  - { from: b.control.y, to: a.control.y, send: blocking, send_timeout: 5 ms }
  - { from: c.control.x, to: d.control.x, send: blocking, receive: blocking }
  - c.control.z -> d.control.z
)";

/// Keeps the processors busy as long as it lives.
class Load {
 public:
  explicit Load(unsigned threads) {
    for (unsigned index = 0; index < threads; ++index)
      threads_.emplace_back([this] {
        while (!over_.load(std::memory_order_relaxed)) ++turns_;
      });
  }
  ~Load() {
    over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  std::atomic<bool> over_{false};
  std::atomic<std::uint64_t> turns_{0};
  std::vector<std::thread> threads_;
};

class Recordings : public Command {
 protected:
  Recordings() {
    write(folder_ / "spec.yaml", talkers);
    EXPECT_EQ(tessera("generate --stubs").code, 0);
    const project::Exit made = tessera("run --for 100ms");
    EXPECT_EQ(made.code, 0) << made.text;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / ".tessera/build"))
      if (entry.path().filename() == "controller" && entry.is_regular_file()) controller_ = entry.path();
    const auto specification = project::read(folder_, cli::terminal());
    if (specification) nets_ = project::build(*specification, cli::terminal());
  }

  [[nodiscard]] replay::Legality check(const fs::path& file) const {
    std::string error;
    const std::optional<Recording> recording = read_recording(file.string(), error);
    if (!recording) return {.verdict = Verdict::illegal, .why = error, .firings = 0, .marking = {}};
    return replay::check_legal({&*recording, 1}, nets_->flat);
  }
  /// The command that makes a recording of `milliseconds`.
  [[nodiscard]] std::string record(const fs::path& file, unsigned milliseconds,
                                   const std::string& more) const {
    return fmt::format("'{}' run --no-monitor --for {}ms --record {} {}", controller_.string(), milliseconds,
                       file.string(), more);
  }

  /// Whole and legal, together and segment by segment.
  void be_busy() {
    const Load load(4);
    const fs::path file = fresh();
    const project::Exit ran = shell(record(file, 50 + below(200), "--record-limit 16kBx2000"));
    ASSERT_EQ(ran.code, 0) << ran.text;
    const replay::Legality whole = check(file);
    EXPECT_EQ(whole.verdict, Verdict::legal) << whole.why;
    expect_legal_segments(file.parent_path());
  }
  void be_killed(const std::string& limit) {
    const fs::path file = fresh();
    static_cast<void>(
        shell(fmt::format("timeout -s KILL 0.{:03} {}", 20 + below(400), record(file, 60'000, limit))));
    expect_cut_off(file);
  }
  /// The disk is full for this process only, at any number of blocks of 512 bytes.
  void run_out_of_space(const std::string& limit) {
    const fs::path file = fresh();
    static_cast<void>(
        shell(fmt::format("trap '' XFSZ; ulimit -f {}; {}", 10 + below(60), record(file, 250, limit))));
    expect_cut_off(file, Verdict::legal);  // when it ends before the disk is full
  }

  [[nodiscard]] unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }
  [[nodiscard]] fs::path fresh() const {
    fs::remove_all(folder_ / "recorded");
    fs::create_directories(folder_ / "recorded");
    return folder_ / "recorded/recording.tsr";
  }
  void expect_cut_off(const fs::path& file, Verdict or_else = Verdict::incomplete) {
    std::string error;
    if (!read_recording(file.string(), error)) return;  // killed before there was one
    const replay::Legality whole = check(file);
    if (whole.verdict != or_else) {
      EXPECT_EQ(whole.verdict, Verdict::incomplete) << whole.why;
    }
    expect_legal_segments(file.parent_path(), file);
  }
  void expect_legal_segments(const fs::path& folder, const fs::path& but = {}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path() == but) continue;
      const replay::Legality one = check(entry.path());
      EXPECT_EQ(one.verdict, Verdict::legal) << entry.path() << ": " << one.why;
      ++segments_;
    }
  }

  fs::path controller_;
  std::optional<project::Nets> nets_;
  unsigned segments_ = 0;
  std::mt19937 random_{20};
};

// One test, since it builds a controller.
TEST_F(Recordings, OnABusyMachineAreLegalAndThoseOfKilledControllersAndFullDisksAreCutOff) {
  ASSERT_TRUE(nets_);
  ASSERT_FALSE(controller_.empty());
  for (unsigned number = 0; number < recordings() && !HasFailure(); ++number) {
    SCOPED_TRACE(number);
    if (number > 0 && number % 100 == 0) {
      fmt::print("{} of {}\n", number, recordings());
      std::fflush(stdout);
    }
    be_busy();
    be_killed(below(2) == 0 ? "" : "--record-limit 16kBx2000");
    run_out_of_space(below(2) == 0 ? "" : "--record-limit 16kBx2000");
  }
  EXPECT_GT(segments_, recordings());
}

}  // namespace
}  // namespace tessera::cli_test
