#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "explore/watch.hpp"
#include "net/net.hpp"
#include "net/property.hpp"
#include "reduce/reduce.hpp"
#include "verify/subsystem_at_end.hpp"

namespace tessera::verify {

/// Part of every verification hash: verdicts of another version do not count.
inline constexpr std::string_view checker_version = "5";

enum class Verdict : std::uint8_t { holds, violated, unknown };

struct PropertyResult {
  std::string name;  ///< "safe", or the author's name
  Verdict verdict = Verdict::unknown;
  std::string asks = {};    ///< a property of the author: "always_reachable robot.motor.drive"
  std::string method = {};  ///< "place invariants"
  /// violated, unknown: the reason, in one line; live_behaviours, holds: what runs only after a failure
  std::string why = {};
  std::string meaning = {};      ///< the consequence of the verdict for the net with conditions
  std::string explanation = {};  ///< what the method did: sizes before and after reductions
  /// violated: a run that shows it, if one was found: transitions of abstract_net()
  /// (verify/communication/abstraction.hpp).
  std::vector<net::TransitionId> trace = {};
  bool has_trace = false;  ///< a trace may be empty: the initial marking is a violation
  /// violated: the waits at the end of the run, or of one that exists but was not found
  std::vector<SubsystemAtEnd> waits = {};
  struct Behaviour {
    std::string path;        ///< "robot.control.stop"
    std::uint32_t line = 0;  ///< of the specification
    std::string included{};  ///< "parts/docking.yaml:3": it is a line of an included file, and `line` is 0
    bool operator==(const Behaviour&) const = default;
  };
  /// live_behaviours: all behaviours that are known never to run (violated), or to run only after a failure
  /// (holds).
  std::vector<Behaviour> behaviours = {};
  double seconds = 0;
  std::uint64_t states = 0;  ///< markings visited
  bool warning = false;      ///< a violation is only a warning
  bool exceptions = false;   ///< verdict and trace are about the net under Assume::exceptions
  bool partition = false;    ///< the same under Assume::partition
  std::string hint = {};     ///< violated: what would help; may be empty
  /// violated: what is not shown, or not as well as it could be, because a limit of time was reached or the
  /// search was stopped: "the time limit is reached: the run is not shortened". Empty: nothing. Else
  /// the output is limited by steps, and so the same on every machine.
  std::string cut_off = {};
};

struct Report {
  std::vector<PropertyResult> properties;
  std::string net_hash;           ///< 32 hex digits, see tessera/net_hash.hpp
  std::string verification_hash;  ///< see verification_hash below

  [[nodiscard]] bool all_hold() const;
  /// Warnings do not count: violated if another property is violated; else unknown if one is
  /// unknown; else holds.
  [[nodiscard]] Verdict overall() const;
};

/// The verdicts in spite of which a net may be accepted. The caller of accept() names them.
struct InSpiteOf {
  bool unknown = false;   ///< a property that could not be decided
  bool violated = false;  ///< a property that is violated
};

/// A net together with what is known about it. Only verify makes one, so that a generator that asks for a
/// VerifiedNet cannot be given an unchecked net.
class VerifiedNet {
 public:
  [[nodiscard]] const net::Net& net() const { return net_; }
  [[nodiscard]] const Report& report() const { return report_; }

 private:
  friend std::optional<VerifiedNet> accept(net::Net net, Report report, InSpiteOf in_spite_of);
  VerifiedNet(net::Net net, Report report) : net_(std::move(net)), report_(std::move(report)) {}
  net::Net net_;
  Report report_;
};

/// Checks that each emitted invariant is one (y^T C = 0 and y m0 = total; every mistake is named) and that
/// together they bound every place by one token: property "safe". The quick form of prove.
///
/// Threads: pure. Linear in the net and the invariants.
[[nodiscard]] Report check(const net::Net& net, const std::vector<net::Invariant>& invariants);

/// The net as a VerifiedNet, if every property of the report holds, is a warning, or fails only in a way that
/// `in_spite_of` names; else nullopt. A report without properties is not enough.
[[nodiscard]] std::optional<VerifiedNet> accept(net::Net net, Report report, InSpiteOf in_spite_of = {});

// ---------------------------------------------------------------------------------------------- prove

/// The methods by name, in the order in which they are tried (docs/theory/verification.md).
[[nodiscard]] const std::vector<std::string>& method_names();

struct ProveOptions {
  std::chrono::duration<double> time{60};         ///< for all properties together, divided fairly
  std::uint64_t bytes = std::uint64_t{2} << 30U;  ///< for the markings of one search
  std::string method = {};   ///< use only this one of method_names(); empty: the first that has an answer
  reduce::Rules rules = {};  ///< reductions that may be used
  std::vector<std::string> only;  ///< names of properties; empty: all
  /// true: give up the properties that are still open. It ends within a fraction of a second.
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string& property, const explore::Progress&)> progress = nullptr;
};

/// The input of prove: the net, and the questions about it.
struct Subject {
  const net::Net& net;
  /// The pages the net was flattened from. nullptr: the net has another origin, and only has the properties
  /// safe and deadlock_free (every dead marking counts).
  const net::HierarchicalNet* pages = nullptr;
  const std::vector<net::Invariant>& invariants;
  /// Properties of the author, over places of the net. They need pages.
  std::span<const net::Property> properties{};
};

/// The names of all default properties, in the order in which they are reported. No property of an author
/// may have one of them.
[[nodiscard]] const std::vector<std::string>& default_properties();
/// Those that are judged of a net: survives_partition only of one with channels between processes.
[[nodiscard]] std::vector<std::string> default_properties_of(const net::Net& net);

/// The identity of what prove is asked: net, pages, invariants, what is known of the conditions, names of the
/// default properties, properties of the author, checker_version. Equal hashes have equal verdicts, as far as
/// there is time to find them.
///
/// Threads: pure. Linear in the net.
[[nodiscard]] std::string verification_hash(const Subject& subject,
                                            const std::vector<std::string>& properties);
/// With all default properties of the net.
[[nodiscard]] std::string verification_hash(const Subject& subject);

/// Decides the default properties and those of the author (docs/theory/verification.md).
///
/// Threads: pure, except that options.progress is called, in the same thread.
[[nodiscard]] Report prove(const Subject& subject, const ProveOptions& options = {});

}  // namespace tessera::verify
