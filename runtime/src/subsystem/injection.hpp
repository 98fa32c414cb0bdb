#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "system/clock.hpp"
#include "tessera/context.hpp"
#include "tessera/device.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/tables.hpp"

namespace tessera {

/// A fault to plant in a run, as given by `--inject`.
struct Injection {
  enum class Kind : std::uint8_t {
    exception,  ///< thrown in place of the transition function
    stall,      ///< the transition function takes `delay` longer
    number,     ///< every floating-point number of the outputs becomes `number`
    device,     ///< the device throws (receptor) or refuses (effector)
    silence,    ///< the real receptor has no value
    signal,     ///< the process gets `signal`
    link,       ///< two processes do not hear each other for `delay`
    process     ///< a process dies; after `delay` it begins again
  } kind = Kind::exception;
  std::string text;                                     ///< as it was written
  std::uint32_t instance = 0;                           ///< into System::instances
  std::pair<std::uint32_t, std::uint32_t> processes{};  ///< into System::processes; of `process`: the first
  std::string part;   ///< behaviour or real buffer; empty: all of the subsystem
  Duration delay{0};  ///< Duration::max(): never again
  double number = 0;
  int signal = 0;
  Time from{};
  Time until = Time::max();
  bool once = true;  ///< only the first chance from `from` on

  Context* context = nullptr;  ///< of the subsystem whose device has the fault

  /// Whether the fault occurs now; if so, it has happened.
  [[nodiscard]] bool happens(Time now);
  /// Whether it has occurred in this run. Threads: any.
  [[nodiscard]] bool has_happened() const;
  /// Notes that it has occurred. Threads: any.
  void note_happened();
  /// Reports the fault of a device when it begins. Threads: the subsystem's.
  void announce();

 private:
  bool done_ = false, announced_ = false;
  mutable bool happened_ = false;  // read and written with std::atomic_ref
};

/// A fault of a subsystem with several devices affects the device that is used first.
using Injections = std::vector<std::shared_ptr<Injection>>;

/// Reads the value of `--inject`:
///
///     SUBSYSTEM[.BEHAVIOUR]:throw@WHEN   :stall=TIME@WHEN   :nan@WHEN   :inf@WHEN
///     device:SUBSYSTEM[.BUFFER]@WHEN     silent:RECEPTOR[.BUFFER]@WHEN
///     signal:SIGINT@WHEN                 (or another signal that stops a run)
///     link:PROCESS-PROCESS:cut=TIME@WHEN (WHEN is a time, or `any`)
///     process:PROCESS:crash@WHEN   process:PROCESS:restart=TIME@WHEN (the same)
///
/// WHEN: `2s` the first chance from then on; `2s..` every chance from then on; `2s..3s` every chance in
/// between; `any` the first chance from a time on that is drawn from the seed, within the run's duration.
///
/// Errors: another form, names that the system does not have (with the nearest one), `any` without a
///         duration: nullopt and `error`.
[[nodiscard]] std::optional<Injection> read_injection(const std::string& text, const System& system,
                                                      std::uint64_t seed, std::optional<Duration> duration,
                                                      std::string& error);

/// A subsystem with faults in its transition functions. All other calls go to the wrapped subsystem.
class FaultySubsystem final : public Subsystem {
 public:
  FaultySubsystem(std::unique_ptr<Subsystem> inner, const SubsystemNet& net, Injections faults,
                  const Clock& clock);
  void bind(Bindings& bindings) override;
  void call(std::uint16_t behaviour) override;
  [[nodiscard]] Outcome decide(std::uint16_t behaviour, bool failed) override {
    return inner_->decide(behaviour, failed);
  }
  [[nodiscard]] int route(std::uint16_t behaviour, bool failed) override {
    return inner_->route(behaviour, failed);
  }
  void keep_outputs() override { inner_->keep_outputs(); }
  void restore_outputs() override { inner_->restore_outputs(); }
  [[nodiscard]] Context& context() override { return inner_->context(); }

  /// Simulated time by which the last call takes longer. The next call returns zero.
  [[nodiscard]] Duration take_delay() { return std::exchange(delay_, Duration{0}); }

 private:
  void apply(Injection& fault);
  std::unique_ptr<Subsystem> inner_;
  const SubsystemNet& net_;
  Injections faults_;
  const Clock& clock_;
  std::vector<Bindings::Outgoing> outputs_;
  Duration delay_{0};
};

/// The signals among the faults. They affect the run itself.
class InjectedSignals {
 public:
  InjectedSignals() = default;
  explicit InjectedSignals(const Injections& faults);
  /// Time::max(): there are no more.
  [[nodiscard]] Time next() const { return left_.empty() ? Time::max() : left_.back()->from; }
  void raise_due(Time now);

 private:
  Injections left_;  // the last one is the next to occur
};

/// The device itself, or the device wrapped in faults.
[[nodiscard]] std::unique_ptr<RealReceptor> with_faults(std::unique_ptr<RealReceptor> device,
                                                        Injections faults, const Clock& clock);
/// safe: the safe command. The faults let it pass, because tests check whether it is given.
[[nodiscard]] std::unique_ptr<RealEffector> with_faults(std::unique_ptr<RealEffector> device,
                                                        Injections faults, const Clock& clock,
                                                        const void* safe);

}  // namespace tessera
