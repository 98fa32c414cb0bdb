#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "net/net.hpp"
#include "verify/search/merging.hpp"
#include "verify/search/part_lists.hpp"
#include "verify/search/surroundings.hpp"

namespace tessera::verify {

/// All behaviours of a subsystem that do not matter count as one place, if they are many: those of a dock that serve
/// the other robots.
///
/// A behaviour *matters* if it uses a channel between the subsystems, if it has a place that is asked about, or if it
/// is one of few that give a value that is asked about. Values of what a subsystem knows count as one if no behaviour
/// gives them that matters. The outcome of the last use of a channel to others is left out.
///
/// MergedPlaces is finer, since only behaviours that follow each other count as one there. This is made in time that
/// depends on the behaviours that matter alone, not on all those of the subsystems.
class FoldedPart final : public Merging {
 public:
  /// asked: places that count for themselves. few: so many behaviours never count as one. The first three have to
  /// outlive this.
  FoldedPart(const net::Net& net, const Surroundings& surroundings, const PartLists& lists,
             const std::set<net::SubsystemId>& subsystems, const std::set<net::PlaceId>& asked,
             std::size_t few);

  /// Whether places count as one or are left out at all. If not, each place counts for itself.
  [[nodiscard]] bool is_smaller() const { return is_smaller_; }
  /// Whether the steps are not too many. Precondition of all that follows.
  [[nodiscard]] bool is_made() const { return has_all_steps_; }
  [[nodiscard]] net::PlaceId operator[](net::PlaceId place) const override;
  [[nodiscard]] bool is_merged(net::PlaceId place) const override;
  [[nodiscard]] const std::vector<net::TransitionId>* transitions(net::SubsystemId one) const override;
  [[nodiscard]] const std::vector<Step>& steps() const override { return steps_; }
  [[nodiscard]] const std::vector<net::PlaceId>& filled() const override { return filled_; }

 private:
  using Places = std::vector<net::PlaceId>;
  struct Fact {
    std::set<net::PlaceId> apart{};  ///< values that count for themselves
    bool is_merged = false;          ///< the others count as one
  };

  void find_joined();
  void find_what_matters();
  void keep_behaviours_of(net::TransitionId id);
  void find_folded();
  void find_transitions(net::SubsystemId subsystem);
  void find_values(net::SubsystemId subsystem);
  void find_steps(net::SubsystemId subsystem);
  void add_steps(const SubsystemLists::Alike& alike, const std::map<Places, std::size_t>& taken);
  [[nodiscard]] bool is_apart(net::PlaceId place) const { return apart_.contains(place.value); }
  [[nodiscard]] bool rests(net::PlaceId place) const;
  [[nodiscard]] net::PlaceId other_value(net::FactId fact) const;
  [[nodiscard]] Places counted(const Places& values, const SubsystemLists::Alike& alike) const;
  [[nodiscard]] std::size_t count(const SubsystemLists::Alike& alike, Places& values, std::size_t at) const;

  const net::Net& net_;
  const Surroundings& surroundings_;
  const PartLists& lists_;
  const std::set<net::SubsystemId>& subsystems_;
  const std::set<net::PlaceId>& asked_;
  const std::size_t few_;
  std::unordered_set<std::uint32_t> joined_{};  // places of channels between the subsystems
  std::unordered_set<std::uint32_t>
      apart_{};  // places of behaviours that matter, and those that are asked about
  std::set<std::pair<net::SubsystemId, net::BehaviourId>> matters_{};
  std::set<net::SubsystemId> folded_{};
  std::map<net::SubsystemId, std::vector<net::TransitionId>> transitions_{};
  std::unordered_map<std::uint32_t, Fact> facts_{};  // of those that are not simply left out
  bool is_smaller_ = false, has_all_steps_ = true;
  std::vector<Step> steps_{};
  std::vector<net::PlaceId> filled_{};
};

}  // namespace tessera::verify
