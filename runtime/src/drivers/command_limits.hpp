#pragma once

#include <string_view>
#include <vector>

#include "tessera/subsystem.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// Keeps the commands of a subsystem within the limits of its real outputs.
///
/// The largest change of a command is per_second times the time since the last command. For a subsystem
/// with a rate, at most one period of that time counts; for any other, at most 100 ms. So a pause does not
/// allow a jump. After the safe command has been given, it counts as the last command.
///
/// Threads: the subsystem's.
class CommandLimits {
 public:
  CommandLimits(const Bindings& bindings, Duration period);

  /// A number in a command that exceeds a limit.
  struct Excess {
    std::string_view name;  ///< "left", "pose.x"
    double asked = 0, sent = 0;
    bool fault = false;  ///< nothing must be sent
    bool begins = true;  ///< the last command kept this limit
  };
  /// Replaces the numbers that exceed their limits by numbers that may be sent. Returns the first excess
  /// that is a fault, or else the first that begins; nullptr: there is none.
  [[nodiscard]] const Excess* apply(Time now);
  /// Call it when the devices have got the safe command.
  void note_safe(Time now);
  /// Call it when the devices have got the command that `apply` has limited.
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
