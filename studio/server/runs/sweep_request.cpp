#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/runs/run_parameters.hpp"
#include "server/runs/sweeps.hpp"
#include "tessera/nearest.hpp"
#include "tessera/units.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

/// "robot[*].control" of "robot[3].control".
std::string without_numbers(std::string_view path) {
  std::string pattern;
  for (std::size_t at = 0; at < path.size(); ++at) {
    pattern += path[at];
    if (path[at] != '[') continue;
    pattern += '*';
    while (at + 1 < path.size() && path[at + 1] != ']') ++at;
  }
  return pattern;
}

/// Why the text is no value of the parameter; empty: it is one.
std::string wrong_with_value(const json& parameter, const std::string& text) {
  const std::optional<Quantity> quantity = split_quantity(text);
  if (!quantity) return fmt::format("'{}' is no number", text);
  const std::string unit = parameter.at("unit");
  std::optional<double> number = quantity->number;
  if (!quantity->unit.empty()) {
    if (unit.empty()) return fmt::format("'{}': the parameter has no unit", text);
    number = converted(quantity->number, quantity->unit, unit);
  }
  if (!number) return fmt::format("'{}': the unit of the parameter is {}", text, unit);
  const std::string type = parameter.at("type");
  if (type.find("int") != std::string::npos && *number != std::trunc(*number))
    return fmt::format("'{}' is no whole number", text);
  const json &least = parameter.at("minimum"), &greatest = parameter.at("maximum");
  if (least.is_number() && *number < least.get<double>())
    return fmt::format("'{}' is less than the minimum of the parameter, {} {}", text, least.get<double>(),
                       unit);
  if (greatest.is_number() && *number > greatest.get<double>())
    return fmt::format("'{}' is more than the maximum of the parameter, {} {}", text, greatest.get<double>(),
                       unit);
  return {};
}

}  // namespace

std::string wrong_with_sweep(const spec::Model& model, const SweepRequest& request) {
  const std::size_t values = std::max<std::size_t>(1, request.values.size());
  if (request.runs < 1 || request.runs > Sweeps::most_runs || values * request.runs > Sweeps::most_runs)
    return fmt::format("a sweep has 1 to {} runs", Sweeps::most_runs);
  if (request.parameter.empty())
    return request.values.empty() ? "" : "values need the parameter that takes them";
  if (request.values.empty()) return "the parameter needs values";
  if (request.values.size() > Sweeps::most_values)
    return fmt::format("a sweep has at most {} values", Sweeps::most_values);
  std::vector<std::string> names;
  const bool all_members = request.parameter.find("[*]") != std::string::npos;
  const json parameters = RunParameters(model).shown();
  for (const json& one : parameters) {
    const std::string path = one.at("path");
    names.push_back(path);
    if ((all_members ? without_numbers(path) : path) != request.parameter) continue;
    const std::string type = one.at("type");
    const bool number = type.find('[') == std::string::npos &&
                        (type.starts_with("float") || type.starts_with("int") || type.starts_with("uint"));
    if (!number) return fmt::format("{} is no number, so it has no curve", path);
    for (const std::string& value : request.values)
      if (std::string wrong = wrong_with_value(one, value); !wrong.empty()) return wrong;
    return {};
  }
  const std::string nearest = did_you_mean(request.parameter, names).text;
  return fmt::format("there is no parameter '{}'{}", request.parameter,
                     nearest.empty() ? "" : ": " + nearest);
}

}  // namespace tessera::server
