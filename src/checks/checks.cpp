#include "checks/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::checks {
namespace {

std::string written(const Check& check) {
  std::string text =
      fmt::format("{}: {}", name_of(check.when), check.text.empty() ? text_of(check.formula) : check.text);
  if (check.within_s) text += fmt::format(" within {} s", *check.within_s);
  return text;
}

void add(MeasureResult& measure, double value, double time_s) {
  if (measure.samples == 0 || value < measure.least) {
    measure.least = value;
    measure.least_at_s = time_s;
  }
  if (measure.samples == 0 || value > measure.greatest) {
    measure.greatest = value;
    measure.greatest_at_s = time_s;
  }
  ++measure.samples;
  measure.mean += (value - measure.mean) / static_cast<double>(measure.samples);
  measure.last = value;
}

}  // namespace

std::string_view name_of(Check::When when) {
  switch (when) {
    case Check::When::never:
      return "never";
    case Check::When::always:
      return "always";
    case Check::When::at_end:
      return "at_end";
    case Check::When::eventually:
      return "eventually";
  }
  return "";
}

std::string_view name_of(CheckResult::Verdict verdict) {
  switch (verdict) {
    case CheckResult::Verdict::held:
      return "held";
    case CheckResult::Verdict::failed:
      return "failed";
    case CheckResult::Verdict::open:
      return "open";
  }
  return "";
}

Result<Judge> Judge::bind(std::vector<Check> checks, const std::vector<Measure>& measures, Scene& scene) {
  Judge judge(scene);
  for (Check& check : checks) {
    Result<BoundFormulas> formulas = checks::bind(check.formula, scene);
    if (!formulas) return Problem{fmt::format("check '{}': {}", check.name, formulas.problem())};
    CheckResult result;
    result.name = check.name;
    result.text = written(check);
    judge.plotted_.emplace_back().name = check.name;
    judge.plotted_.back().is_check = true;
    judge.checks_.push_back({std::move(check), std::move(*formulas), std::move(result)});
  }
  for (const Measure& measure : measures) {
    Result<BoundNumber> number = checks::bind(measure.number, scene);
    if (!number) return Problem{fmt::format("measure '{}': {}", measure.name, number.problem())};
    judge.numbers_.push_back(std::move(*number));
    MeasureResult& result = judge.measures_.emplace_back();
    result.name = measure.name;
    result.unit = measure.unit;
    Plotted& plotted = judge.plotted_.emplace_back();
    plotted.name = measure.name;
    plotted.unit = measure.unit;
  }
  return judge;
}

std::optional<std::string> Judge::violation(const BoundCheck& one, bool wanted) {
  for (const auto& [i, formula] : one.formulas.by_index) {
    if (holds(formula, *scene_) == wanted) continue;
    const std::string facts = facts_of(formula, *scene_);
    return one.formulas.has_index ? fmt::format("i = {}: {}", i, facts) : facts;
  }
  return std::nullopt;
}

void Judge::fail(BoundCheck& one, double time_s, std::string detail) {
  one.decided = true;
  one.result.verdict = CheckResult::Verdict::failed;
  one.result.time_s = time_s;
  one.result.detail = std::move(detail);
}

void Judge::look(BoundCheck& one, double time_s) {
  if (one.check.when == Check::When::at_end) return;
  const std::optional<std::string> facts = violation(one, one.check.when != Check::When::never);
  if (one.check.when != Check::When::eventually) {
    if (facts) fail(one, time_s, *facts);
    return;
  }
  if (one.check.within_s && time_s > *one.check.within_s) {
    fail(one, *one.check.within_s, "it did not come in time; " + facts.value_or(""));
  } else if (!facts) {
    one.decided = true;
    one.result.time_s = time_s;
  }
}

void Judge::observe(double time_s) {
  for (BoundCheck& one : checks_)
    if (!one.decided) look(one, time_s);
  for (std::size_t index = 0; index < numbers_.size(); ++index)
    add(measures_[index], value_of(numbers_[index], *scene_), time_s);
  plot(time_s);
}

/// Less often than the checks are judged, since it costs as much.
void Judge::plot(double time_s) {
  constexpr double every_s = 0.04;
  for (std::size_t index = 0; index < measures_.size(); ++index)
    plotted_[checks_.size() + index].curve.add(time_s, measures_[index].last);
  if (time_s < next_plot_s_) return;
  next_plot_s_ = (std::floor(time_s / every_s + 1e-6) + 1) * every_s - 1e-6;
  for (std::size_t index = 0; index < checks_.size(); ++index) {
    const BoundCheck& one = checks_[index];
    const Shown now = shown(one.formulas, one.check.when == Check::When::never, *scene_);
    plotted_[index].limit = now.limit;
    plotted_[index].is_truth = !now.limit;
    plotted_[index].curve.add(time_s, now.value);
  }
}

void Judge::finish(double time_s) {
  for (BoundCheck& one : checks_) {
    if (one.decided) continue;
    const std::optional<std::string> facts = violation(one, one.check.when != Check::When::never);
    if (one.check.when == Check::When::at_end && facts) fail(one, time_s, *facts);
    if (one.check.when != Check::When::eventually) continue;
    if (one.check.within_s)
      one.result.verdict = CheckResult::Verdict::open;
    else
      fail(one, time_s, "it did not come; " + facts.value_or(""));
  }
}

void Judge::cut_short() {
  for (BoundCheck& one : checks_)
    if (!one.decided) one.result.verdict = CheckResult::Verdict::open;
}

std::vector<CheckResult> Judge::take_failures() {
  std::vector<CheckResult> failures;
  for (BoundCheck& one : checks_) {
    if (one.result.verdict != CheckResult::Verdict::failed || std::exchange(one.told, true)) continue;
    failures.push_back(one.result);
  }
  return failures;
}

std::vector<CheckResult> Judge::results() const {
  std::vector<CheckResult> all;
  for (const BoundCheck& one : checks_) all.push_back(one.result);
  return all;
}

}  // namespace tessera::checks
