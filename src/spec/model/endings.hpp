#pragma once

#include <array>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

/// What is known of a condition before run time.
enum class Truth : std::uint8_t { free, always, never };

[[nodiscard]] Truth truth_of(const Expression& expression);
/// Any one of its expressions suffices.
[[nodiscard]] Truth truth_of(const Condition& condition);

/// How an iteration can end its behaviour.
enum class Ending : std::uint8_t {
  terminal,  ///< the terminal condition holds, the error condition does not
  error,     ///< the error condition holds
  failure  ///< user code has thrown, a device has failed, the watchdog or a check of the outputs has struck:
           ///< it counts as an error of which no named condition holds
};
inline constexpr std::array all_endings{Ending::terminal, Ending::error, Ending::failure};

/// Which entries of a behaviour's `next` can be taken, exactly as the generated controller decides: in order,
/// the first that holds. This is the only definition of that rule; net, warnings and code ask it.
///
/// Known are constants, which ending it is, that one of the expressions of the condition that ended the
/// behaviour holds, and which named ones did not, as earlier entries asked for them. Everything else is free,
/// also two expressions with the same text.
class Endings {
 public:
  /// Precondition: the behaviour outlives this.
  explicit Endings(const Behaviour& behaviour);

  /// Can the behaviour end so? By a failure, always.
  [[nodiscard]] bool possible(Ending ending) const;
  /// Is the entry the one that is taken? never also for endings that are not possible.
  [[nodiscard]] Truth taken(Index entry, Ending ending) const { return taken_[at(ending)][entry]; }
  /// Is the entry taken after some ending?
  [[nodiscard]] bool can_be_taken(Index entry) const;
  /// Can it be that no entry holds?
  [[nodiscard]] bool none_possible(Ending ending) const { return none_[at(ending)]; }

 private:
  static std::size_t at(Ending ending) { return static_cast<std::size_t>(ending); }
  void try_entries(Ending ending);

  const Behaviour& behaviour_;
  std::array<std::vector<Truth>, all_endings.size()> taken_;
  std::array<bool, all_endings.size()> none_{};
};

}  // namespace tessera::spec
