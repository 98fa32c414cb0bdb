#pragma once

#include <cstdint>
#include <vector>

#include "subsystem/subsystem_parts.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// Knows which outputs and real outputs of one subsystem have ever been written by its transition functions.
///
/// *Written.* An output is written if it is assigned as a whole, if it gets another value than it began with,
/// or if a floating-point field is assigned (tessera/write_trace.hpp). A structure without floating-point
/// fields also counts as written once every real input of the subsystem has had a value. As long as no real
/// input has had one, only another value counts: what is computed from nothing is no value.
///
/// An iteration that fails has written nothing. A real output that was never written has the safe command as
/// its value, except while a transition function runs.
///
/// Threads: the subsystem's.
class WrittenOutputs {
 public:
  /// parts must outlive it.
  explicit WrittenOutputs(SubsystemParts& parts);

  /// An iteration begins: the one before has not failed, or was undone.
  void keep();
  /// A transition function is about to be called.
  void before_call();
  /// It has returned.
  void after_call();
  /// Its iteration has failed, and the outputs are again as they were before the call.
  void undo();

  /// output: into Bindings::outputs.
  [[nodiscard]] bool has(std::uint32_t output) const { return states_[output] != State::no; }
  /// Whether to say that the output is sent as invalid: its fields may have been written with the values that
  /// they began with. True once per output.
  [[nodiscard]] bool should_explain(std::uint32_t output);

 private:
  enum class State : std::uint8_t { no, in_this_iteration, yes };
  [[nodiscard]] bool is_written(const Bindings::Outgoing& output) const;
  template <class Visit>
  void for_unwritten(Visit visit);

  SubsystemParts& parts_;
  std::vector<State> states_;  // of outputs, then of real outputs
  std::vector<bool> explained_;
  bool complete_ = false;                       // every output is written
  bool marked_ = false;                         // zeros have a minus during this call
  bool no_input_ = false, all_inputs_ = false;  // have had a value
};

}  // namespace tessera
