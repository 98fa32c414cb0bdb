#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tessera/controller.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/tables.hpp"

/// Tests of a project use this header (docs/use/testing.md). The generated file tessera_testing.hpp includes it
/// and says which types belong to each Context.
namespace tessera {

/// The generated code of the subsystems whose transition functions take this Context: types `Inputs`,
/// `Memory`, `Outputs`, `Parameters`, and the function that makes a subsystem.
template <class Context>
struct GeneratedUnit;

/// Defines these for a unit of generated code. space: the namespace of the user's functions; generated: the
/// namespace of Tessera's code; nanoseconds: the period.
#define TESSERA_UNIT(space, generated, nanoseconds)                            \
  template <>                                                                  \
  struct GeneratedUnit<space::Context> {                                       \
    using Inputs = space::Inputs;                                              \
    using Memory = space::Memory;                                              \
    using Outputs = space::Outputs;                                            \
    using Parameters = space::Parameters;                                      \
    static const SubsystemNet& net() { return generated::net; }                \
    static constexpr std::unique_ptr<Subsystem> (*maker)() = &generated::make; \
    static constexpr Duration period{nanoseconds};                             \
  }

/// The data of a generated subsystem.
template <class Context>
struct SubsystemData {
  using Unit = GeneratedUnit<Context>;
  using Generated = SubsystemOf<typename Unit::Inputs, typename Unit::Memory, typename Unit::Outputs,
                                typename Unit::Parameters, Context>;

  explicit SubsystemData(Subsystem& subsystem) : SubsystemData(static_cast<Generated&>(subsystem)) {}

  typename Unit::Inputs& in;
  typename Unit::Memory& memory;
  typename Unit::Outputs& out;
  typename Unit::Parameters& parameters;
  Context& context;

 private:
  explicit SubsystemData(Generated& subsystem)
      : in(subsystem.in),
        memory(subsystem.memory),
        out(subsystem.out),
        parameters(subsystem.parameters),
        context(subsystem.context_) {}
};

/// One subsystem alone: its memory and parameters as they are at the start, and inputs that the test writes.
///
///     SubsystemUnderTest<control::Context> control;
///     control.receive(control.in.scan, wall_ahead(0.2));
///     EXPECT_EQ(control.iterate("drive"), "avoid");
///
/// Errors: std::invalid_argument: no such behaviour. Exceptions of transition functions pass through.
/// Threads: one at a time.
template <class Context>
class SubsystemUnderTest : private std::unique_ptr<Subsystem>, public SubsystemData<Context> {
  using Owner = std::unique_ptr<Subsystem>;

 public:
  using Unit = GeneratedUnit<Context>;

  SubsystemUnderTest() : Owner(Unit::maker()), SubsystemData<Context>(*static_cast<Owner&>(*this)) {
    this->context.period = Unit::period;
    start_memory();
  }

  /// Makes a value arrive in an input: it is valid and fresh until the next iteration.
  template <class T>
  void receive(Input<T>& input, const T& value, Duration age = Duration::zero()) {
    input = value;
    static_cast<Arrival&>(input) = {.fresh = true,
                                    .timed_out = false,
                                    .valid = true,
                                    .stamp = this->context.now - age,
                                    .age = age,
                                    .disconnected = false,
                                    .failed = false};
  }
  /// Makes an invalid value arrive in an input, as from a producer that failed. The input keeps its last
  /// value and the age of it.
  template <class T>
  void receive_invalid(Input<T>& input) {
    input.fresh = input.valid = false;
    input.failed = true;
  }

  /// The memory cell of a goal has that state, as if its progress had told so.
  ///
  /// Errors: std::invalid_argument: no goal has that cell.
  void tell(std::string_view cell, GoalState state) {
    Bindings bindings;
    subsystem().bind(bindings);
    const auto goal = std::find_if(bindings.goals.begin(), bindings.goals.end(),
                                   [&](const auto& one) { return one.cell == cell; });
    if (goal == bindings.goals.end()) throw std::invalid_argument("there is no goal " + std::string(cell));
    for (std::size_t fact = 0; fact < kept_.size(); ++fact)
      if (Unit::net().facts[fact].name == "memory." + std::string(cell))
        kept_[fact] = static_cast<std::uint16_t>(state);
    for (const Bindings::KeptCell& kept : bindings.kept)
      if (kept.name == cell) kept.set(kept.value, static_cast<std::uint32_t>(state));
  }

  /// A whole iteration of the behaviour: its transition function and its conditions. Returns the behaviour
  /// that follows: the same one if it goes on, "end" if the subsystem ends, and "" if no entry of `next`
  /// holds, so that the subsystem would wait for ever. Afterwards no input is fresh, and `context` is that
  /// of the next iteration.
  std::string iterate(std::string_view behaviour) {
    const std::uint16_t index = index_of(behaviour);
    subsystem().call(index);
    return decided(behaviour, subsystem().decide(index, /*failed=*/false), /*failed=*/false);
  }
  /// The same for an iteration that failed, for example by an exception or a refused command.
  std::string fail(std::string_view behaviour) {
    return decided(behaviour, subsystem().decide(index_of(behaviour), /*failed=*/true), /*failed=*/true);
  }
  /// Evaluates the conditions of the behaviour alone.
  Outcome outcome(std::string_view behaviour) { return subsystem().decide(index_of(behaviour), false); }

 private:
  Subsystem& subsystem() { return **static_cast<Owner*>(this); }

  [[nodiscard]] static std::uint16_t index_of(std::string_view behaviour) {
    const auto behaviours = Unit::net().behaviours;
    for (std::size_t index = 0; index < behaviours.size(); ++index)
      if (behaviours[index].name == behaviour) return static_cast<std::uint16_t>(index);
    throw std::invalid_argument("there is no behaviour " + std::string(behaviour));
  }

  std::string decided(std::string_view behaviour, Outcome outcome, bool failed) {
    std::string next(behaviour);
    if (outcome != Outcome::go_on) next = left(index_of(behaviour), failed || outcome == Outcome::error);
    Bindings bindings;
    subsystem().bind(bindings);
    for (auto* inputs : {&bindings.inputs, &bindings.real_inputs})
      for (const Bindings::Incoming& input : *inputs) input.arrival->fresh = false;
    ++this->context.iteration;
    this->context.now += this->context.period;
    return next;
  }

  /// The value that a place of the table stands for, of a memory cell of the net; nullopt: of none.
  [[nodiscard]] static std::optional<Does> kept_by(ArcEnd end) {
    if (end.is_shared()) return std::nullopt;
    const Does does = Unit::net().places[end.place()].does;
    const bool is_memory =
        does.kind == Does::Kind::know && Unit::net().facts[does.subject].kind == Fact::Kind::memory;
    return is_memory ? std::optional(does) : std::nullopt;
  }
  /// The memory that the net keeps, after a transition with these ends has fired.
  void give_memory(std::initializer_list<ArcEnd> outputs) {
    Bindings bindings;
    subsystem().bind(bindings);
    for (const ArcEnd end : outputs) {
      const std::optional<Does> given = kept_by(end);
      if (!given) continue;
      kept_[given->subject] = given->slot;
      const std::string_view name = Unit::net().facts[given->subject].name;
      for (const Bindings::KeptCell& cell : bindings.kept)
        if (name.substr(name.find('.') + 1) == cell.name) cell.set(cell.value, given->slot);
    }
  }
  [[nodiscard]] bool has_memory(std::initializer_list<ArcEnd> inputs) const {
    for (const ArcEnd end : inputs)
      if (const std::optional<Does> taken = kept_by(end); taken && kept_[taken->subject] != taken->slot)
        return false;
    return true;
  }
  /// Leaves a behaviour or a group by the entry of `next` that holds. Returns the behaviour that starts then.
  std::string left(std::uint16_t behaviour, bool failed) {
    const int entry = subsystem().route(behaviour, failed);
    if (entry < 0) return {};
    const Transition* first = nullptr;  // whatever memory is
    bool changed = false;
    for (const Transition& transition : Unit::net().transitions) {
      if (!leaves(transition) || transition.role.behaviour != behaviour) continue;
      const bool taken =
          transition.guard.kind != Guard::Kind::next ? entry == 0 : transition.guard.entry == entry;
      if (!taken) continue;
      if (first == nullptr) first = &transition;
      if (changed || !has_memory(transition.inputs)) continue;
      give_memory(transition.outputs);
      changed = true;
    }
    return first == nullptr ? std::string() : started_in(first->outputs.begin()->place(), failed);
  }
  [[nodiscard]] static bool leaves(const Transition& transition) {
    return transition.role.step == Step::leave || transition.role.step == Step::leave_group;
  }
  void start_memory() {
    for (const Transition& transition : Unit::net().transitions)
      if (transition.role.step == Step::start) give_memory(transition.outputs);
  }

  /// The behaviour that starts if a token comes to that place, according to the net.
  std::string started_in(std::uint16_t place, bool failed) {
    const Does does = Unit::net().places[place].does;
    if (does.kind == Does::Kind::call || does.kind == Does::Kind::begin)
      return std::string(Unit::net().behaviours[does.subject].name);
    if (does.kind == Does::Kind::route) return left(does.subject, failed);  // a group is left there
    for (const Transition& transition : Unit::net().transitions) {
      const ArcEnd from = *transition.inputs.begin();
      if (from.is_shared() || from.place() != place) continue;
      if (transition.role.step == Step::leave_group) return left(transition.role.behaviour, failed);
      if (transition.role.step == Step::begin_group)
        return started_in(transition.outputs.begin()->place(), failed);
    }
    return "end";
  }

  /// The value of each fact at the start.
  [[nodiscard]] static std::vector<std::uint16_t> initial_facts() {
    std::vector<std::uint16_t> values(Unit::net().facts.size(), 0);
    for (const Place& place : Unit::net().places)
      if (place.does.kind == Does::Kind::know && place.tokens > 0)
        values[place.does.subject] = place.does.slot;
    return values;
  }
  std::vector<std::uint16_t> kept_ = initial_facts();
};

/// A whole system under the simulated clock, without world and devices. Tests replace some subsystems by
/// scripts, feed real buffers, and watch the others. Everything else is the generated controller on its net.
///
///     SystemUnderTest system(generated_system());
///     system.script<laser::Context>([](auto& laser) { laser.out.scan = wall_ahead(0.3); });
///     system.run(std::chrono::seconds(2));
///     EXPECT_EQ(system.behaviours("robot.control").back(), "avoid");
///
/// Errors:  std::invalid_argument for a path that does not exist.
/// Threads: one at a time. Scripts and observers run in the thread of `run`.
class SystemUnderTest {
 public:
  explicit SystemUnderTest(const System& system);
  ~SystemUnderTest();
  SystemUnderTest(const SystemUnderTest&) = delete;
  SystemUnderTest& operator=(const SystemUnderTest&) = delete;

  /// Called in place of the transition functions of these subsystems, with all their data as SubsystemData.
  /// Their conditions are evaluated as usual. path: one subsystem ("robot[1].laser"); empty: all subsystems
  /// of that kind.
  template <class Context>
  void script(std::function<void(SubsystemData<Context>&)> instead, std::string_view path = {}) {
    place(GeneratedUnit<Context>::maker, path, Moment::instead, with_data<Context>(std::move(instead)));
  }
  /// Called after each transition function of these subsystems.
  template <class Context>
  void observe(std::function<void(SubsystemData<Context>&)> after, std::string_view path = {}) {
    place(GeneratedUnit<Context>::maker, path, Moment::after, with_data<Context>(std::move(after)));
  }
  /// Provides the values of a receptor's real buffer ("robot.laser.ranges"); nullopt: there is none now.
  /// Other real buffers of receptors have no values.
  template <class T>
  void sense(const std::string& path, std::function<std::optional<T>()> value) {
    check_real_buffer(path, sizeof(T));
    sensed_[path] = [value = std::move(value)](std::span<std::byte> where) {
      const std::optional<T> now = value();
      if (now) *reinterpret_cast<T*>(where.data()) = *now;
      return now.has_value();
    };
  }

  /// The other options of the run: parameters, seed, faults to inject, a recording. The test may change them.
  RunOptions options;

  /// Runs the system from its start. A failed run is reported by `failed` and `ended` of the summary.
  /// Errors: std::runtime_error if it cannot start, which says why.
  RunSummary run(Duration duration);

  /// The behaviours of that subsystem ("robot.control") in the last run, in the order in which they ran.
  /// Several iterations in a row of one behaviour count once.
  [[nodiscard]] const std::vector<std::string>& behaviours(std::string_view path) const;

 private:
  friend class TestedParts;
  using Function = std::function<void(Subsystem&)>;
  using Maker = std::unique_ptr<Subsystem> (*)();
  enum class Moment : std::uint8_t { instead, after };

  template <class Context>
  [[nodiscard]] static Function with_data(std::function<void(SubsystemData<Context>&)> function) {
    return [function = std::move(function)](Subsystem& subsystem) {
      SubsystemData<Context> data(subsystem);
      function(data);
    };
  }
  void place(Maker maker, std::string_view path, Moment moment, const Function& function);
  void check_real_buffer(const std::string& path, std::size_t bytes) const;
  [[nodiscard]] std::size_t instance_of(std::string_view path) const;

  const System& system_;
  std::vector<Function> instead_, after_;             ///< per instance
  std::vector<std::vector<std::string>> behaviours_;  ///< per instance
  std::map<std::string, std::function<bool(std::span<std::byte>)>> sensed_;
};

}  // namespace tessera
