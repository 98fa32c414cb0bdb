#include "sim/judging/judging.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "checks/parser.hpp"

namespace tessera::sim {
namespace {

using checks::Check;
using checks::CheckResult;
using nlohmann::json;

constexpr Duration period = std::chrono::milliseconds(10);

std::optional<Check::When> when_named(std::string_view name) {
  for (const Check::When when :
       {Check::When::never, Check::When::always, Check::When::at_end, Check::When::eventually})
    if (checks::name_of(when) == name) return when;
  return std::nullopt;
}

Problem unreadable(const std::string& text, const std::string& why) {
  return Problem{"the check or measure '" + text + "' cannot be read: " + why};
}

Result<Check> check_of(const json& written) {
  const auto when = when_named(written.at("when").get<std::string>());
  const auto text = written.at("formula").get<std::string>();
  checks::Parsed<checks::Formula> formula = checks::parse_formula(text, checks::no_units);
  if (!when || !formula.value) return unreadable(text, formula.mistake.text);
  Check check{written.at("name").get<std::string>(), *when, *std::move(formula.value), std::nullopt,
              written.value("text", "")};
  if (written.contains("within_s")) check.within_s = written.at("within_s").get<double>();
  return check;
}

Result<checks::Measure> measure_of(const std::string& name, const json& written) {
  const auto text = (written.is_object() ? written.at("number") : written).get<std::string>();
  checks::Parsed<checks::Number> number = checks::parse_number(text, checks::no_units);
  if (!number.value) return unreadable(text, number.mistake.text);
  return checks::Measure{name, *std::move(number.value),
                         written.is_object() ? written.value("unit", "") : std::string()};
}

json json_of(const CheckResult& result) {
  json one{{"name", result.name}, {"text", result.text}, {"verdict", checks::name_of(result.verdict)}};
  if (result.verdict == CheckResult::Verdict::failed || result.time_s > 0) one["time_s"] = result.time_s;
  if (!result.detail.empty()) one["detail"] = result.detail;
  return one;
}

json json_of(const checks::MeasureResult& result) {
  if (result.samples == 0) return nullptr;
  json one{{"least", result.least},       {"least_at_s", result.least_at_s},
           {"greatest", result.greatest}, {"greatest_at_s", result.greatest_at_s},
           {"mean", result.mean},         {"last", result.last}};
  if (!result.unit.empty()) one["unit"] = result.unit;
  return one;
}

json json_of(const checks::Judge::Plotted& plotted) {
  json one{{"name", plotted.name}, {"check", plotted.is_check}, {"every_s", plotted.curve.every_s()}};
  if (plotted.is_truth) one["truth"] = true;
  if (plotted.limit) one["limit"] = *plotted.limit;
  if (!plotted.unit.empty()) one["unit"] = plotted.unit;
  json& spans = one["spans"] = json::array();
  for (const checks::Curve::Span& span : plotted.curve.spans())
    spans.push_back(span.known ? json::array({span.least, span.greatest}) : json(nullptr));
  return one;
}

}  // namespace

Result<std::unique_ptr<Judging>> Judging::read(const std::string& text, const Physics& physics,
                                               const Eyes& eyes) {
  std::unique_ptr<Judging> judging(new Judging(physics, eyes));
  const json written = text.empty() ? json::object() : json::parse(text);
  std::vector<Check> all_checks;
  std::vector<checks::Measure> all_measures;
  for (const json& one : written.value("checks", json::array())) {
    Result<Check> check = check_of(one);
    if (!check) return Problem{check.problem()};
    all_checks.push_back(std::move(*check));
  }
  const json measures = written.value("measures", json::object());
  for (const auto& [name, one] : measures.items()) {
    Result<checks::Measure> measure = measure_of(name, one);
    if (!measure) return Problem{measure.problem()};
    all_measures.push_back(std::move(*measure));
  }
  if (all_checks.empty() && all_measures.empty()) return judging;
  Result<checks::Judge> judge = checks::Judge::bind(std::move(all_checks), all_measures, judging->scene_);
  if (!judge) return Problem{judge.problem()};
  judging->judge_ = std::move(*judge);
  return judging;
}

void Judging::after_step() {
  if (!judge_) return;
  scene_.note_contacts();
  if (physics_.time() < next_) return;
  next_ += period;
  scene_.follow_lines();
  judge_->observe(seconds(physics_.time()));
  scene_.forget_contacts();
}

void Judging::finish() {
  if (!judge_ || std::exchange(finished_, true)) return;
  static_cast<void>(physics_.state());  // it may fail only at this call
  if (physics_.failure())
    judge_->cut_short();
  else
    judge_->finish(seconds(physics_.time()));
}

std::vector<WorldFailure> Judging::take_failures() {
  std::vector<WorldFailure> failures;
  if (!judge_) return failures;
  for (const CheckResult& one : judge_->take_failures())
    failures.push_back(
        {one.name, one.detail.empty() ? one.text : one.detail + " (" + one.text + ")", one.time_s});
  return failures;
}

std::string Judging::results() const {
  if (!judge_) return {};
  json results{{"checks", json::array()}, {"measures", json::object()}};
  for (const CheckResult& one : judge_->results()) results["checks"].push_back(json_of(one));
  for (const checks::MeasureResult& one : judge_->measures()) results["measures"][one.name] = json_of(one);
  results["curves"] = json::array();
  for (const checks::Judge::Plotted& one : judge_->plotted()) results["curves"].push_back(json_of(one));
  return results.dump();
}

}  // namespace tessera::sim
