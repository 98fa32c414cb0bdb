#include "verify/verify.hpp"

#include <algorithm>
#include <utility>

#include "verify/hashes.hpp"
#include "verify/invariants/place_invariants.hpp"

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
  PropertyResult result{.name = "safe", .method = "place invariants"};
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

}  // namespace

bool Report::all_hold() const {
  return std::ranges::all_of(
      properties, [](const PropertyResult& property) { return property.verdict == Verdict::holds; });
}

Verdict Report::overall() const {
  Verdict worst = Verdict::holds;
  for (const PropertyResult& property : properties) {
    if (property.warning || property.verdict == Verdict::holds) continue;
    if (property.verdict == Verdict::violated) return Verdict::violated;
    worst = Verdict::unknown;
  }
  return worst;
}

Report check(const net::Net& net, const std::vector<net::Invariant>& invariants) {
  Report report;
  report.properties.push_back(safe(net, invariants));
  report.net_hash = hash_of(net);
  report.verification_hash = verification_hash({net, nullptr, invariants}, {"safe"});
  return report;
}

std::optional<VerifiedNet> accept(net::Net net, Report report, InSpiteOf in_spite_of) {
  if (report.properties.empty()) return std::nullopt;
  for (const PropertyResult& property : report.properties) {
    if (property.warning) continue;
    if (property.verdict == Verdict::violated && !in_spite_of.violated) return std::nullopt;
    if (property.verdict == Verdict::unknown && !in_spite_of.unknown) return std::nullopt;
  }
  return VerifiedNet(std::move(net), std::move(report));
}

}  // namespace tessera::verify
