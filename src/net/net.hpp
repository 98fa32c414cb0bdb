#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "net/ids.hpp"
#include "tessera/net_roles.hpp"

/// Petri nets: the hierarchical net of the five layers, and the flat net it stands for.
namespace tessera::net {

using diagnostics::Span;

/// The five layers of the paper (sec. IV).
enum class Layer : std::uint8_t { system, agent, subsystem, behaviour, communication };
inline constexpr std::size_t layer_count = 5;

/// The operation that a token starts when it is put into a place (paper, sec. II).
struct Operation {
  enum class Kind : std::uint8_t {
    none,
    transition_function,  ///< eq. (1) of `behaviour` of the place's subsystem
    next_iteration,       ///< i := i + 1
    write,                ///< output buffer into the memory of `channel`
    read                  ///< memory of `channel` into the input buffer
  } kind = Kind::none;
  BehaviourId behaviour{};  ///< transition_function
  ChannelId channel{};      ///< write, read
  std::uint32_t slot = 0;   ///< of the channel's memory, that is written or read
  bool operator==(const Operation&) const = default;
};

/// The condition of a transition.
struct Condition {
  enum class Kind : std::uint8_t {
    none,
    go_on,     ///< t4: no error, not terminal
    terminal,  ///< t5: terminal, no error
    error,     ///< t6: error
    next,      ///< `entry` of `next` of the behaviour that is left is the first whose condition holds
    elapsed,   ///< the timeout of `channel` has passed since the token's arrival
    send,      ///< the iteration sends what it may skip
    skip       ///< it does not
  } kind = Kind::none;
  /// The truth known before run time: `always` and `never` for constants, `free` for the rest.
  enum class Truth : std::uint8_t { free, always, never } truth = Truth::always;
  std::optional<std::uint32_t> entry{};  ///< next; nullopt: that no entry holds
  ChannelId channel{};                   ///< elapsed
  std::string text{};                    ///< as drawn, without the brackets; empty: nothing to draw
  /// next: however the behaviour ended, one of its entries holds ("none holds" cannot happen).
  bool exhaustive = false;
  struct Known {
    Truth truth;
    bool exhaustive;
    bool operator==(const Known&) const = default;
  };
  /// The truth if any iteration may end with a failure: user code throws, a device fails, a call takes longer
  /// than the watchdog allows. nullopt: the same as without failures.
  std::optional<Known> with_failures{};
  struct After {
    bool terminal, error;  ///< t5; t6, by a condition or a failure
    bool operator==(const After&) const = default;
  };
  /// next: the endings after which the entry can be taken; the endings after which possibly no entry holds.
  After follows{true, true}, none_follows{true, true};
  /// next: the facts that the entries ask for. The transition takes one token of each, and those of others that it
  /// changes.
  std::vector<FactId> asked{};
  bool operator==(const Condition&) const = default;

  [[nodiscard]] Known known(bool failures) const {
    return failures && with_failures ? *with_failures : Known{truth, exhaustive};
  }
  void set_with_failures(Known what) {
    if (what != known(false)) with_failures = what;
  }
};

using tessera::PlaceRole;
using tessera::Step;

/// The meaning of the numbers of a net's elements: the agents, subsystems, channels and blocks of the net.
/// Empty for a net that was not made from a specification.
struct Parts {
  struct Subsystem {
    std::string path;  ///< "robot.control"
    AgentId agent{};
    std::vector<std::string> behaviours{};
  };
  /// One side of one channel in one behaviour.
  struct Block {
    SubsystemId subsystem{};
    BehaviourId behaviour{};
    ChannelId channel{};
    bool sends = false;
    std::string name{};  ///< of its buffer; numbered if the buffer has several channels: "motion", "motion#2"
  };
  /// A variable of a subsystem that its net knows: one place per value, which hold one token together.
  struct Fact {
    enum class Kind : std::uint8_t {
      received,  ///< whether the last receive of the input `subject` has taken a value
      sent,      ///< whether the last send of the output `subject` that may time out was acknowledged in time
      memory     ///< the memory cell `subject`; its values are those of the specification
    } kind = Kind::received;
    SubsystemId subsystem{};
    std::uint32_t subject = 0;  ///< into the inputs, the outputs or the memory of the subsystem
    std::string name{};         ///< "grant", "memory.lent_to"
    std::vector<std::string> values{};
  };
  std::vector<std::string> agents{};  ///< paths
  std::vector<Subsystem> subsystems{};
  std::vector<std::string> channels{};  ///< "robot.control.motion->robot.motor.velocity"
  std::vector<Block> blocks{};
  std::vector<Fact> facts{};
  diagnostics::Sources sources{};  ///< of the lines of all spans

  [[nodiscard]] const std::string& operator[](AgentId id) const { return agents[id.value]; }
  [[nodiscard]] const Subsystem& operator[](SubsystemId id) const { return subsystems[id.value]; }
  [[nodiscard]] const std::string& operator[](ChannelId id) const { return channels[id.value]; }
  [[nodiscard]] const Block& operator[](BlockId id) const { return blocks[id.value]; }
  [[nodiscard]] const Fact& operator[](FactId id) const { return facts[id.value]; }

  /// "robot.control.follow"
  [[nodiscard]] std::string behaviour_path(SubsystemId subsystem, BehaviourId behaviour) const {
    const Subsystem& owner = (*this)[subsystem];
    return owner.path + '.' + owner.behaviours[behaviour.value];
  }
};

// ---------------------------------------------------------------------------------------------- hierarchical

/// A place or a page drawn in a net.
struct Node {
  std::string name{};        ///< local: "in", "snd", "motion.2"
  PageId page{};             ///< valid: this is a page, standing for that net
  FusionId fusion{};         ///< valid: member of that fusion set
  std::uint32_t tokens = 0;  ///< initial marking
  Operation operation{};
  PlaceRole role = PlaceRole::none;  ///< of a fused place: as its fusion set
  BlockId block{};
};

struct PageTransition {
  std::string name{};                   ///< local: "t1", "motion.t1o"
  std::vector<std::uint32_t> inputs{};  ///< indices into Page::nodes
  std::vector<std::uint32_t> outputs{};
  Condition condition{};
  Span span{};  ///< of the specification
  Step role = Step::other;
  BlockId block{};
};

/// One net of the hierarchy: what one sheet of the drawing shows.
struct Page {
  std::string name{};  ///< last part of the path: "follow"; empty for the root
  Layer layer = Layer::system;
  PageId parent{};                      ///< invalid for the root
  SubsystemId subsystem{};              ///< instance of the model that executes it, if one does
  AgentId agent{};                      ///< in the layers below the system
  BehaviourId behaviour{};              ///< in the subsystem; of a group, and from the behaviour layer down
  std::uint32_t input = 0, output = 0;  ///< indices into nodes
  std::vector<Node> nodes{};
  std::vector<PageTransition> transitions{};
  Span span{};

  /// It is that of a group of behaviours, whose net is that of a subsystem again.
  [[nodiscard]] bool is_group() const { return layer == Layer::subsystem && behaviour.valid(); }
};

/// A place seen in several nets (global fusion). Members agree on marking; at most one has an operation.
struct FusionSet {
  std::string name{};  ///< "robot.control.motion->robot.motor.velocity.full"
  std::uint32_t tokens = 0;
  ChannelId channel{};  ///< of the model: it belongs to the memory of that channel
  Span span{};
  PlaceRole role = PlaceRole::none;
  FactId fact{};            ///< it stands for a value of that fact, and belongs to its subsystem
  std::uint32_t value = 0;  ///< of that fact
};

/// Pages in an order in which parents come before children; pages[0] is the multi-agent system.
struct HierarchicalNet {
  std::vector<Page> pages;
  std::vector<FusionSet> fusions;
  Parts parts;

  /// "robot.control.follow.snd"; "" for the root.
  [[nodiscard]] std::string path(PageId page) const;
  /// The page with that path, or an invalid id.
  [[nodiscard]] PageId find(std::string_view path) const;
};

// ---------------------------------------------------------------------------------------------- flat

struct Place {
  std::string name{};  ///< path: "robot.control.follow.snd.motion.2"
  std::uint32_t tokens = 0;
  Operation operation{};
  Layer layer = Layer::system;  ///< of the page that drew it (communication for fused places)
  PageId page{};                ///< invalid for fused places
  SubsystemId subsystem{};
  ChannelId channel{};  ///< of a fused place
  Span span{};
  PlaceRole role = PlaceRole::none;
  AgentId agent{};          ///< in the layers below the system
  BehaviourId behaviour{};  ///< in the subsystem; from the behaviour layer down
  BlockId block{};
  FactId fact{};            ///< it stands for a value of that fact
  std::uint32_t value = 0;  ///< of that fact

  [[nodiscard]] bool is(Layer of_layer, PlaceRole of_role) const {
    return layer == of_layer && role == of_role;
  }
  /// It is the input or output place of a group of behaviours.
  [[nodiscard]] bool is_of_group() const { return layer == Layer::subsystem && behaviour.valid(); }
  /// It is part of the memory of a channel.
  [[nodiscard]] bool fused() const { return channel.valid(); }
};

struct Transition {
  std::string name{};
  Condition condition{};
  Layer layer = Layer::system;
  PageId page{};
  SubsystemId subsystem{};
  Span span{};
  Step role = Step::other;
  AgentId agent{};          ///< in the layers below the system
  BehaviourId behaviour{};  ///< in the subsystem; from the behaviour layer down
  BlockId block{};
};

/// An arc end: a place and a weight. The nets of the five layers only have weight 1; imported ones
/// may have more.
struct Arc {
  PlaceId place;
  std::uint32_t weight = 1;
  auto operator<=>(const Arc&) const = default;
};

/// A place/transition net with the origin of every element. Immutable once built; arcs are
/// stored per transition.
///
/// Threads: const members from any thread.
class Net {
 public:
  Net() = default;
  explicit Net(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}

  /// The meaning of the numbers of its elements. Nets made from one another share it.
  [[nodiscard]] const Parts& parts() const { return *parts_; }
  [[nodiscard]] const std::shared_ptr<const Parts>& shared_parts() const { return parts_; }

  PlaceId add(Place place);
  /// inputs and outputs: at most one arc per place each.
  TransitionId add(Transition transition, std::span<const Arc> inputs, std::span<const Arc> outputs);

  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  [[nodiscard]] const std::vector<Transition>& transitions() const { return transitions_; }
  [[nodiscard]] const Place& operator[](PlaceId id) const { return places_[id.value]; }
  [[nodiscard]] const Transition& operator[](TransitionId id) const { return transitions_[id.value]; }
  [[nodiscard]] std::span<const Arc> preset(TransitionId id) const;
  [[nodiscard]] std::span<const Arc> postset(TransitionId id) const;
  /// The channel whose memory the transition uses, by its first arc to a fused place; none: it uses none.
  [[nodiscard]] ChannelId channel_of(TransitionId id) const;
  [[nodiscard]] std::size_t arc_count() const { return arcs_.size(); }

 private:
  std::shared_ptr<const Parts> parts_ = std::make_shared<const Parts>();
  std::vector<Place> places_;
  std::vector<Transition> transitions_;
  std::vector<Arc> arcs_;              // inputs then outputs of each transition
  std::vector<std::uint32_t> starts_;  // two per transition: begin of inputs, begin of outputs
};

/// A weighted sum of places that no firing changes: sum(weight * tokens) = total in every reachable marking.
struct Invariant {
  struct Term {
    PlaceId place;
    std::int32_t weight = 1;
  };
  std::string name;  ///< what it says: "one token in robot.control"
  std::vector<Term> terms;
  std::int64_t total = 0;
};

}  // namespace tessera::net
