#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "tessera/recording.hpp"
#include "tessera/result.hpp"

namespace tessera::replay {

/// How often each transition of a net fired, summed over runs.
class FiringCounts {
 public:
  explicit FiringCounts(const net::Net& net);

  /// Adds a recorded run. Returns why that is not possible: the recording is of another net; nullopt: it was
  /// added.
  [[nodiscard]] std::optional<Problem> add(const Recording& recording);
  /// Adds runs of which only the firings are known, by the names of the transitions.
  [[nodiscard]] std::optional<Problem> add(const std::map<std::string, std::uint64_t>& firings,
                                           std::uint64_t runs);

  /// The same for a run that is followed event by event, from its beginning on.
  void begin_run() { ++runs_; }
  void fire(net::TransitionId id) { ++firings_[id.value]; }
  void mark(net::PlaceId id) { marked_[id.value] = true; }
  void lack_events() { lacks_events_ = true; }

  [[nodiscard]] std::uint64_t of(net::TransitionId id) const { return firings_[id.value]; }
  /// A run was there, in whatever way it began, and the place was marked at some time without a firing.
  [[nodiscard]] bool was_marked(net::PlaceId id) const { return marked_[id.value]; }
  [[nodiscard]] std::uint64_t runs() const { return runs_; }
  /// Events are missing in some recording: parts that are reported as not reached may have been reached.
  [[nodiscard]] bool lacks_events() const { return lacks_events_; }

 private:
  std::map<std::string, std::uint32_t> transitions_, places_;  // by name
  std::vector<std::uint64_t> firings_;                         // per transition
  std::vector<bool> marked_;                                   // per place
  std::uint64_t runs_ = 0;
  bool lacks_events_ = false;
};

/// The parts of a net that runs have reached.
///
/// Elements that no run can reach are left out: those behind a condition that is the constant false. A
/// condition has two outcomes, each of which counts: it held, and its transition fired; it did not hold, and
/// a transition fired that can fire only in this case. A failure (an exception, a device) makes an error
/// hold.
struct Coverage {
  struct Share {
    std::size_t reached = 0, all = 0;
    Share& operator+=(const Share& more);
    /// 1 if there is nothing to reach.
    [[nodiscard]] double share() const;
  };
  struct Missing {
    enum class Kind : std::uint8_t { place, transition, holds, does_not_hold } kind;
    std::string name;  ///< path of the place or the transition
    std::string text;  ///< of conditions: as in the specification; of some transitions: what they do
    net::Span span{};
  };
  /// One behaviour; or what belongs to a subsystem, an agent, the system, or all channels, and to no
  /// behaviour.
  struct Group {
    std::string path;  ///< "robot.control.follow"; of the system ""
    enum class Kind : std::uint8_t { system, agent, subsystem, behaviour, channels } kind;
    net::Span span{};
    bool reached = false;  ///< the behaviour was entered; of others: something was reached
    Share places{}, transitions{}, conditions{};
    std::vector<Missing> missing{};
  };
  std::vector<Group> groups;  ///< each behind that to which it belongs; the channels come last
  Share behaviours, places, transitions, conditions;
  std::size_t unreachable = 0;  ///< places and transitions that are left out
  std::uint64_t runs = 0;
  bool lacks_events = false;
};

/// Precondition: `net` is what `pages` are when flat, and the counts are of it.
[[nodiscard]] Coverage coverage_of(const net::HierarchicalNet& pages, const net::Net& net,
                                   const FiringCounts& counts);

/// file: the name of the specification, for its lines.
[[nodiscard]] std::string coverage_text(const Coverage& coverage, const std::string& file,
                                        const diagnostics::Sources& sources);

/// {"runs", "lacks_events", "unreachable", "behaviours", "places", "transitions", "conditions", "groups":
/// [{"path", "kind", "line", "reached", "places", "transitions", "conditions", "missing": [{"kind", "name",
/// "text", "line"}...]}...], "firings": {transition: count}}; a share is {"reached", "all"}.
[[nodiscard]] std::string coverage_json(const Coverage& coverage, const net::Net& net,
                                        const FiringCounts& counts);

}  // namespace tessera::replay
