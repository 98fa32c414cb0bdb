#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tessera/executable_net.hpp"

namespace tessera {

class NetMachine;

/// Runs a place/transition net of any shape.
///
/// A transition is *enabled* when every input place holds as many tokens with finished operations as the
/// weight of the arc says. The enabled transitions of the highest priority take turns, in an order that
/// `Ties` selects. A transition whose turn has come fires if its condition holds. A firing takes tokens
/// from the input places and then gives tokens to the output places. Each token that is given starts the
/// operation of its place; so does each token of the initial marking when the run begins.
///
/// *Conditions* are evaluated once a turn, just before the firing. A transition with a false condition is
/// not asked again until a token arrives in one of its input places or `reconsider` is called. A condition
/// that depends on more than its tokens needs that call.
///
/// *Cost.* A firing looks at the places of the transition and at the transitions that take from them, never
/// at the rest of the net. Between start and end of `run`, firings and inline operations allocate nothing and
/// lock nothing; on_worker operations pass through a queue with a mutex.
///
/// *Exceptions* out of an operation or a condition end the run with a fault that names the place or the
/// transition. The token stays where it is, and its operation is not finished. The next `run` starts the
/// operation, or asks the condition, again.
///
/// Threads: one thread at a time, except where a member says otherwise.
/// Source:  Figat & Zielinski, ICRA 2019, sec. II. Deviation: arc weights, several tokens, priorities.
class NetExecutor {
 public:
  /// Selects the next among the enabled transitions of one priority.
  enum class Ties : std::uint8_t {
    fair,   ///< the one that has been enabled longest, so that none is passed over for ever
    random  ///< each with the same chance; the same sequence for the same seed
  };
  struct Options {
    Ties ties = Ties::fair;
    std::uint64_t seed = 1;     ///< of random
    std::uint32_t workers = 1;  ///< threads for on_worker operations, if the net has any; 0 counts as 1
    /// More tokens in one place are a fault, and the firing is not made.
    std::uint32_t bound = UINT32_MAX / 2;
    /// Called with the index of the transition after every firing: after the marking has changed and before
    /// the operations start. Must not throw.
    std::function<void(std::uint32_t)> on_firing{};
  };

  /// nullptr and `error` for an arc to a place that does not exist or of weight 0, and for a weight or
  /// marking above `bound`. Linear in the size of the net, up to sorting.
  [[nodiscard]] static std::unique_ptr<NetExecutor> load(ExecutableNet net, Options options,
                                                         std::string& error);

  enum class End : std::uint8_t {
    limit,    ///< as many firings as asked for have been made
    dead,     ///< no transition is enabled, and no operation runs
    blocked,  ///< all enabled transitions have false conditions, and no operation runs
    stopped,
    fault
  };
  struct Outcome {
    End end = End::limit;
    std::uint64_t firings = 0;  ///< of this run
    std::string fault{};        ///< what went wrong and where
  };
  /// Fires up to `most` transitions. A later run goes on where this one ended. The thread sleeps while only
  /// operations on workers can enable something. After `stopped` and `fault` no operation runs any more;
  /// operations that had not begun begin with the next run.
  [[nodiscard]] Outcome run(std::uint64_t most = UINT64_MAX);

  /// Ends the run before the next firing, as soon as the operations that run have finished. If nothing
  /// runs, it ends the next run. Threads: any; also from operations, conditions, and signal handlers.
  void stop();

  /// Evaluates false conditions again. Threads: as stop.
  void reconsider();

  /// The tokens of each place, including those with a running operation. Between runs, or from on_firing.
  [[nodiscard]] std::vector<std::uint32_t> marking() const;
  /// The enabled transitions in ascending order, whatever their conditions. Only between runs.
  /// Linear in the size of the net.
  [[nodiscard]] std::vector<std::uint32_t> enabled() const;

  ~NetExecutor();
  NetExecutor(const NetExecutor&) = delete;
  NetExecutor& operator=(const NetExecutor&) = delete;

 private:
  explicit NetExecutor(std::unique_ptr<NetMachine> machine);
  std::unique_ptr<NetMachine> machine_;
};

}  // namespace tessera
