#include "spec/properties/property_claims.hpp"

#include <utility>

namespace tessera::spec {
namespace {

using Kind = Selector::Kind;

constexpr std::size_t most_paths = 1'000'000;

/// The fleet over which an index counts; null: none.
struct Range {
  const AgentGroup* group = nullptr;

  [[nodiscard]] std::int64_t count() const { return group == nullptr ? 1 : group->count; }
};

bool is_quantifier(const Formula& formula) {
  return formula.kind == Formula::Kind::every || formula.kind == Formula::Kind::some;
}

class ClaimReader {
 public:
  ClaimReader(const PathLookup& lookup, Diagnostics& out) : lookup_(lookup), out_(out) {}

  std::vector<Claim> read(const Formula& what, const std::optional<Formula>& then) {
    Range range;
    if (!gather(what, range, false) || (then && !gather(*then, range, false))) return {};
    std::vector<Claim> claims;
    for (std::int64_t i = 0; i < range.count() && !too_many_; ++i) {
      std::optional<Statement> first = statement(what, i, 0);
      std::optional<Statement> second;
      if (then) second = statement(*then, i, 0);
      if (!first || (then && !second)) continue;
      const std::string about = range.group == nullptr ? "" : agent_of(*range.group, i);
      claims.push_back({about, std::move(*first), std::move(second)});
    }
    if (too_many_) {
      out_.error("E114", what.span, "the property speaks of more than a million paths",
                 "name fewer agents, or use [i] instead of any(...) and all(...)");
      return {};
    }
    if (claims.empty())
      out_.error("E303", what.span, "no agent fits the indices of this property",
                 "the fleet is too small for these indices, and no ring");
    return claims;
  }

 private:
  [[nodiscard]] std::string agent_of(const AgentGroup& group, std::int64_t number) const {
    return lookup_.model().agents[group.agent(static_cast<std::uint32_t>(number))].path;
  }

  [[nodiscard]] const AgentGroup* group_of(const WrittenPath& path) const {
    const auto group = lookup_.groups().find(path.agent);
    return group == lookup_.groups().end() ? nullptr : &group->second;
  }

  static bool of_system(const WrittenPath& path) {
    return path.parts.empty() && path.selector.kind == Kind::plain &&
           (path.agent == "in" || path.agent == "out");
  }

  /// Checks the agents of all paths and finds the fleets over which the indices of a scope count.
  /// quantified: `*` belongs to the scope and [i] does not; otherwise both do.
  bool gather(const Formula& formula, Range& range, bool quantified) {
    if (formula.kind == Formula::Kind::path)
      return gather(formula.path, range, quantified) &&
             (!formula.to || gather(*formula.to, range, quantified)) &&
             gather(formula, formula.compared_index, range, quantified);
    if (!is_quantifier(formula)) {
      for (const Formula& part : formula.parts)
        if (!gather(part, range, quantified)) return false;
      return true;
    }
    Range inner;
    if (!gather(formula.parts.front(), inner, true)) return false;
    if (inner.group == nullptr) {
      out_.error("E114", formula.span, "any and all need a path with [*]",
                 "for example any(robot[*].control.follow)");
      return false;
    }
    // [i] within a quantifier belongs to the surrounding scope, unless that is a
    // quantifier, which has its own.
    return quantified || gather_variables(formula.parts.front(), range);
  }

  bool gather(const WrittenPath& path, Range& range, bool quantified) {
    if (of_system(path)) return true;
    const AgentGroup* group = lookup_.find_group(path.agent, path.agent_span, out_);
    if (group == nullptr || !group->definition.valid()) return false;  // complained about
    if (!PathLookup::check_index(path.selector, *group, path.agent_span, path.index_span, out_)) return false;
    if (counts(path.selector, quantified) && !widen(range, *group, path.index_span)) return false;
    for (std::size_t part = 0; part < path.indices.size(); ++part) {
      const WrittenIndex& index = path.indices[part];
      if (!counts(index.selector, quantified)) continue;
      const AgentGroup* fleet = fleet_of(*group, path, part);
      if (fleet == nullptr) return complain_about_index(path.parts[part].name, index);
      if (!widen(range, *fleet, index.span)) return false;
    }
    return true;
  }

  /// The index of a value with which a memory cell is compared: robot[i].
  bool gather(const Formula& formula, const WrittenIndex& index, Range& range, bool quantified) {
    if (!formula.compared || !counts(index.selector, quantified)) return true;
    const AgentGroup* group =
        lookup_.find_group(formula.compared->value.name, formula.compared->value.span, out_);
    return group != nullptr && widen(range, *group, index.span);
  }

  static bool counts(const Selector& selector, bool quantified) {
    return selector.kind == Kind::all || (selector.kind == Kind::variable && !quantified);
  }

  bool complain_about_index(const std::string& name, const WrittenIndex& index) {
    out_.error("E286", index.span, "'" + name + "' is not one for each member of a fleet",
               "write it without an index");
    return false;
  }

  /// The fleet for whose members a part of a path is: a behaviour or a buffer. null: it is for none.
  [[nodiscard]] const AgentGroup* fleet_of(const AgentGroup& group, const WrittenPath& path,
                                           std::size_t part) const {
    for (const Subsystem& subsystem : lookup_.model().definitions[group.definition].subsystems) {
      if (path.parts.empty() || subsystem.name != path.parts[0].name) continue;
      const auto among = [&](const auto& all) -> const AgentGroup* {
        for (const auto& one : all)
          if (one.member && one.member->family == path.parts[part].name)
            if (const auto found = lookup_.groups().find(one.member->fleet); found != lookup_.groups().end())
              return &found->second;
        return nullptr;
      };
      if (const AgentGroup* found = among(subsystem.behaviours)) return found;
      if (const AgentGroup* found = among(subsystem.inputs)) return found;
      return among(subsystem.outputs);
    }
    return nullptr;
  }

  /// [i] within quantifiers.
  bool gather_variables(const Formula& formula, Range& range) {
    if (formula.kind == Formula::Kind::path) {
      for (const WrittenPath* path : {&formula.path, formula.to ? &*formula.to : nullptr})
        if (path != nullptr && !gather_variables(*path, range)) return false;
      return formula.compared_index.selector.kind != Kind::variable ||
             gather(formula, formula.compared_index, range, false);
    }
    for (const Formula& part : formula.parts)
      if (!gather_variables(part, range)) return false;
    return true;
  }

  bool gather_variables(const WrittenPath& path, Range& range) {
    const AgentGroup* const group = group_of(path);
    if (group == nullptr) return true;
    if (path.selector.kind == Kind::variable && !widen(range, *group, path.index_span)) return false;
    for (std::size_t part = 0; part < path.indices.size(); ++part) {
      if (path.indices[part].selector.kind != Kind::variable) continue;
      const AgentGroup* fleet = fleet_of(*group, path, part);
      if (fleet == nullptr) return complain_about_index(path.parts[part].name, path.indices[part]);
      if (!widen(range, *fleet, path.indices[part].span)) return false;
    }
    return true;
  }

  bool widen(Range& range, const AgentGroup& group, Span at) {
    if (range.group == nullptr) range.group = &group;
    if (range.group->count == group.count) return true;
    out_.error("E307", at,
               "the indices count over fleets of different sizes: " + std::to_string(range.group->count) +
                   " and " + std::to_string(group.count),
               "give both fleets the same count, or write two properties");
    return false;
  }

  /// i: the value of [i], and of [*] outside of quantifiers; star: the value of [*] within them.
  /// nullopt: an agent past the end.
  std::optional<Statement> statement(const Formula& formula, std::int64_t i, std::int64_t star,
                                     bool quantified = false) {
    Statement made;
    switch (formula.kind) {
      case Formula::Kind::path:
        return token(formula, i, quantified ? star : i);
      case Formula::Kind::every:
      case Formula::Kind::some:
        return over_all(formula, i);
      case Formula::Kind::negation:
        made.kind = Statement::Kind::negation;
        break;
      case Formula::Kind::both:
        made.kind = Statement::Kind::all;
        break;
      case Formula::Kind::either:
        made.kind = Statement::Kind::any;
        break;
    }
    for (const Formula& part : formula.parts) {
      std::optional<Statement> one = statement(part, i, star, quantified);
      if (!one) return std::nullopt;
      made.parts.push_back(std::move(*one));
    }
    return made;
  }

  /// any(...) and all(...)
  std::optional<Statement> over_all(const Formula& formula, std::int64_t i) {
    Statement made;
    made.kind = formula.kind == Formula::Kind::every ? Statement::Kind::all : Statement::Kind::any;
    Range range;
    const Formula& part = formula.parts.front();
    if (!gather(part, range, true)) return std::nullopt;
    for (std::int64_t star = 0; star < range.count() && !too_many_; ++star) {
      std::optional<Statement> one = statement(part, i, star, true);
      if (!one) return std::nullopt;
      made.parts.push_back(std::move(*one));
    }
    return made;
  }

  std::optional<Statement> token(const Formula& formula, std::int64_t i, std::int64_t star) {
    too_many_ = too_many_ || ++paths_ > most_paths;
    Statement made;
    std::optional<NetPath> path = net_path(formula.path, i, star);
    if (!path) return std::nullopt;
    made.path = std::move(*path);
    made.compared = formula.compared;
    if (made.compared && !add_index(made.compared->value, formula.compared_index, i, star))
      return std::nullopt;
    if (!formula.to) return made;
    made.to = net_path(*formula.to, i, star);
    if (!made.to) return std::nullopt;
    return made;
  }

  [[nodiscard]] std::optional<NetPath> net_path(const WrittenPath& path, std::int64_t i,
                                                std::int64_t star) const {
    if (of_system(path)) return NetPath{path.agent, {}, path.whole};
    const AgentGroup& group = *group_of(path);
    const auto number = agent_number(path.selector, group, path.selector.kind == Kind::all ? star : i);
    if (!number) return std::nullopt;
    NetPath made{agent_of(group, *number), path.parts, path.whole};
    for (std::size_t part = 0; part < path.indices.size(); ++part)
      if (!add_index(made.parts[part], path.indices[part], i, star)) return std::nullopt;
    return made;
  }

  /// "lend" becomes "lend[3]". Whether there is such a member is for the net to say; false: there is none below 0.
  static bool add_index(PathPart& part, const WrittenIndex& index, std::int64_t i, std::int64_t star) {
    if (index.selector.kind == Kind::plain) return true;
    const std::int64_t number = index.selector.kind == Kind::constant ? index.selector.number
                                : index.selector.kind == Kind::all    ? star
                                                                      : i + index.selector.number;
    if (number < 0) return false;
    part.name = name_of_member(part.name, static_cast<std::uint32_t>(number));
    return true;
  }

  const PathLookup& lookup_;
  Diagnostics& out_;
  std::size_t paths_ = 0;
  bool too_many_ = false;
};

}  // namespace

std::vector<Claim> read_claims(const Formula& what, const std::optional<Formula>& then,
                               const PathLookup& lookup, Diagnostics& out) {
  return ClaimReader(lookup, out).read(what, then);
}

}  // namespace tessera::spec
