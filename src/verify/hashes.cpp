#include "verify/hashes.hpp"

#include <span>
#include <string_view>
#include <vector>

#include "tessera/net_hash.hpp"

namespace tessera::verify {
namespace {

std::string guard_of(const net::Condition& condition) {
  using Kind = net::Condition::Kind;
  switch (condition.kind) {
    case Kind::none:
      return "";
    case Kind::go_on:
      return "go_on";
    case Kind::terminal:
      return "terminal";
    case Kind::error:
      return "error";
    case Kind::next:
      return "next:" + std::to_string(condition.subject);
    case Kind::elapsed:
      return "elapsed";
  }
  return "";
}

std::vector<std::string_view> names(const net::Net& net, std::span<const net::Arc> arcs) {
  std::vector<std::string_view> all;
  for (const net::Arc& arc : arcs) all.insert(all.end(), arc.weight, net[arc.place].name);
  return all;
}

}  // namespace

std::string hash_of(const net::Net& net) {
  NetHash hash;
  for (const net::Place& place : net.places()) hash.place(place.name, place.tokens);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    hash.transition(net[id].name, names(net, net.preset(id)), names(net, net.postset(id)),
                    guard_of(net[id].condition));
  }
  return hash.hex();
}

/// The facts that the verdicts rest on are hashed as places and transitions of a net of their own.
std::string hash_of_verification(const net::Net& net, const Report& report) {
  NetHash hash;
  hash.place(report.net_hash, 0);
  hash.place(std::string("checker ") += checker_version, 0);
  for (const PropertyResult& property : report.properties)
    hash.place(property.name + " by " + property.method, static_cast<std::uint32_t>(property.verdict));
  for (const net::Transition& transition : net.transitions()) {
    if (transition.condition.truth == net::Condition::Truth::free) continue;
    const bool always = transition.condition.truth == net::Condition::Truth::always;
    hash.transition(transition.name, {}, {}, always ? "always" : "never");
  }
  return hash.hex();
}

}  // namespace tessera::verify
