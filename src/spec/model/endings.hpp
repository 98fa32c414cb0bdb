#pragma once

#include <array>
#include <functional>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// The truth of a condition, as far as it is known before run time.
enum class Truth : std::uint8_t { free, always, never };

[[nodiscard]] Truth truth_of(const Expression& expression);
/// The knowledge about expressions: their constants, or more at a certain marking of the net (layers/known_facts.hpp).
using TruthOf = std::function<Truth(const Expression&)>;
/// A condition holds if one of its expressions holds.
[[nodiscard]] Truth truth_of(const Condition& condition);
[[nodiscard]] Truth truth_of(const Condition& condition, const TruthOf& known);
/// Whether the changes of an entry of `next` to memory are possible: a counter stays in its range.
using Allows = std::function<Truth(const Next&)>;
[[nodiscard]] Truth allows_some(const Next& entry);

/// How an iteration can end its behaviour.
enum class Ending : std::uint8_t {
  terminal,  ///< the terminal condition holds, the error condition does not
  error,     ///< the error condition holds
  /// User code has thrown, a device has failed, the watchdog has expired, or a check of the outputs has
  /// failed. This counts as an error in which no named condition holds.
  failure
};
inline constexpr std::array all_endings{Ending::terminal, Ending::error, Ending::failure};

/// Which entries of a behaviour's `next` can be taken. The generated controller decides in the
/// same way: it takes the first entry that holds. This is the only definition of that rule;
/// net, warnings and code use it.
///
/// * After an error or a failure, an entry has to name it: `when: error`, or the name of an error expression
///   (not after a failure). If none does, the subsystem ends, and the run fails. The net draws this as the
///   entry without `when`, if that is `end`, or as an entry that complete_next has added.
/// * All other entries are tried after a terminal ending alone.
///
/// * An entry whose change of a counter is not possible does not hold (Next::may_be_blocked).
///
/// Some facts are known: constants, the kind of the ending, that one of the expressions of the condition
/// that ended the behaviour holds, and which named conditions did not hold when earlier entries asked for
/// them. `known` may say more. Everything else is free, even two expressions with the same text.
class Endings {
 public:
  /// Precondition: `behaviour` outlives this object.
  explicit Endings(const Behaviour& behaviour);
  Endings(const Behaviour& behaviour, TruthOf known, Allows allows = allows_some);

  /// Whether the behaviour can end in that way. It can always end by a failure, but for a group in which something
  /// takes every failure.
  [[nodiscard]] bool possible(Ending ending) const;
  /// Whether the entry is the one that is taken. `never` also for endings that are not possible.
  [[nodiscard]] Truth taken(NextId entry, Ending ending) const { return taken_[at(ending)][entry]; }
  /// Whether the entry is taken after some ending.
  [[nodiscard]] bool can_be_taken(NextId entry) const;
  /// Whether it is possible that no entry holds.
  [[nodiscard]] bool none_possible(Ending ending) const { return none_[at(ending)]; }
  /// Whether it is possible that an ending is an error or a failure and no entry names it. The subsystem then
  /// ends.
  [[nodiscard]] bool unrouted(Ending ending) const { return unrouted_[at(ending)]; }

 private:
  static std::size_t at(Ending ending) { return static_cast<std::size_t>(ending); }
  void try_entries(Ending ending);
  [[nodiscard]] bool asks(NextId entry, Ending ending) const;

  const Behaviour& behaviour_;
  TruthOf known_;
  Allows allows_;
  std::array<Numbered<NextId, Truth>, all_endings.size()> taken_;
  std::array<bool, all_endings.size()> none_{};
  std::array<bool, all_endings.size()> unrouted_{};
};

/// Whether the entry names an error: `when: error`, or an error expression.
[[nodiscard]] bool names_error(const Next& entry);

/// Adds the entry by which an error or a failure ends the subsystem, if the list has none that does: `end`, when
/// `error`, implied. Precondition: `next` has been read, and has no implied entry.
void complete_next(Behaviour& behaviour);

}  // namespace tessera::spec
