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
/// A transition is *enabled* when every input place holds as many tokens as the arc's weight says, of which
/// the operations have finished. Among the enabled transitions those of the highest priority have their turn,
/// fairly or by lot; a transition whose turn it is fires if its condition holds. A firing takes the tokens
/// from the input places, then gives those of the output places, each of which starts the place's operation;
/// so do the tokens of the initial marking when the run begins.
///
/// *Conditions* are evaluated once a turn, just before the firing. Where one is false its transition steps
/// aside, until a token arrives in one of its input places or `reconsider` is called. One that depends on
/// more than its tokens needs that call.
///
/// *Cost.* A firing looks at the places of the transition and at the transitions that take from them, never
/// at the rest of the net. Between start and end of `run`, firings and inline operations allocate nothing and
/// lock nothing; on_worker operations pass through a queue with a mutex.
///
/// *Exceptions* out of an operation or a condition end the run with a fault that names the place or the
/// transition. The token stays where it is, its operation not finished; the next `run` starts it, or asks the
/// condition, again.
///
/// Threads: one thread at a time, except where a member says otherwise.
/// Source:  Figat & Zielinski, ICRA 2019, sec. II. Deviation: arc weights, several tokens, priorities.
class NetExecutor {
 public:
  /// Which of the enabled transitions of one priority is next.
  enum class Ties : std::uint8_t {
    fair,   ///< the one that has been enabled longest: none that stays enabled is passed over for ever
    random  ///< each with the same chance, the same for the same seed
  };
  struct Options {
    Ties ties = Ties::fair;
    std::uint64_t seed = 1;     ///< of random
    std::uint32_t workers = 1;  ///< threads for on_worker operations, if the net has any; 0 counts as 1
    std::uint32_t bound =
        UINT32_MAX / 2;  ///< more tokens in one place are a fault, and the firing is not made
    /// Told of every firing, as an index into transitions, after the marking has changed and before the
    /// operations start. Must not throw.
    std::function<void(std::uint32_t)> on_firing{};
  };

  /// nullptr and `error`: an arc to a place that does not exist, or of weight 0, a weight or marking that
  /// `bound` does not admit. Linear in the net up to sorting.
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
  /// Fires up to `most` transitions. A later run goes on where this one ended. Sleeps while only operations
  /// on workers can enable something. After stopped and fault no operation runs any more; those that had not
  /// begun begin with the next run.
  [[nodiscard]] Outcome run(std::uint64_t most = UINT64_MAX);

  /// Ends the run before the next firing, as soon as the operations that run have finished; without a run,
  /// the next one. Threads: any; also from operations, conditions, and signal handlers.
  void stop();

  /// Evaluates false conditions again. Threads: as stop.
  void reconsider();

  /// Tokens per place, those with a running operation included. Between runs, or from on_firing.
  [[nodiscard]] std::vector<std::uint32_t> marking() const;
  /// The enabled transitions in ascending order, whatever their conditions. Between runs. Looks at the whole
  /// net.
  [[nodiscard]] std::vector<std::uint32_t> enabled() const;

  ~NetExecutor();
  NetExecutor(const NetExecutor&) = delete;
  NetExecutor& operator=(const NetExecutor&) = delete;

 private:
  explicit NetExecutor(std::unique_ptr<NetMachine> machine);
  std::unique_ptr<NetMachine> machine_;
};

}  // namespace tessera
