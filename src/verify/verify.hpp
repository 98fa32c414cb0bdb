#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// Part of every verification hash: verdicts of another version do not count.
inline constexpr std::string_view checker_version = "1";

enum class Verdict : std::uint8_t { holds, violated, unknown };

struct PropertyResult {
  std::string name;  ///< "safe"
  Verdict verdict = Verdict::unknown;
  std::string method;  ///< "place invariants"
  std::string why;     ///< for violated and unknown: in one line
};

struct Report {
  std::vector<PropertyResult> properties;
  std::string net_hash;           ///< 32 hex digits, see tessera/net_hash.hpp
  std::string verification_hash;  ///< of net_hash, truth of the conditions, properties and checker_version

  [[nodiscard]] bool all_hold() const;
};

/// A net together with what is known about it. Only verify makes one, so that a generator that asks for a
/// VerifiedNet cannot be given an unchecked net.
class VerifiedNet {
 public:
  [[nodiscard]] const net::Net& net() const { return net_; }
  [[nodiscard]] const Report& report() const { return report_; }

 private:
  friend std::optional<VerifiedNet> accept(net::Net net, Report report);
  VerifiedNet(net::Net net, Report report) : net_(std::move(net)), report_(std::move(report)) {}
  net::Net net_;
  Report report_;
};

/// Checks that each emitted invariant is one (y^T C = 0 and y m0 = total; every mistake is named) and that
/// together they bound every place by one token: property "safe".
///
/// Threads: pure. Linear in the net and the invariants.
[[nodiscard]] Report check(const net::Net& net, const std::vector<net::Invariant>& invariants);

/// The net as a VerifiedNet if every property of the report holds, else nullopt.
[[nodiscard]] std::optional<VerifiedNet> accept(net::Net net, Report report);

}  // namespace tessera::verify
