#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "executor/firing_program.hpp"
#include "executor/turns.hpp"
#include "executor/worker_pool.hpp"
#include "tessera/net_executor.hpp"

namespace tessera {

/// The implementation of a NetExecutor. Enabling is incremental: for each transition that is not sole, the
/// machine counts the input places that hold too few tokens. A firing updates the counts of the transitions
/// behind the places that it changes.
///
/// A transition waits in `turns` from the moment when it becomes enabled until its turn comes. One that was
/// disabled in the meantime is then skipped. So an enabled transition that does not wait is the one that
/// fires, or one whose condition was false; an arriving token makes the latter wait again.
///
/// Threads: stop and reconsider from any, the rest from one.
class NetMachine {
 public:
  NetMachine(ExecutableNet net, NetExecutor::Options options, FiringProgram program);

  [[nodiscard]] NetExecutor::Outcome run(std::uint64_t most);
  void stop() { call_attention(stop_asked); }
  void reconsider() { call_attention(reconsider_asked); }
  [[nodiscard]] std::vector<std::uint32_t> marking() const;
  [[nodiscard]] std::vector<std::uint32_t> enabled() const;

 private:
  using Hop = FiringProgram::Hop;
  // Bits of attention_.
  static constexpr std::uint32_t stop_asked = 1, reconsider_asked = 2, operation_finished = 4;
  // Per transition: 2 * places with too few tokens, + 1 while it waits for its
  // turn. 0: enabled, not waiting.
  static constexpr std::uint32_t waiting = 1, missing_one = 2;

  void mark_initially();
  template <class Turns>
  NetExecutor::Outcome run_with(Turns& turns, std::uint64_t most);
  template <bool observed, class Turns>
  [[nodiscard]] std::uint64_t fire_while_undisturbed(Turns& turns, std::uint64_t most);

  template <class Turns>
  [[nodiscard]] bool try_fire(std::uint32_t transition, Turns& turns);
  [[nodiscard]] bool condition_holds(std::uint32_t original);
  [[nodiscard]] bool within_bound(const FiringProgram::Arcs& arcs);
  void take_from(std::uint32_t place, std::uint32_t count);
  template <class Turns>
  void give_to(std::uint32_t place, std::uint32_t count, Turns& turns);
  template <class Turns>
  void wait_again(std::uint32_t transition, Turns& turns);
  [[nodiscard]] bool enabled(std::uint32_t transition) const;

  template <class Turns>
  void start_operation(std::uint32_t place, Turns& turns);
  template <class Turns>
  void start_operations(const FiringProgram::Arcs& arcs, Turns& turns);
  template <class Turns>
  void start_unstarted(Turns& turns);
  template <class Turns>
  void collect_finished(Turns& turns);
  template <class Turns>
  void halt_workers(Turns& turns);
  template <class Turns>
  void reconsider_conditions(Turns& turns);
  [[nodiscard]] bool some_condition_is_false() const;

  void call_attention(std::uint32_t bits);
  void sleep_until_attention();
  void fault_by(std::exception_ptr thrown, const char* what, const std::string& name);
  void fault_by_bound(std::uint32_t place);

  ExecutableNet net_;
  NetExecutor::Options options_;
  FiringProgram program_;

  std::vector<std::uint32_t> tokens_;       // per place: tokens without an operation or with a finished one
  std::vector<std::uint32_t> in_work_;      // per place: tokens whose operation has not finished
  std::vector<std::uint32_t> status_;       // per transition that is not sole
  std::vector<std::uint32_t> conditional_;  // transitions with a condition
  std::vector<std::uint32_t> unstarted_;    // places, once per token whose operation is to be started
  std::vector<WorkerPool::Finished> finished_;  // scratch of collect_finished
  // operations that were given to the workers and have not been collected
  std::uint64_t submitted_ = 0;

  std::vector<std::uint32_t> rings_;  // for the turns
  std::vector<FairTurns> ranks_;
  std::vector<std::uint64_t> occupied_;
  std::vector<FairTurns> fair_;      // one, if there is one rank and no lot; otherwise:
  std::vector<RankedTurns> ranked_;  // one

  bool faulted_ = false;
  std::string fault_;
  std::atomic<std::uint32_t> attention_{0};
  std::unique_ptr<WorkerPool> workers_;  // the last member, so that its threads end first
};

}  // namespace tessera
