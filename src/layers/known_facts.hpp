#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "layers/wiring.hpp"
#include "net/net.hpp"
#include "spec/conditions/known_truth.hpp"
#include "spec/model/endings.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

class Sheet;
struct AskedBuffers;

/// The knowledge of the net of one subsystem while it runs: facts, each with a few values. A fact has one place per
/// value; these places hold one token together. A transition reads a fact by taking the token of one value and
/// giving it back; it changes a fact by taking the token of one value and giving that of another.
///
/// A fact of an input or output exists if a condition of the subsystem or a property asks for it and the net knows it:
/// * `in.x.fresh`, `in.x.timed_out`: the channel has a built-in model, and its receiver is not the one of NB -> NB,
///   nor one that waits for the first value only. Values: came, missed.
/// * `out.y.timed_out`: some channel of the output sends with a timeout, and all of them have built-in models.
///   Values: in_time, timed_out.
/// A memory cell with few values is a fact, asked or not. Conditions ask it by comparisons with constants; an entry
/// of `next` whose change of a counter is not always possible asks that counter, too.
/// Everything else that a condition asks stays a free choice.
class KnownFacts {
 public:
  /// Enters the facts of the subsystem, and their fusion sets, into the net.
  KnownFacts(const spec::Model& model, const Wiring& wiring, net::SubsystemId subsystem,
             net::HierarchicalNet& net);

  /// Values of facts, in the order of the facts.
  using Values = std::vector<std::pair<net::FactId, std::uint32_t>>;

  /// A list of conditions that are evaluated together asks for the facts of all of them.
  using Expressions = std::vector<const spec::Expression*>;
  /// All values of the facts that they ask for: one empty assignment if there are none. If there were more than
  /// `most_assignments`, the facts that are asked for last stay free choices.
  /// counted: entries of `next` among them, whose changes of counters are evaluated with the conditions.
  /// last: further conditions, which ask after those.
  /// behaviour: in which they are evaluated; see values_in.
  [[nodiscard]] std::vector<Values> assignments(const Expressions& expressions, spec::BehaviourId behaviour,
                                                const std::vector<const spec::Next*>& counted = {},
                                                const Expressions& last = {}) const;
  static constexpr std::size_t most_assignments = 4096;
  /// The net knows the answers of any(...), all(...) and count(...) over at most so many members of a fleet.
  static constexpr std::uint32_t most_members = 4;

  /// The truths of the conditions of a behaviour, if facts have these values.
  /// failures: any iteration, also of others, may end with a failure; then the value that came may be invalid, and
  /// thus not be fresh.
  [[nodiscard]] spec::TruthOf truths(spec::BehaviourId behaviour, const Values& values, bool failures) const;

  /// Whether the changes of an entry are possible.
  [[nodiscard]] spec::Truth allows(const spec::Next& entry, const Values& values) const;

  /// Memory before and after changes.
  struct Changed {
    Values before, after;
  };
  /// All ways in which the cells that are changed can be before, if these values are known. Without a change, and
  /// also if it is not possible with these values: once, unchanged.
  [[nodiscard]] std::vector<Changed> changed(const std::vector<spec::Change>& changes, const Values& known,
                                             spec::BehaviourId behaviour) const;
  /// The same at the start of the subsystem: every cell has its initial value.
  [[nodiscard]] Changed changed_at_start(const std::vector<spec::Change>& changes) const;
  /// The values that a fact can have in a behaviour: all, except of a cell whose values are the members of a larger
  /// fleet than `most_members`, in a subsystem without groups. Such a cell has those to which the entries of `next`
  /// lead from the start, each taken alone.
  [[nodiscard]] std::vector<std::uint32_t> values_in(net::FactId fact, spec::BehaviourId behaviour) const;
  /// The memory cells, one after the other.
  [[nodiscard]] std::vector<net::FactId> memory() const;

  /// The fact that a receive or a send over that channel sets, and how: invalid if it sets none.
  [[nodiscard]] net::FactId set_by(net::ChannelId channel, Direction direction) const;
  /// The values that a side's transitions set, by whether they end it well.
  static constexpr std::uint32_t succeeded = 0, failed = 1;

  /// The memory cell of the goal of which a receive over that channel tells; invalid: of none.
  [[nodiscard]] net::FactId goal_told_by(net::ChannelId channel) const;

  /// The place of a value.
  [[nodiscard]] net::FusionId place_of(net::FactId fact, std::uint32_t value) const {
    return {of(fact).first.value + value};
  }
  /// "grant.came"
  [[nodiscard]] std::string name_of(net::FactId fact, std::uint32_t value) const;
  [[nodiscard]] std::uint32_t value_count(net::FactId fact) const {
    return static_cast<std::uint32_t>(net_.parts[fact].values.size());
  }

 private:
  struct Fact {
    net::Parts::Fact::Kind kind{};
    std::uint32_t subject = 0;
    std::vector<net::ChannelId> channels{};  ///< whose blocks set it
    std::vector<bool> set_in{};              ///< per behaviour: each of its iterations sets it
    net::FusionId first{};                   ///< of its first value; the others follow
  };
  /// A part of a condition that asks for a fact.
  struct Question {
    net::FactId fact{};
    bool fresh = false;         ///< otherwise whether it has timed out
    std::vector<bool> holds{};  ///< of memory: per value, whether the part is true
  };

  /// The buffers that conditions ask for, by their numbers.
  struct Asked {
    std::vector<bool> inputs, outputs;
  };
  [[nodiscard]] Asked asked() const;
  void asked_by_properties(Asked& found) const;
  [[nodiscard]] bool is_known(const spec::Channel& channel, Direction direction) const;
  void find_memory();
  void find_reached(net::FactId cell);
  void list_buffers();
  [[nodiscard]] net::FactId fact_of(net::Parts::Fact::Kind kind, std::uint32_t subject) const;
  /// member: the value of `i`.
  [[nodiscard]] Question memory_in(std::span<const spec::Token> part,
                                   std::optional<std::uint32_t> member) const;
  [[nodiscard]] bool apply(const std::vector<spec::Change>& changes, Values& values) const;
  void find(const Wiring& wiring, Direction direction, const std::vector<bool>& asked);
  void add(Fact fact, const std::string& name, std::vector<std::string> values, net::Span span);
  [[nodiscard]] const Fact& of(net::FactId fact) const { return facts_[fact.value - first_.value]; }
  /// Without a fact: they are none that the net knows.
  [[nodiscard]] Question question_of(const AskedBuffers& asks) const;
  /// The questions of a part of a condition: one, or those of all members for any(...), all(...) and count(...).
  [[nodiscard]] std::vector<Question> questions_of(std::span<const spec::Token> part,
                                                   std::optional<std::uint32_t> member) const;
  [[nodiscard]] spec::Truth answer(const Question& question, spec::BehaviourId behaviour,
                                   const Values& values, bool failures) const;

  const spec::Model& model_;
  net::SubsystemId id_;
  const spec::Subsystem& subsystem_;
  net::HierarchicalNet& net_;
  net::FactId first_;
  std::vector<Fact> facts_;
  std::array<std::unordered_map<std::uint32_t, net::FactId>, 3> by_subject_;  // by kind
  std::unordered_map<std::string, std::uint32_t> inputs_, outputs_;           // numbers of the buffers
  /// Per cell with the members of a large fleet, behaviour and value.
  std::unordered_map<std::uint32_t, Numbered<spec::BehaviourId, std::vector<bool>>> reached_;
};

/// Memory whose values are the members of a large fleet (KnownFacts::values_in): if only certain behaviours run while a
/// cell has a value, and it has no other then, these behaviours and the other values exclude each other.
///
/// tokens: per instance, the invariant that says where the token of the subsystem is.
[[nodiscard]] std::vector<net::Invariant> memory_invariants(const spec::Model& model,
                                                            const net::HierarchicalNet& pages,
                                                            const net::Net& net,
                                                            const std::vector<net::Invariant>& tokens);

/// Draws a transition once for each way in which the facts that it changes can be before it. Its name then ends
/// with the values that it takes: "t_ask_1.grant.came".
class FactPen {
 public:
  FactPen(Sheet& sheet, const KnownFacts& facts) : sheet_(sheet), facts_(facts) {}

  /// reads: facts whose tokens it takes and gives back. sets: the values that it gives; a fact that is also
  /// in `reads` has the value there before.
  /// draw: draws one; its arguments are the name, and the nodes to add to the inputs and to the outputs.
  using Nodes = std::vector<std::uint32_t>;
  using Draw = std::function<void(const std::string& name, const Nodes& inputs, const Nodes& outputs)>;
  void draw(const std::string& name, const KnownFacts::Values& reads, const KnownFacts::Values& sets,
            const Draw& draw) const;

 private:
  Sheet& sheet_;
  const KnownFacts& facts_;
};

}  // namespace tessera::layers
