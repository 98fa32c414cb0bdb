#include "verify/hashes.hpp"

#include <span>
#include <string_view>
#include <vector>

#include "tessera/net_hash.hpp"
#include "verify/verify.hpp"

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
      // No entry: the number that hashes have had for it from the start.
      return "next:" + std::to_string(condition.entry.value_or(UINT32_MAX));
    case Kind::elapsed:
      return "elapsed";
    case Kind::send:
      return "send";
    case Kind::skip:
      return "skip";
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

namespace {

/// A fact is hashed as a place whose name is its text: NetHash does not mind the order of places.
void fact(NetHash& hash, const std::string& text, std::uint64_t number = 0) {
  hash.place(text, static_cast<std::uint32_t>(number));
}

std::uint64_t number_of(const net::Operation& operation) {
  const std::uint32_t subject =
      operation.behaviour.valid() ? operation.behaviour.value : operation.channel.value;
  return static_cast<std::uint64_t>(operation.kind) << 24U | (subject & 0xffffffU);
}

}  // namespace

std::string verification_hash(const Subject& subject, const std::vector<std::string>& properties) {
  NetHash hash;
  fact(hash, hash_of(subject.net));
  fact(hash, std::string("checker ") += checker_version);
  for (const std::string& property : properties) fact(hash, "property " + property);
  for (const net::Property& property : subject.properties)
    fact(hash, "property " + property.name + ": " + property.text, property.claims.size());
  // In order: a run that is kept with the verdicts names transitions by number.
  for (std::uint32_t index = 0; index < subject.net.places().size(); ++index) {
    const net::Place& place = subject.net.places()[index];
    fact(hash, "place " + place.name, index);
    if (place.operation.kind != net::Operation::Kind::none)
      fact(hash, "operation at " + place.name, number_of(place.operation));
    fact(hash, "owner of " + place.name, place.fused() ? place.channel.value : place.subsystem.value);
  }
  for (std::uint32_t index = 0; index < subject.net.transitions().size(); ++index) {
    const net::Transition& transition = subject.net.transitions()[index];
    fact(hash, "transition " + transition.name, index);
    const net::Condition& condition = transition.condition;
    if (condition == net::Condition{}) continue;
    for (const bool failures : {false, true}) {
      const net::Condition::Known known = condition.known(failures);
      fact(hash,
           std::string(known.exhaustive ? "exhaustive condition" : "condition") +
               (failures ? " with failures at " : " at ") + transition.name,
           static_cast<std::uint64_t>(known.truth));
    }
  }
  if (subject.pages != nullptr)
    for (std::uint32_t page = 0; page < subject.pages->pages.size(); ++page)
      fact(hash, "page " + subject.pages->path({page}));
  for (const net::Invariant& invariant : subject.invariants) {
    std::string text = "invariant";
    for (const net::Invariant::Term& term : invariant.terms)
      text += " " + std::to_string(term.place.value) + "*" + std::to_string(term.weight);
    fact(hash, text, static_cast<std::uint64_t>(invariant.total));
  }
  return hash.hex();
}

std::string verification_hash(const Subject& subject) {
  return verification_hash(subject, default_properties_of(subject.net));
}

}  // namespace tessera::verify
