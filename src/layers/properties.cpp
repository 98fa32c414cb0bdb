#include "layers/properties.hpp"

#include <utility>

#include "layers/net_paths.hpp"

namespace tessera::layers {
namespace {

std::optional<net::Statement> translated(const spec::Statement& statement, const NetPaths& paths,
                                         diagnostics::Diagnostics& out) {
  using Kind = net::Statement::Kind;
  net::Statement made;
  switch (statement.kind) {
    case spec::Statement::Kind::token:
      return paths.find(statement, out);
    case spec::Statement::Kind::negation:
      made.kind = Kind::negation;
      break;
    case spec::Statement::Kind::all:
      made.kind = Kind::all;
      break;
    case spec::Statement::Kind::any:
      made.kind = Kind::any;
      break;
  }
  bool complete = true;
  for (const spec::Statement& part : statement.parts) {
    std::optional<net::Statement> one = translated(part, paths, out);
    complete = complete && one;
    if (one) made.parts.push_back(std::move(*one));
  }
  return complete ? std::optional(std::move(made)) : std::nullopt;
}

std::optional<net::Claim> translated(const spec::Claim& claim, const NetPaths& paths,
                                     diagnostics::Diagnostics& out) {
  std::optional<net::Statement> what = translated(claim.what, paths, out);
  std::optional<net::Statement> then = net::Statement{};
  if (claim.then) then = translated(*claim.then, paths, out);
  if (!what || !then) return std::nullopt;
  return net::Claim{claim.about, std::move(*what), std::move(*then)};
}

net::Property::Kind kind_of(spec::Property::Kind kind) {
  switch (kind) {
    case spec::Property::Kind::never:
      return net::Property::Kind::never;
    case spec::Property::Kind::always:
      return net::Property::Kind::always;
    case spec::Property::Kind::reachable:
      return net::Property::Kind::reachable;
    case spec::Property::Kind::always_reachable:
      return net::Property::Kind::always_reachable;
    case spec::Property::Kind::leads_to:
      return net::Property::Kind::leads_to;
  }
  return net::Property::Kind::never;
}

}  // namespace

std::optional<std::vector<net::Property>> properties(const spec::Model& model,
                                                     const net::HierarchicalNet& pages, const net::Net& net,
                                                     diagnostics::Diagnostics& out) {
  std::vector<net::Property> all;
  if (model.properties.empty()) return all;
  const NetPaths paths(model, pages, net);
  bool complete = true;
  for (const spec::Property& property : model.properties) {
    net::Property made;
    made.kind = kind_of(property.kind);
    made.name = property.name;
    made.text = std::string(spec::name_of(property.kind)) + " " + property.text;
    made.span = property.span;
    for (const spec::Claim& claim : property.claims) {
      std::optional<net::Claim> one = translated(claim, paths, out);
      complete = complete && one;
      if (!one) break;  // the other agents of the fleet would say the same
      made.claims.push_back(std::move(*one));
    }
    all.push_back(std::move(made));
  }
  return complete ? std::optional(std::move(all)) : std::nullopt;
}

}  // namespace tessera::layers
