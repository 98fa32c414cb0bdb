#include "project/files/simulation_file.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "project/files/chosen_world.hpp"
#include "project/files/installation.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

WorldValue value_of(const spec::DriverOption& option) {
  WorldValue value;
  std::visit([&](const auto& one) { value.value = one; }, option.value);
  value.unit = option.unit;
  return value;
}

WorldOption option_of(const spec::DriverOption& option) {
  if (!option.is_list) return {value_of(option)};
  std::vector<WorldValue> values;
  for (const spec::DriverOption& one : option.list) values.push_back(value_of(one));
  return {std::move(values)};
}

Json json_of(const WorldValue& value) {
  const Json bare = std::visit([](const auto& one) { return Json(one); }, value.value);
  return value.unit.empty() ? bare : Json{{"number", bare}, {"unit", value.unit}};
}

Json json_of(const WorldOption& option) {
  if (!option.is_list) return json_of(option.values.at(0));
  Json list = Json::array();
  for (const WorldValue& value : option.values) list.push_back(json_of(value));
  return list;
}

Json json_of(const DriverRequest& request) {
  Json driver{{"path", request.path}, {"kind", request.kind}, {"targets", request.targets}};
  for (const auto& [name, option] : request.options) driver["options"][name] = json_of(option);
  if (!request.units.empty()) driver["units"] = request.units;
  return driver;
}

Json json_of(const spec::ModelPlacement& placement, const fs::path& project) {
  Json json{{"instance", placement.instance}, {"agent", placement.is_agent}};
  json["model"] = find_asset(placement.model, project, "worlds").value_or(placement.model).string();
  if (placement.at_m) json["at_m"] = *placement.at_m;
  json["heading_rad"] = placement.heading_rad;
  if (!placement.pose.empty()) json["pose"] = placement.pose;
  if (!placement.scatter.empty()) json["scatter"] = placement.scatter;
  if (placement.apart_m > 0) json["apart_m"] = placement.apart_m;
  for (const auto& [name, ends] : placement.vary) json["vary"][name] = {ends.first, ends.second};
  return json;
}

Json models_of(const spec::Simulation& simulation, const fs::path& project) {
  Json models = Json::array();
  for (const spec::ModelPlacement& placement : simulation.models)
    models.push_back(json_of(placement, project));
  return models;
}

Json json_of(const WorldServer& server) {
  return {{"host", server.host},
          {"port", server.port},
          {"scene", server.scene},
          {"timeout_s", seconds(server.timeout)}};
}

Json json_of(const checks::Check& check) {
  Json json{{"name", check.name},
            {"when", checks::name_of(check.when)},
            {"formula", checks::text_of(check.formula)}};
  if (check.within_s) json["within_s"] = *check.within_s;
  if (!check.text.empty()) json["text"] = check.text;
  return json;
}

Json json_of(const checks::Measure& measure) {
  return {{"number", checks::text_of(measure.number)}, {"unit", measure.unit}};
}

bool has_unit(const spec::Model& model, const spec::Type& type) {
  if (type.kind != spec::Type::Kind::structure) return !type.unit.empty();
  return std::ranges::any_of(model.structures[type.structure].fields,
                             [&](const spec::Field& field) { return has_unit(model, field.type); });
}

/// One for each scalar, in the order of the layout.
void add_units(const spec::Model& model, const spec::Type& type, std::vector<std::string>& units) {
  for (std::size_t element = 0; element < std::max<std::size_t>(type.extent, 1); ++element)
    if (type.kind == spec::Type::Kind::structure)
      for (const spec::Field& field : model.structures[type.structure].fields)
        add_units(model, field.type, units);
    else
      units.push_back(type.unit);
}

}  // namespace

DriverRequest request_of(const spec::Model& model, const spec::Driver& driver) {
  DriverRequest request{.path = model.driver_path(driver), .kind = driver.kind, .targets = {}, .options = {}};
  for (const spec::Driver::Target& target : driver.targets) request.targets.push_back(target.name);
  for (const auto& [name, option] : driver.options) request.options.emplace(name, option_of(option));
  if (!driver.real.valid()) return request;
  const spec::Type& type = model.subsystem(driver.instance).real[driver.real].type;
  request.type = model.layout_of(type);
  if (has_unit(model, type)) add_units(model, type, request.units);
  return request;
}

std::string placements_json(const spec::Simulation& simulation, const fs::path& project) {
  return simulation.models.empty() ? "" : models_of(simulation, project).dump();
}

std::string check_json(const checks::Check& check) { return Json{{"checks", {json_of(check)}}}.dump(); }

std::string measure_json(const checks::Measure& measure) {
  return Json{{"measures", {{measure.name, json_of(measure)}}}}.dump();
}

std::string simulation_json(const spec::Model& model, const fs::path& project,
                            const std::optional<WorldPicture>& picture) {
  Json json{{"drivers", Json::array()}};
  for (const spec::Driver& driver : model.simulation->drivers)
    if (driver.is_of_world()) json["drivers"].push_back(json_of(request_of(model, driver)));
  json["models"] = models_of(*model.simulation, project);
  if (model.simulation->coppelia) json["coppelia"] = json_of(server_of(*model.simulation->coppelia, project));
  json["checks"] = Json::array();
  for (const spec::WorldCheck& one : model.simulation->checks) json["checks"].push_back(json_of(one.check));
  json["use_checks"] = Json::array();
  for (const spec::UseCheck& one : model.simulation->use_checks)
    json["use_checks"].push_back({{"name", one.name}, {"resource", one.resource}, {"most", one.most}});
  json["measures"] = Json::object();
  for (const spec::WorldMeasure& one : model.simulation->measures)
    json["measures"][one.measure.name] = json_of(one.measure);
  if (picture)
    json["picture"] = {{"world", picture->world.string()},
                       {"track", picture->track.string()},
                       {"metres_per_pixel", picture->metres_per_pixel},
                       {"seed", picture->seed}};
  return json.dump(1) + "\n";
}

std::optional<WorldOptions> world_of_run(const fs::path& simulation_file) {
  std::ifstream stream(simulation_file);
  const Json json = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("picture")) return std::nullopt;
  try {
    const Json& picture = json.at("picture");
    WorldOptions options;
    options.world = picture.at("world").get<std::string>();
    options.track = picture.at("track").get<std::string>();
    options.metres_per_pixel = picture.at("metres_per_pixel").get<double>();
    options.seed = picture.at("seed").get<std::uint64_t>();
    const Json models = json.value("models", Json::array());
    if (!models.empty()) options.models = models.dump();
    return options;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace tessera::project
