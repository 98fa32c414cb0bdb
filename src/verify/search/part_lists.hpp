#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "net/net.hpp"
#include "verify/search/surroundings.hpp"

/// The lists that parts of a net ask for, made once for all of them.
namespace tessera::verify {

/// A subsystem whose behaviours may count as one place. That place and those for values of what it knows are none of
/// the net; they have numbers behind its places.
struct SubsystemLists {
  static constexpr std::size_t most_values = 4;  // of memory, that a transition takes and gives

  /// Transitions that are the same step once all behaviours count as one place, but for the values of memory.
  struct Alike {
    std::vector<net::PlaceId> in{}, out{};  ///< without facts and places of channels to others
    std::vector<net::FactId> taken, given;  ///< of memory, sorted
    std::map<std::vector<net::PlaceId>, std::size_t>
        count{};  ///< by values, first taken then given; invalid: any
  };
  struct Fact {
    std::set<net::PlaceId> values{};  ///< that transitions take or give
    std::set<net::PlaceId>
        given_first{};  ///< by transitions that touch places which never count as one with others
    std::vector<net::PlaceId> filled{};  ///< values that hold a token at the start
    bool is_one_token = true;            ///< no transition gives more values than it takes
    bool is_memory = false;

    [[nodiscard]] bool may_merge() const { return values.size() > 1 && is_one_token && filled.size() < 2; }
  };
  /// A transition of those that are alike, with its values.
  struct Entry {
    std::uint32_t alike = 0;
    std::vector<net::PlaceId> values{};
  };

  /// The places of its steps have at most one token, so that behaviours can count as one place.
  bool is_one_token = false;
  /// From its start on they always have one.
  bool keeps_token = false;
  net::PlaceId rest{};                                                 ///< that place
  std::map<net::BehaviourId, std::vector<net::PlaceId>> behaviours{};  ///< places that may count as one
  std::vector<net::PlaceId> others{};                                  ///< more places of what it does
  std::vector<net::PlaceId> filled{};                                  ///< at the start
  std::map<net::FactId, Fact> facts{};
  std::vector<net::FactId> special{};  ///< those that may not merge, or that have values in given_first
  std::vector<Alike> alike{};
  std::unordered_map<std::uint32_t, Entry> entries{};  ///< by transition
  std::vector<net::TransitionId> single{};             ///< the others, sorted
};

/// Threads: one.
class PartLists {
 public:
  using Subsystems = std::set<net::SubsystemId>;

  /// Both have to outlive this. Linear in the net.
  PartLists(const net::Net& net, const Surroundings& surroundings);

  /// Transitions of subsystems with an arc from or to the place, those of a subsystem together and sorted.
  [[nodiscard]] std::span<const net::TransitionId> touching(net::PlaceId place) const;
  /// Places of channels that exactly these use, two or more.
  [[nodiscard]] const std::vector<net::PlaceId>& used_by(const Subsystems& users) const;
  /// Places of the channels whose members are exactly these.
  [[nodiscard]] const std::vector<net::PlaceId>& of_channels(const Subsystems& members) const;
  /// Linear in the subsystem when it is first asked for.
  [[nodiscard]] const SubsystemLists& operator[](net::SubsystemId subsystem) const;

  /// Whether the place is of what the subsystem does, and may count as one with others.
  [[nodiscard]] bool may_merge(net::PlaceId place, net::SubsystemId subsystem) const;
  /// The place that stands for values of a fact.
  [[nodiscard]] net::PlaceId stands_for(net::FactId fact) const;

 private:
  class Maker;
  const net::Net& net_;
  const Surroundings& surroundings_;
  std::vector<std::uint32_t> starts_;  // per place, into touching_
  std::vector<net::TransitionId> touching_;
  std::map<Subsystems, std::vector<net::PlaceId>> used_by_, of_channels_;
  mutable std::unordered_map<std::uint32_t, std::unique_ptr<const SubsystemLists>> subsystems_;
};

}  // namespace tessera::verify
