#include "run/driver_requests.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace tessera {
namespace {

using nlohmann::json;

/// 0.3, true, "clamp", or {"number": 4, "unit": "m"}.
[[nodiscard]] WorldValue value_of(const json& value) {
  if (value.is_boolean()) return {value.get<bool>()};
  if (value.is_string()) return {value.get<std::string>()};
  if (value.is_object()) return {value.at("number").get<double>(), value.at("unit").get<std::string>()};
  return {value.get<double>()};
}

[[nodiscard]] WorldOption option_of(const json& option) {
  if (!option.is_array()) return {value_of(option)};
  std::vector<WorldValue> values;
  for (const json& value : option) values.push_back(value_of(value));
  return {std::move(values)};
}

[[nodiscard]] DriverRequest request_of(const json& driver) {
  DriverRequest request{.path = driver.at("path").get<std::string>(),
                        .kind = driver.at("kind").get<std::string>(),
                        .targets = driver.at("targets").get<std::vector<std::string>>(),
                        .options = {}};
  if (const auto options = driver.find("options"); options != driver.end())
    for (const auto& [name, option] : options->items()) request.options.emplace(name, option_of(option));
  request.units = driver.value("units", request.units);
  return request;
}

[[nodiscard]] WorldServer server_of(const json& server) {
  const std::chrono::duration<double> timeout(server.at("timeout_s").get<double>());
  return {server.at("host").get<std::string>(), server.at("port").get<std::uint16_t>(),
          server.at("scene").get<std::string>(), std::chrono::duration_cast<Duration>(timeout)};
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::optional<DriverRequest> parse_driver(const std::string& text, std::string& error) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || equals == 0 || colon == std::string::npos || colon == equals + 1) {
    error = "expected BUFFER=KIND:TARGET";
    return std::nullopt;
  }
  DriverRequest request{.path = text.substr(0, equals),
                        .kind = text.substr(equals + 1, colon - equals - 1),
                        .targets = {""},
                        .options = {}};
  std::istringstream rest(text.substr(colon + 1));
  std::getline(rest, request.targets[0], ',');
  for (std::string option; std::getline(rest, option, ',');) {
    const std::size_t sign = option.find('=');
    const std::optional<double> value =
        sign == std::string::npos ? std::nullopt : parse_number(std::string_view(option).substr(sign + 1));
    if (!value) {
      error = fmt::format("'{}' is no OPTION=NUMBER", option);
      return std::nullopt;
    }
    request.options[option.substr(0, sign)] = *value;
  }
  return request;
}

bool read_simulation_file(const std::string& path, RunOptions& options, WorldOptions& world,
                          std::string& error) {
  std::ifstream stream(path);
  if (!stream) {
    error = fmt::format("cannot read the simulation file '{}'", path);
    return false;
  }
  try {
    const json file = json::parse(stream);
    for (const json& driver : file.at("drivers")) options.drivers.push_back(request_of(driver));
    for (const json& check : file.value("use_checks", json::array()))
      options.use_checks.push_back({check.at("name").get<std::string>(),
                                    check.at("resource").get<std::string>(), check.at("most").get<double>()});
    if (const auto placed = file.find("models"); placed != file.end() && !placed->empty())
      world.models = placed->dump();
    if (const auto server = file.find("coppelia"); server != file.end()) world.server = server_of(*server);
    json judged;
    for (const char* part : {"checks", "measures"})
      if (const auto found = file.find(part); found != file.end() && !found->empty()) judged[part] = *found;
    if (!judged.is_null()) world.checks = judged.dump();
    return true;
  } catch (const json::exception& exception) {
    error = fmt::format("'{}' is no simulation file: {}", path, exception.what());
    return false;
  }
}

}  // namespace tessera
