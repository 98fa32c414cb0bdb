#include "verify/search/claims.hpp"

#include <utility>

namespace tessera::verify {

using explore::Formula;
using net::Statement;

Formula formula_of(const Statement& statement) {
  std::vector<Formula> parts;
  for (const net::PlaceId place : statement.places) parts.push_back(Formula::marked(place));
  for (const Statement& part : statement.parts) parts.push_back(formula_of(part));
  switch (statement.kind) {
    case Statement::Kind::token:
    case Statement::Kind::any:
      return Formula::any(std::move(parts));
    case Statement::Kind::negation:
      return Formula::negation(std::move(parts.front()));
    case Statement::Kind::all:
      return Formula::all(std::move(parts));
  }
  return Formula::never();
}

Formula what_of(net::Property::Kind kind, const net::Claim& claim) {
  Formula what = formula_of(claim.what);
  return kind == net::Property::Kind::always ? Formula::negation(std::move(what)) : what;
}

std::string complaint(net::Property::Kind kind, const net::Claim& claim) {
  std::string about = claim.about.empty() ? "" : claim.about + ": ";
  switch (kind) {
    case net::Property::Kind::never:
      return about + "a run reaches it";
    case net::Property::Kind::always:
      return about + "a run leads to where it is not so";
    case net::Property::Kind::reachable:
      return about + "no run reaches it";
    case net::Property::Kind::always_reachable:
      return about + "a run leads to where it is out of reach for ever";
    case net::Property::Kind::leads_to:
      return about + "a run leads from where the first is true to where the second can never follow any more";
  }
  return about;
}

}  // namespace tessera::verify
