#pragma once

#include <time.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "named_net.hpp"
#include "tessera/controller.hpp"
#include "tessera/tables.hpp"

/// Systems for the benchmarks: nets of single subsystems, and subsystems in the form of generated code, whose
/// transition functions only do what a benchmark asks for.
namespace tessera::benchmarks {

namespace named = testing::named;
using testing::acknowledged;
using testing::asynchronous;

namespace nets {
extern const SubsystemNet sender, receiver;                  ///< NB -> NB over "x"
extern const SubsystemNet patient_sender, patient_receiver;  ///< B -> B over "x"
extern const SubsystemNet relay;     ///< NB -> NB, sends "out" and receives "in": 8 firings an iteration
extern const SubsystemNet alone;     ///< no channel: 6 firings an iteration
extern const SubsystemNet asker;     ///< B: sends "out", then receives "in"
extern const SubsystemNet answerer;  ///< B: receives "in" in one behaviour, sends "out" in the next
}  // namespace nets

/// 64 bytes, the size of a pose with its covariance.
struct Payload {
  double values[8];
};

/// The transition function of an instance. It is called with the number of the instance and its context.
using Call = std::function<void(std::uint32_t, Context&)>;

/// A system of as many subsystems as asked for. Only one may exist at a time: instances find theirs by the
/// order of making.
class Robot {
 public:
  explicit Robot(Call call);
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  ~Robot();
  /// cpu: the processor its thread stays on; -1: any.
  std::uint32_t add(const SubsystemNet& net, Duration period = Duration{0}, int cpu = -1);
  void connect(std::uint32_t from, std::string_view out, std::uint32_t to, std::string_view in,
               std::span<const FusedPlace> places);
  /// The ages of commands are measured along all channels together.
  void measure_ages();
  /// Runs the system under the steady clock; aborts with a message when it cannot start or fails.
  RunSummary run(RunOptions options = {});

 private:
  std::vector<std::unique_ptr<std::string>> names_;
  std::vector<Instance> instances_;
  std::vector<Channel> channels_;
  std::vector<ChainWay> chain_ways_;
};

[[nodiscard]] inline std::int64_t ns_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}
[[nodiscard]] inline std::int64_t wall_ns() { return ns_of(CLOCK_MONOTONIC); }
[[nodiscard]] inline std::int64_t thread_cpu_ns() { return ns_of(CLOCK_THREAD_CPUTIME_ID); }
[[nodiscard]] inline std::int64_t process_cpu_ns() { return ns_of(CLOCK_PROCESS_CPUTIME_ID); }

/// The middle one; of an even number, the lower.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace tessera::benchmarks
