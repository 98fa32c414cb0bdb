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
             (!formula.to || gather(*formula.to, range, quantified));
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
    const Kind kind = path.selector.kind;
    const bool counts = kind == Kind::all || (kind == Kind::variable && !quantified);
    return !counts || widen(range, *group, path);
  }

  /// [i] within quantifiers.
  bool gather_variables(const Formula& formula, Range& range) {
    if (formula.kind == Formula::Kind::path) {
      for (const WrittenPath* path : {&formula.path, formula.to ? &*formula.to : nullptr})
        if (path != nullptr && path->selector.kind == Kind::variable && group_of(*path) != nullptr &&
            !widen(range, *group_of(*path), *path))
          return false;
      return true;
    }
    for (const Formula& part : formula.parts)
      if (!gather_variables(part, range)) return false;
    return true;
  }

  bool widen(Range& range, const AgentGroup& group, const WrittenPath& path) {
    if (range.group == nullptr) range.group = &group;
    if (range.group->count == group.count) return true;
    out_.error("E307", path.index_span,
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
    return NetPath{agent_of(group, *number), path.parts, path.whole};
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
