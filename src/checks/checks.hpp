#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "checks/binding.hpp"
#include "checks/curve.hpp"
#include "checks/expression.hpp"
#include "checks/scene.hpp"
#include "tessera/result.hpp"

namespace tessera::checks {

/// A check of a specification: `{ name: nobody touches, never: "contact(robot[*], robot[*])" }`.
struct Check {
  enum class When : std::uint8_t { never, always, at_end, eventually };
  std::string name;
  When when = When::never;
  Formula formula;
  std::optional<double> within_s;  ///< of eventually, from the start of the run
  std::string text;                ///< of the formula, as its author wrote it; empty: not known
};
[[nodiscard]] std::string_view name_of(Check::When when);

/// A number to report at the end: `{ nearest: "distance(robot[*], robot[*])" }`.
struct Measure {
  std::string name;
  Number number;
  std::string unit{};  ///< "m/s"; empty: none, or not known
};

struct CheckResult {
  std::string name;
  std::string text;  ///< "never: contact(robot[*], robot[*])"
  enum class Verdict : std::uint8_t {
    held,
    failed,
    open  ///< the run ended, or its world failed, before it could be decided
  } verdict = Verdict::held;
  double time_s = 0;   ///< failed: when first; eventually, held: when it came
  std::string detail;  ///< failed: the facts of that instant
};
[[nodiscard]] std::string_view name_of(CheckResult::Verdict verdict);

struct MeasureResult {
  std::string name;
  std::uint64_t samples = 0;
  double least = 0, greatest = 0, mean = 0, last = 0;
  double least_at_s = 0, greatest_at_s = 0;
  std::string unit;  ///< as Measure::unit
};

/// Judges the checks and takes the measures of one run.
class Judge {
 public:
  /// Problem: with the name of the check or measure. scene: must outlive this object.
  [[nodiscard]] static Result<Judge> bind(std::vector<Check> checks, const std::vector<Measure>& measures,
                                          Scene& scene);

  /// Looks at this instant.
  void observe(double time_s);
  /// Judges what holds at the end. Call it once, after the last observe.
  void finish(double time_s);
  /// Replaces finish if the world has failed: undecided checks stay open.
  void cut_short();

  /// Checks that have failed since the last call.
  [[nodiscard]] std::vector<CheckResult> take_failures();
  [[nodiscard]] std::vector<CheckResult> results() const;
  [[nodiscard]] const std::vector<MeasureResult>& measures() const { return measures_; }
  /// The course of a check or measure, for a plot.
  struct Plotted {
    std::string name;
    bool is_check = false;
    bool is_truth = false;        ///< 1 or 0: whether the formula held
    std::optional<double> limit;  ///< of a check that compares with it
    std::string unit;             ///< of a measure, as Measure::unit
    Curve curve;
  };
  [[nodiscard]] const std::vector<Plotted>& plotted() const { return plotted_; }

 private:
  struct BoundCheck {
    Check check;
    BoundFormulas formulas;
    CheckResult result;
    bool decided = false, told = false;
  };
  explicit Judge(Scene& scene) : scene_(&scene) {}
  void plot(double time_s);
  void look(BoundCheck& one, double time_s);
  void fail(BoundCheck& one, double time_s, std::string detail);
  /// nullopt: the formula holds for every i (wanted) or for none (not wanted); else the facts.
  [[nodiscard]] std::optional<std::string> violation(const BoundCheck& one, bool wanted);

  Scene* scene_;
  std::vector<BoundCheck> checks_;
  std::vector<BoundNumber> numbers_;
  std::vector<MeasureResult> measures_;
  std::vector<Plotted> plotted_;  // the checks, then the measures
  double next_plot_s_ = 0;
};

}  // namespace tessera::checks
