#include "verify/verify.hpp"

#include <algorithm>
#include <utility>

#include "tessera/net_hash.hpp"
#include "verify/place_invariants.hpp"

namespace tessera::verify {
namespace {

/// The first few of a list in one line, so that a broken fleet stays readable.
std::string in_one_line(const std::vector<std::string>& mistakes) {
  constexpr std::size_t shown = 3;
  std::string line;
  for (std::size_t index = 0; index < std::min(shown, mistakes.size()); ++index)
    line += (index > 0 ? "; " : "") + mistakes[index];
  if (mistakes.size() > shown) line += "; and " + std::to_string(mistakes.size() - shown) + " more";
  return line;
}

PropertyResult safe(const net::Net& net, const std::vector<net::Invariant>& invariants) {
  PropertyResult result{"safe", Verdict::unknown, "place invariants", {}};
  std::vector<std::string> mistakes = wrong_invariants(net, invariants);
  if (mistakes.empty())
    for (const net::PlaceId place : unbounded_places(net, invariants))
      mistakes.push_back("no invariant bounds place '" + net[place].name + "'");
  if (mistakes.empty())
    result.verdict = Verdict::holds;
  else
    result.why = in_one_line(mistakes);
  return result;
}

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

}  // namespace

bool Report::all_hold() const {
  return std::ranges::all_of(
      properties, [](const PropertyResult& property) { return property.verdict == Verdict::holds; });
}

Report check(const net::Net& net, const std::vector<net::Invariant>& invariants) {
  Report report;
  report.properties.push_back(safe(net, invariants));
  report.net_hash = hash_of(net);
  report.verification_hash = hash_of_verification(net, report);
  return report;
}

std::optional<VerifiedNet> accept(net::Net net, Report report) {
  if (!report.all_hold()) return std::nullopt;
  return VerifiedNet(std::move(net), std::move(report));
}

}  // namespace tessera::verify
