#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "explore/budget.hpp"
#include "net/net.hpp"
#include "net/token_game.hpp"

namespace tessera::verify {

/// All that some subsystems can do after a run, together with the subsystems that they communicate with,
/// directly or through others: every marking that they can reach, and how. The other subsystems stand still.
class Aftermath {
 public:
  using Run = std::vector<net::TransitionId>;
  /// The number of a marking. The run leads to `start`.
  using Number = std::uint32_t;
  static constexpr Number start = 0;
  using Markings = std::vector<bool>;  ///< per marking

  /// nullopt: there are more markings than `most`, or to see them takes too many steps. Throws
  /// explore::CutOff if the budget is spent before that.
  /// Precondition: the run is one of the net.
  [[nodiscard]] static std::optional<Aftermath> of(const net::Net& net, const Run& run,
                                                   const std::set<net::SubsystemId>& subsystems,
                                                   std::size_t most, const explore::Budget& budget);

  /// The markings from which one of the transitions can be fired, at once or later.
  [[nodiscard]] Markings can_fire(const std::vector<net::TransitionId>& any_of) const;
  /// The markings from which a marking of the goal can be reached, the goal included.
  [[nodiscard]] Markings can_reach(Markings goal) const;
  [[nodiscard]] Markings reachable_from(Number from) const;

  struct Way {
    Run run;
    Number to = start;
  };
  /// A shortest way to a marking of the goal.
  [[nodiscard]] std::optional<Way> way(Number from, const Markings& goal) const;

  /// Tokens of every place of the net.
  [[nodiscard]] std::vector<std::uint32_t> tokens(Number marking) const;
  [[nodiscard]] std::size_t size() const { return edges_.size(); }

 private:
  struct Edge {
    net::TransitionId transition;
    Number to = 0;
  };
  explicit Aftermath(const net::Net& net) : net_(&net), local_(net.places().size()) {}
  void choose(const std::set<net::SubsystemId>& subsystems);
  [[nodiscard]] std::vector<net::Arc> in_part(std::span<const net::Arc> arcs);
  void begin_after(const Run& run);
  [[nodiscard]] bool explored(std::size_t most, const explore::Budget& budget);
  Number number(const std::string& marking);

  const net::Net* net_;
  std::vector<net::TransitionId> transitions_;  // that can fire
  net::Net part_;                               // these transitions and their places, without names
  std::vector<net::PlaceId> local_;             // per place: the same in the part, if it is there
  net::Marking at_start_;                       // of the net
  std::vector<std::string> markings_;           // of the part, packed
  std::unordered_map<std::string, Number> numbers_;
  std::vector<std::vector<Edge>> edges_;
};

}  // namespace tessera::verify
