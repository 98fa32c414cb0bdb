#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "explore/pt_net.hpp"
#include "siphons/clauses.hpp"
#include "siphons/traps.hpp"
#include "verify/circuits/circuit_criterion.hpp"
#include "verify/waiting/skeleton.hpp"

namespace tessera::verify {

/// Searches for a set of subsystems that are stuck: each waits, at some stop, for another one of the set or
/// for one that need not come back (docs/theory/waiting.md).
///
/// Threads: one.
class WaitingCycleSearch {
 public:
  WaitingCycleSearch(const CommunicationStructure& structure, std::span<const SubsystemFlowId> subsystems,
                     explore::Watch& watch);

  enum class End : std::uint8_t {
    excluded,   ///< there is no such set
    suspected,  ///< suspected() names one
    gave_up     ///< the watch ended the search
  };
  /// May be called again after give_up_on.
  [[nodiscard]] End run();
  /// Waits that neither a channel nor a trap excludes: a cycle, or one wait for a subsystem that need not
  /// come back, or a mesh.
  [[nodiscard]] const std::vector<Wait>& suspected() const { return suspected_; }
  /// The first of the suspected waits is for a subsystem that need not come back.
  [[nodiscard]] bool deserted() const { return deserted_; }
  /// Leaves these subsystems out of further searches.
  void give_up_on(std::span<const SubsystemFlowId> subsystems);

  [[nodiscard]] std::size_t stops() const { return all().size(); }
  [[nodiscard]] std::size_t traps() const { return traps_; }

 private:
  using Stop = Skeleton::Stop;
  using Stops = std::vector<std::uint32_t>;  ///< by number

  [[nodiscard]] const std::vector<Stop>& all() const { return skeleton_.stops(); }
  void find_partners();
  void state_waits(std::span<const SubsystemFlowId> subsystems);
  void state_exclusions();
  void state_one_stage(const Stops& stops);

  [[nodiscard]] bool occupied(std::uint32_t stop) const { return clauses_.is_true(at_[stop]); }
  [[nodiscard]] Stops all_occupied() const;
  [[nodiscard]] std::vector<Stops> cycles() const;
  [[nodiscard]] bool refine(const Stops& stops);
  [[nodiscard]] siphons::PlaceSet empty_at(const Stops& stops) const;
  [[nodiscard]] int leaving_empty(const siphons::PlaceSet& trap, std::uint32_t stop);
  void suspect(const Stops& stops);

  const CommunicationStructure& structure_;
  Skeleton skeleton_;
  explore::PtNet net_;
  siphons::Clauses clauses_;
  std::vector<Stops> stops_of_;           // per subsystem
  std::vector<int> at_;                   // per stop: a subsystem is stuck there
  std::vector<int> stuck_;                // per subsystem
  std::vector<SubsystemFlowId> partner_;  // per stop; none: no behaviour uses the other end
  std::vector<bool> deserts_;             // per stop: the partner need not come back
  std::map<Stops, int> one_of_;
  std::vector<Wait> suspected_;
  bool deserted_ = false;
  std::size_t traps_ = 0;
};

}  // namespace tessera::verify
