#pragma once

#include <string_view>
#include <vector>

#include "tessera/subsystem.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Keeps the commands of a subsystem within the limits of its real outputs.
///
/// The most that a command may change is per_second times the time since the last one. A subsystem with a
/// rate counts at most one period of that, any other at most 100 ms, so that a pause does not save up a jump.
/// The safe command counts as the last one when it has been given.
///
/// Threads: the subsystem's.
class CommandLimits {
 public:
  CommandLimits(const Bindings& bindings, Duration period);

  /// A number that was asked for and may not be sent.
  struct Excess {
    std::string_view name;  ///< "left", "pose.x"
    double asked = 0, sent = 0;
    bool fault = false;  ///< nothing must be sent
    bool begins = true;  ///< the last command kept to this limit
  };
  /// Puts what may be sent in the place of what may not. Returns the first excess that is a fault, else the
  /// first that begins; nullptr: there is none.
  [[nodiscard]] const Excess* apply(Time now);
  /// The devices have got the safe command.
  void note_safe(Time now);
  /// They have got what `apply` has left.
  void note_sent(Time now);

 private:
  struct Limited {
    const Bindings::RealLimit* limit;
    std::vector<double> last;  // of each element
    bool exceeded = false;     // by the last command
  };
  [[nodiscard]] void* place(const Limited& one) const;
  void limit(Limited& one, double allowed_s, Excess& excess);

  const Bindings* bindings_;
  Duration most_;
  std::vector<Limited> limited_;
  Time last_{};
  Excess excess_;
};

}  // namespace tessera
