#include "compiled_formula.hpp"

#include <algorithm>
#include <stdexcept>

namespace oracle {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

std::string bracketed(int index) { return "[" + std::to_string(index) + "]"; }

/// The agent before the first of these patterns; empty: none.
std::string patterned_agent(const std::string& path) {
  for (const char* pattern : {"[*]", "[i]", "[i+1]"}) {
    const std::size_t at = path.find(pattern);
    if (at == std::string::npos) continue;
    std::size_t begin = at;
    while (begin > 0 &&
           (std::isalnum(static_cast<unsigned char>(path[begin - 1])) != 0 || path[begin - 1] == '_'))
      --begin;
    return path.substr(begin, at - begin);
  }
  return {};
}

class Compiler {
 public:
  Compiler(const Specification& specification, const FlatNet& net)
      : specification_(specification), net_(net) {}

  /// The fleet that a formula is said of member by member; empty: none.
  std::string fleet(const Formula& formula) const {
    if (formula.kind == Formula::Kind::any || formula.kind == Formula::Kind::all) return {};
    if (formula.kind == Formula::Kind::path) return patterned_agent(formula.path);
    for (const Formula& part : formula.parts)
      if (const std::string of = fleet(part); !of.empty()) return of;
    return {};
  }
  bool speaks_of_next(const Formula& formula) const {
    return formula.path.find("[i+1]") != std::string::npos ||
           std::any_of(formula.parts.begin(), formula.parts.end(),
                       [&](const Formula& part) { return speaks_of_next(part); });
  }

  Compiled compile(const Formula& formula, int index, int next) const {
    Compiled compiled;
    compiled.kind = formula.kind;
    if (formula.kind == Formula::Kind::path) {
      std::string path = replaced(replaced(formula.path, "[i]", bracketed(index)), "[*]", bracketed(index));
      compiled.places = lookup(replaced(path, "[i+1]", bracketed(next)));
    } else if (formula.kind == Formula::Kind::any || formula.kind == Formula::Kind::all) {
      compiled.kind = formula.kind == Formula::Kind::any ? Formula::Kind::any_of : Formula::Kind::all_of;
      for (int i = 0; i < fleet_of(specification_, patterned_agent(formula.path)).count; ++i) {
        Compiled part;
        part.places = lookup(replaced(formula.path, "[*]", bracketed(i)));
        compiled.parts.push_back(part);
      }
    } else {
      for (const Formula& part : formula.parts) compiled.parts.push_back(compile(part, index, next));
    }
    return compiled;
  }

 private:
  std::vector<int> lookup(const std::string& written) const {
    const std::string path = replaced(written, " ", "");
    if (path.find(".memory.") != std::string::npos) return lookup_memory(path);
    std::vector<int> places;
    for (std::size_t p = 0; p < net_.places.size(); ++p) {
      const auto& place = net_.places[p];
      if (place.name.find(".out.none") != std::string::npos)
        continue;  // it has left the behaviour, says docs/theory/verification.md, and does nothing any more
      if (place.name != path && (place.fused || !place.name.starts_with(path + "."))) continue;
      places.push_back(static_cast<int>(p));
    }
    if (places.empty()) throw std::logic_error("no place " + path);
    return places;
  }

  /// "a.control.memory.c0==v1": the places of the values that fit.
  std::vector<int> lookup_memory(const std::string& path) const {
    const std::size_t at = path.find_first_of("=!<>"), behind = path.find_first_not_of("=!<>", at);
    const std::string comparison = path.substr(at, behind - at), other = path.substr(behind);
    std::vector<int> places;
    for (const FlatNet::FactInfo& fact : net_.facts) {
      const FlatNet::SubsystemInfo& owner = net_.subsystems[static_cast<std::size_t>(fact.subsystem)];
      if (fact.cell < 0 || owner.path + "." + fact.buffer != path.substr(0, at)) continue;
      const bool counts = owner.of->memory[static_cast<std::size_t>(fact.cell)].least >= 0;
      for (std::size_t value = 0; value < fact.values.size(); ++value)
        if (counts ? compares(comparison, std::stoi(fact.values[value]), std::stoi(other))
                   : (fact.values[value] == other) == (comparison == "=="))
          places.push_back(fact.places[value]);
    }
    if (places.empty()) throw std::logic_error("no memory " + path);
    return places;
  }

  const Specification& specification_;
  const FlatNet& net_;
};

}  // namespace

bool Compiled::holds(const Marking& marking) const {
  const auto holds_here = [&](const Compiled& part) { return part.holds(marking); };
  switch (kind) {
    case Formula::Kind::negation:
      return !parts[0].holds(marking);
    case Formula::Kind::all_of:
      return std::all_of(parts.begin(), parts.end(), holds_here);
    case Formula::Kind::any_of:
      return std::any_of(parts.begin(), parts.end(), holds_here);
    default:
      return tokens_in(marking, places) > 0;
  }
}

std::vector<CompiledProperty> compile(const Specification& specification, const FlatNet& net,
                                      const Property& property) {
  const Compiler compiler(specification, net);
  const bool two = property.kind == Property::Kind::leads_to;
  std::string agent = compiler.fleet(property.first);
  if (agent.empty() && two) agent = compiler.fleet(property.second);
  const Fleet fleet = agent.empty() ? Fleet{1, false} : fleet_of(specification, agent);
  const bool next =
      compiler.speaks_of_next(property.first) || (two && compiler.speaks_of_next(property.second));
  std::vector<CompiledProperty> all;
  for (int i = 0; i < fleet.count; ++i) {
    if (next && i + 1 == fleet.count && !fleet.ring) continue;
    const int after = (i + 1) % fleet.count;
    all.push_back({compiler.compile(property.first, i, after),
                   two ? compiler.compile(property.second, i, after) : Compiled{}});
  }
  return all;
}

}  // namespace oracle
