#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "parameters/parameters.hpp"
#include "tessera/control_messages.hpp"

namespace tessera {

/// New values of parameters while the system runs.
///
/// An operator requests a change; a value that does not fit the parameter's type and range is refused at
/// once. Each subsystem applies its changes itself, just before it calls a transition function, so that a
/// function and the conditions after it see one value.
class ParameterChanges {
 public:
  /// owners: per instance; the data that they refer to must outlive this object.
  explicit ParameterChanges(std::vector<ParameterOwner> owners);

  /// Returns the mistake in the request; nullopt: the change will take place. path: as in set_parameters.
  /// Threads: any.
  [[nodiscard]] std::optional<Problem> ask(const std::string& path, const std::string& value);
  /// The same for several, of which all will take place or none. Those of one subsystem take place at once.
  [[nodiscard]] std::optional<Problem> ask_all(std::span<const std::pair<std::string, std::string>> values);
  /// The same mistakes; nothing changes. Threads: any.
  [[nodiscard]] std::optional<Problem> try_out(const std::string& path, const std::string& value) const;
  /// Whether a subsystem here has a parameter that `path` names. Threads: any.
  [[nodiscard]] bool knows(const std::string& path) const { return has_parameter(owners_, path); }

  /// All parameters, with the values that were requested last. Threads: any.
  [[nodiscard]] std::vector<Offered::Value> offered() const;
  /// The owners: their parameters have the order of `offered`. The values are those of the subsystems.
  [[nodiscard]] std::span<const ParameterOwner> owners() const { return owners_; }

  /// Applies the changes that wait for a subsystem, in the order of the requests, and calls
  /// `tell("robot.control.v=0.3")` for each. Never waits: changes that are being requested at the moment
  /// are applied by the next call.
  /// Threads: the subsystem's.
  template <class Tell>
  void take(std::uint32_t instance, Tell&& tell) {
    Waiting& waiting = waiting_[instance];
    if (!waiting.any.load(std::memory_order_acquire)) return;
    const std::unique_lock lock(waiting.mutex, std::try_to_lock);
    if (!lock.owns_lock()) return;
    for (const Change& change : waiting.changes) {
      change.value.give();
      tell(change.text);
    }
    waiting.changes.clear();
    waiting.any.store(false, std::memory_order_relaxed);
  }

 private:
  struct Change {
    CheckedValue value;
    std::string text;
  };
  struct Waiting {
    std::atomic<bool> any{false};
    std::mutex mutex;
    std::vector<Change> changes;
  };
  [[nodiscard]] std::string note(const CheckedValue& one, const std::string& value);

  std::vector<ParameterOwner> owners_;
  std::unique_ptr<Waiting[]> waiting_;  // per instance
  /// The subsystems use the values themselves, so that no other thread may read them while the system runs.
  std::vector<Offered::Value> offered_;
  std::vector<std::size_t> first_offered_;  // per instance, into `offered_`
  mutable std::mutex offered_mutex_;
};

}  // namespace tessera
