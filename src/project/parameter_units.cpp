#include "project/parameter_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "spec/values/quantities.hpp"
#include "spec/values/unit_conversion.hpp"

namespace tessera::project {
namespace {

/// "robot[3].control" as "robot.control": all agents of a fleet have the same parameters.
std::string without_indices(std::string_view path) {
  std::string text;
  bool inside = false;
  for (const char c : path) {
    inside = inside || c == '[';
    if (!inside) text += c;
    if (c == ']') inside = false;
  }
  return text;
}

/// The parameters that a path may mean.
std::vector<const spec::Parameter*> parameters_at(const spec::Model& model, std::string_view path) {
  const std::size_t dot = path.rfind('.');
  const std::string_view name = dot == std::string_view::npos ? path : path.substr(dot + 1);
  std::vector<const spec::Parameter*> found;
  const auto add_of = [&](const std::vector<spec::Parameter>& parameters) {
    for (const spec::Parameter& one : parameters)
      if (one.name == name) found.push_back(&one);
  };
  add_of(model.parameters);
  for (const spec::InstanceId index : model.instances.ids())
    if (const std::string own = without_indices(model.instance_path(index)),
        given = without_indices(path.substr(0, dot));
        dot == std::string_view::npos || given == own || given == own.substr(0, own.rfind('.')))
      add_of(model.subsystem(index).parameters);
  return found;
}

std::runtime_error refusal(std::string_view path, const std::string& value, const spec::Parameter& parameter,
                           const spec::Quantity& given) {
  const std::string& unit = parameter.type.unit;
  if (!unit.empty())
    return std::runtime_error(
        fmt::format("{} = {}: the parameter is in {}; write a number in {}", path, value, unit, unit));
  const auto si = spec::in_si(given);
  return std::runtime_error(
      fmt::format("{} = {}: the parameter has no unit; write the number alone: {}{}", path, value,
                  si ? fmt::format("{}", si->number) : std::string(given.digits),
                  si && si->unit != given.unit ? fmt::format(" if it is in {}", si->unit) : ""));
}

}  // namespace

namespace {

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

/// Converts each element of "[5 cm, 3 cm]".
std::string elements_without_unit(const spec::Model& model, std::string_view path, std::string_view inside) {
  std::string text;
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = inside.find(',');
    text += (text.empty() ? "" : ", ") + without_unit(model, path, trimmed(inside.substr(0, end)));
    if (end != std::string_view::npos) inside.remove_prefix(end + 1);
  }
  return "[" + text + "]";
}

}  // namespace

std::string without_unit(const spec::Model& model, std::string_view path, const std::string& value) {
  const bool is_list = value.starts_with('[') && value.ends_with(']');
  const bool is_array = std::ranges::any_of(parameters_at(model, path),
                                            [](const spec::Parameter* one) { return one->type.extent > 0; });
  if (is_array && (is_list || value.find(',') != std::string::npos))
    return elements_without_unit(model, path,
                                 is_list ? std::string_view(value).substr(1, value.size() - 2) : value);
  const auto given = spec::split_quantity(value);
  if (!given || given->unit.empty()) return value;
  for (const spec::Parameter* parameter : parameters_at(model, path)) {
    if (parameter->type.kind != spec::Type::Kind::scalar || parameter->type.scalar == spec::Scalar::boolean)
      return value;
    if (parameter->type.unit == given->unit) return std::string(given->digits);
    const auto number = spec::converted(*given, parameter->type.unit);
    if (!number) throw refusal(path, value, *parameter, *given);
    return fmt::format("{}", *number);
  }
  return value;  // an unknown parameter, which is said elsewhere
}

}  // namespace tessera::project
